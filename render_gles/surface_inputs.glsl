// What environment.glsl expects from its surroundings. ENVIRONMENT_WIDTH and _HEIGHT: texels of the atlas.
uniform sampler2D u_environment;    // core::Environment's atlas, filtered linearly
uniform float u_environment_root;   // square root of range times the mood's gain
uniform vec4 u_room;                // centre and radius, m

// decode_environment squares what it gets. With the root in it already, 16 bits hold a sun and the shade beside it;
// 240^2 is the brightest of which they can still be added up.
#define u_environment_scale 1.0
vec4 fetch_environment(real x, real y) {
  vec4 t = texture2D(u_environment, vec2(x / ENVIRONMENT_WIDTH, y / ENVIRONMENT_HEIGHT));
#if FRAGMENT_HIGHP
  return vec4(t.xyz, t.w * u_environment_root);
#else
  return vec4(t.xyz, min(t.w * u_environment_root, 240.0));
#endif
}

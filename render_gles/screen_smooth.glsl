// Edges of a finished picture, smoothed along their own direction: moving pictures have one sample a pixel. After
// Lottes 2009 (FXAA), the short form: the edge's direction from the lightness of the four diagonal neighbours, two taps
// along it, and two wider ones unless they reach across another edge.
varying vec2 v_at;
uniform sampler2D u_first;
uniform vec2 u_pixel;  // 1 / size of the picture

float light(vec2 at) { return dot(texture2D(u_first, at).xyz, vec3(0.299, 0.587, 0.114)); }

void main() {
  vec3 here = texture2D(u_first, v_at).xyz;
  float nw = light(v_at + vec2(-1.0, 1.0) * u_pixel);
  float ne = light(v_at + u_pixel);
  float sw = light(v_at - u_pixel);
  float se = light(v_at + vec2(1.0, -1.0) * u_pixel);
  float m = dot(here, vec3(0.299, 0.587, 0.114));
  float low = min(m, min(min(nw, ne), min(sw, se)));
  float high = max(m, max(max(nw, ne), max(sw, se)));
  // Below an eighth of the local brightness (or 3 % of white) it is shading or sparkle, not an edge.
  if (high - low < max(0.03, high * 0.125)) {
    gl_FragColor = vec4(here, 1.0);
    return;
  }
  vec2 along = vec2((sw + se) - (nw + ne), (nw + sw) - (ne + se));
  float least = min(abs(along.x), abs(along.y)) + max((nw + ne + sw + se) * 0.03125, 0.0078125);
  vec2 step = clamp(along / least, -8.0, 8.0) * u_pixel;
  vec3 near = 0.5 * (texture2D(u_first, v_at - step * 0.1666667).xyz + texture2D(u_first, v_at + step * 0.1666667).xyz);
  vec3 wide = near * 0.5 + 0.25 * (texture2D(u_first, v_at - step * 0.5).xyz + texture2D(u_first, v_at + step * 0.5).xyz);
  float w = dot(wide, vec3(0.299, 0.587, 0.114));
  gl_FragColor = vec4(w < low || w > high ? near : wide, 1.0);
}

// All surfaces; SURFACE (a packs::SurfaceKind as a number) picks the rule. Appended to prelude, paint_fetch.glsl,
// paint_model.glsl, studio.glsl and display.glsl.
//
// Switches: SURFACE 0..9, NUM_LIGHTS 0..4, FLAKE_LIGHTS 0..4, STRIPES 0/1, STUDIO 0/1, and those of paint_model.glsl.
// The uniforms and fetches that paint_model.glsl and studio.glsl expect are declared in paint_fetch.glsl.
// Uniforms: vec3 u_eye (mm); vec3 u_light_dir[NUM_LIGHTS] (towards the light, unit); vec3 u_light[NUM_LIGHTS] (E/pi,
// linear sRGB); float u_exposure; float u_dither (0 or 1); float u_texels_per_mm; float u_pixel_texels (level-0 texels
// per pixel and mm of distance); vec3 u_backdrop (linear sRGB after exposure; the floor fades into it); float
// u_lamp_glow (radiance of switched-on lamps).
varying vec3 v_position;
varying vec3 v_normal;
varying float v_open;
uniform vec3 u_eye;
uniform float u_exposure;
uniform float u_dither;
uniform vec3 u_backdrop;
uniform float u_lamp_glow;
#if NUM_LIGHTS > 0
uniform vec3 u_light_dir[NUM_LIGHTS];
uniform vec3 u_light[NUM_LIGHTS];
#endif
#if SURFACE == 0 && HAS_FLAKES
uniform float u_texels_per_mm;
uniform float u_pixel_texels;
#endif

// Light that falls on a matt surface: the lamps, as E/pi.
vec3 lamps(vec3 n) {
  vec3 sum = vec3(0.0);
#if NUM_LIGHTS > 0
  for (int k = 0; k < NUM_LIGHTS; ++k) sum += u_light[k] * max(dot(n, u_light_dir[k]), 0.0);
#endif
  return sum;
}
// Their shine on a surface of roughness m, with the paint's own lobe.
vec3 lamps_gloss(vec3 n, vec3 o, float inv_m) {
  vec3 sum = vec3(0.0);
#if NUM_LIGHTS > 0
  for (int k = 0; k < NUM_LIGHTS; ++k) {
    Geometry g = paint_geometry(n, u_light_dir[k], o);
    if (g.iz > MIN_COSINE && g.oz > MIN_COSINE)
      sum += u_light[k] * (g.iz * lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, inv_m));
  }
#endif
  return sum;
}
float gloss_fresnel(vec3 n, vec3 o, float f0) { return fresnel_schlick(max(dot(n, o), 0.0), f0); }

// One light on the paint. Written out per light in shade(), not as a loop: a compiler that does not unroll so long a
// body would keep the flake code alive for lights that show none.
vec3 paint_light(vec3 i, vec3 radiance, vec3 n, vec3 o, vec2 texel, float lod, float show_flakes) {
  return radiance * (max(dot(n, i), 0.0) * paint_factor(n, i, o, texel, lod, show_flakes));
}

// Returns linear colour and coverage (premultiplied).
vec4 shade(vec3 n, vec3 o, vec3 p, float open, float distance_mm) {
  vec3 r = mirror_direction(n, o);
#if SURFACE == 0
#if STRIPES
  return vec4(stripe_radiance(r), 1.0);
#else
  vec3 sum = vec3(0.0);
#if NUM_LIGHTS > 0
  vec2 texel = vec2(0.0);
  float lod = 0.0;
#if HAS_FLAKES
  texel = surface_texel(p, n, u_texels_per_mm);
  lod = surface_lod(distance_mm, dot(n, o), u_pixel_texels);
#endif
  sum += paint_light(u_light_dir[0], u_light[0], n, o, texel, lod, FLAKE_LIGHTS > 0 ? 1.0 : 0.0);
#if NUM_LIGHTS > 1
  sum += paint_light(u_light_dir[1], u_light[1], n, o, texel, lod, FLAKE_LIGHTS > 1 ? 1.0 : 0.0);
#endif
#if NUM_LIGHTS > 2
  sum += paint_light(u_light_dir[2], u_light[2], n, o, texel, lod, FLAKE_LIGHTS > 2 ? 1.0 : 0.0);
#endif
#if NUM_LIGHTS > 3
  sum += paint_light(u_light_dir[3], u_light[3], n, o, texel, lod, FLAKE_LIGHTS > 3 ? 1.0 : 0.0);
#endif
  sum *= open;
#endif
#if STUDIO
  sum += paint_environment(n, o, p, open) + coat_mirror(n, o, p) * (0.25 + 0.75 * open);
#endif
  return vec4(sum, 1.0);
#endif
#elif SURFACE == 1  // glass: dark tint, dielectric mirror
  float f = fresnel_dielectric(max(dot(n, o), 0.0), 1.52);
  vec3 body = vec3(0.010, 0.012, 0.013) * (studio_radiance(p, n, 1.2) + lamps(n));
  float cover = 0.80 + 0.20 * f;
  return vec4(body * (1.0 - f) + studio_radiance(p, r, 0.0) * (f * open) + 0.04 * lamps_gloss(n, o, 60.0), cover);
#elif SURFACE == 2  // chrome
  return vec4(vec3(0.62, 0.63, 0.65) * studio_radiance(p, r, 0.03) * (0.3 + 0.7 * open) +
                  0.25 * lamps_gloss(n, o, 20.0), 1.0);
#elif SURFACE == 3  // rubber
  return vec4(vec3(0.018) * (studio_radiance(p, n, 1.2) + lamps(n)) * open +
                  studio_radiance(p, r, 0.7) * (0.35 * gloss_fresnel(n, o, 0.03) * open * open), 1.0);
#elif SURFACE == 4  // black plastic
  return vec4(vec3(0.012) * (studio_radiance(p, n, 1.2) + lamps(n)) * open +
                  studio_radiance(p, r, 0.18) * (gloss_fresnel(n, o, 0.04) * 0.8 * open * open), 1.0);
#elif SURFACE == 5  // rims: satin metal
  return vec4((vec3(0.34, 0.345, 0.355) * studio_radiance(p, r, 0.22) + vec3(0.05) * studio_radiance(p, n, 1.2) +
               vec3(0.10) * lamps_gloss(n, o, 6.0)) * (0.15 + 0.85 * open), 1.0);
#elif SURFACE == 6  // clear lamps: a bright inside behind a smooth lens
  float f6 = fresnel_dielectric(max(dot(n, o), 0.0), 1.5);
  return vec4(vec3(0.92, 0.97, 1.05) * u_lamp_glow + vec3(0.16) * studio_radiance(p, r, 0.25) +
                  studio_radiance(p, r, 0.0) * f6, 1.0);
#elif SURFACE == 7  // tail lamps
  float f7 = fresnel_dielectric(max(dot(n, o), 0.0), 1.5);
  return vec4(vec3(0.75, 0.012, 0.010) * u_lamp_glow + vec3(0.10, 0.004, 0.004) * studio_radiance(p, r, 0.3) +
                  studio_radiance(p, r, 0.0) * f7, 1.0);
#elif SURFACE == 8  // interior
  return vec4(vec3(0.02) * (studio_radiance(p, n, 1.2) + lamps(n)) * open, 1.0);
#else  // floor: polished dark concrete in a pool of light, fading into the hall
  float radius = length(p.xy);
  vec3 matt = vec3(0.115, 0.114, 0.112) * (studio_radiance(p + vec3(0.0, 0.0, 5.0), n, 1.2) + 0.6 * lamps(n));
  float ff = gloss_fresnel(n, o, 0.04);
  vec3 shine = studio_radiance(p + vec3(0.0, 0.0, 5.0), r, 0.16) * (ff * 0.55);
  vec3 lit = (matt * open * open + shine * open) * u_exposure;
  float fade = smoothstep(2800.0, 6700.0, radius);
  return vec4(mix(lit, u_backdrop, fade) / u_exposure, 1.0);
#endif
}

void main() {
  vec3 to_eye = u_eye - v_position;
  float distance_mm = length(to_eye);
  vec3 o = to_eye / distance_mm;
  vec3 n = normalize(v_normal);
  // Interpolated normals may turn away at silhouettes: bend them back to just facing the eye.
  float co = dot(n, o);
  if (co < 0.0) n = normalize(n + o * (0.001 - co));
  vec4 c = shade(n, o, v_position, v_open, distance_mm);
  vec3 shown = display_transform(c.xyz * u_exposure);
  shown += vec3(u_dither * dither_noise(gl_FragCoord.x, gl_FragCoord.y));
  gl_FragColor = vec4(shown, c.w);
}

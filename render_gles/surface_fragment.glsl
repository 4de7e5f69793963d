// All surfaces. Appended to prelude, paint_fetch.glsl, environment.glsl, paint_model.glsl, display.glsl, and
// filtered_light.glsl or sampled_light.glsl; mapped_paint.glsl before paint_model.glsl where COLOUR_MAP is not 0,
// orange_peel.glsl where ORANGE_PEEL is 1.
//
// Switches: SURFACE 0..9 (a packs::SurfaceKind as a number); PATH 0 (no environment), 1 (filtered), 2 (sampled),
// 3 (what lights cut from the environment leave over: the coat's mirror and sharp lobes, filtered); NUM_LIGHTS 0..4
// lights, FLAKE_LIGHTS of them with single flakes; ROOM_LIGHTS 1 (the lights stand on the room), 0 (far away);
// LESS_MEAN_FLAKES 1 (the environment shows a share of the flakes' mean, which lights must leave out);
// SPARKLE_LIGHTS 0..4 lights of the environment whose single flakes are added to the filtered mean; STRIPES,
// HAS_VISIBILITY, HAS_IRRADIANCE, FLOOR_MIRROR, OUTPUT 0 (display), 1 (scene-linear times exposure), 2 (for the floor's
// mirror), 3 (a mask: white but for the floor), and those of paint_model.glsl.
// Uniforms: vec4 u_frame (exposure; dither 0 or 1; level-0 texels per pixel and metre of distance; texels per metre);
// vec4 u_backdrop (linear sRGB after exposure, into which the floor fades); vec3 u_light_at[], u_light[] (towards the
// light, and E/pi; with ROOM_LIGHTS its place, m, and E/pi times the room's radius); float u_light_reach
// (nearer than this, m, a light is no point); float u_less_mean; vec3 u_sparkle_at[] (points on the room, m, or
// directions where it is far away), u_sparkle[] (E/pi); vec3 u_emission; float u_cover (glass).
varying vec3 v_position;
varying vec3 v_to_eye;
varying vec3 v_normal;
uniform vec4 u_frame;
uniform vec4 u_backdrop;
#if HAS_IRRADIANCE
varying vec3 v_irradiance;
uniform float u_gain;  // of the mood, on the baked irradiance
#endif
#if NUM_LIGHTS > 0
uniform vec3 u_light_at[NUM_LIGHTS];
uniform vec3 u_light[NUM_LIGHTS];
#if ROOM_LIGHTS
uniform float u_light_reach;
#endif
#if LESS_MEAN_FLAKES
uniform float u_less_mean;
#endif
#endif
#if SPARKLE_LIGHTS > 0
uniform vec3 u_sparkle_at[SPARKLE_LIGHTS];
uniform vec3 u_sparkle[SPARKLE_LIGHTS];
#endif
#if SURFACE == 6 || SURFACE == 7
uniform vec3 u_emission;
#endif
#if SURFACE == 1
uniform float u_cover;
#endif
#if FLOOR_MIRROR
uniform sampler2D u_mirror;
uniform vec4 u_mirror_step;  // 1 / picture size; blur in texture coordinates
#endif

vec3 mirror_direction(vec3 n, vec3 o) { return n * (2.0 * dot(n, o)) - o; }

// Stripes for judging surfaces: what body designers reflect in a flank. d: the mirrored view direction.
vec3 stripe_radiance(vec3 d) {
  float angle = atan(d.y, d.z) * 0.3183098861837907;  // around the car's length, in units of 180 degrees
  float s = abs(fract(angle * 12.0) - 0.5) * 2.0;
  return vec3(0.03 + 0.87 * clamp((s - 0.5) * 14.0 + 0.5, 0.0, 1.0));
}

#if SPARKLE_LIGHTS > 0 || (LESS_MEAN_FLAKES && NUM_LIGHTS > 0)
// Both directions bent into the coat.
Geometry inside_geometry(vec3 n, vec3 i, vec3 o) {
#if HAS_REFRACTION
  return paint_geometry(n, refract_into(i, n, u_refraction_ior), refract_into(o, n, u_refraction_ior));
#else
  return paint_geometry(n, i, o);
#endif
}
// What the coat lets through to the flakes and back.
float through_coat(float ci, float co) {
#if HAS_COAT
  return (1.0 - fresnel_dielectric(ci, u_coat_ior)) * (1.0 - fresnel_dielectric(co, u_coat_ior));
#else
  return 1.0;
#endif
}
#endif

#if NUM_LIGHTS > 0
// One light on the paint. Written out per light in shade(), not as a loop: a compiler that does not unroll so long a
// body would keep the flake code alive for lights that show none.
vec3 light_on_paint(vec3 at, vec3 radiance, vec3 p, vec3 n, vec3 o, vec2 texel, float lod, float show_flakes) {
#if ROOM_LIGHTS
  // A piece of the wall, which faces the room's centre: what it sends falls with the square of the distance and with
  // its own cosine.
  vec3 d = at - p;
  float away = length(d);
  vec3 i = d / max(away, 1e-3);
  away = max(away, u_light_reach);
  radiance *= max(dot(at - u_room.xyz, i), 0.0) / (away * away);
#else
  vec3 i = at;
#endif
  float ci = dot(n, i);
  vec3 rho = paint_factor(n, i, o, texel, lod, show_flakes);
#if LESS_MEAN_FLAKES
  if (ci > 0.0) {
    Geometry g = inside_geometry(n, i, o);
    rho -= flake_mean(g.theta_h, g.theta_i) * (u_less_mean * through_coat(ci, dot(n, o)));
  }
#endif
  return radiance * (visible(i) * max(ci, 0.0) * rho);
}
#endif

#if SPARKLE_LIGHTS > 0
// Single flakes of one light less their mean, which the filtered environment already shows.
vec3 sparkle(vec3 at, vec3 radiance, vec3 p, vec3 n, vec3 o, vec2 texel, float lod) {
  vec3 i = normalize(u_room.w > 0.0 ? at - p : at);
  float ci = dot(n, i);
  if (ci <= 0.0) return vec3(0.0);
  Geometry g = inside_geometry(n, i, o);
  return radiance * ((flake_factor(g.theta_h, g.theta_i, texel, lod) - flake_mean(g.theta_h, g.theta_i)) *
                     (through_coat(ci, dot(n, o)) * ci * visible(i)));
}
#endif

// Returns linear colour and coverage (premultiplied). p in metres.
vec4 shade(vec3 n, vec3 o, vec3 p, float distance_m) {
  vec3 r = mirror_direction(n, o);
  float co = max(dot(n, o), 0.0);
#if ORANGE_PEEL
  vec3 coat_normal = peeled_normal(n, p, distance_m, co);
#endif
#if STRIPES
#if ORANGE_PEEL
  r = mirror_direction(coat_normal, o);
#endif
  return vec4(stripe_radiance(r), 1.0);
#else
  vec2 texel = vec2(0.0);
  float lod = 0.0;
#if SURFACE == 0 && HAS_FLAKES && SINGLE_FLAKES
  texel = surface_texel(p, n, u_frame.w);
  lod = surface_lod(distance_m, co, u_frame.z);
#endif
  vec3 sum = vec3(0.0);
#if PATH == 1 || PATH == 3
  vec3 towards_r = room_direction(p, r);
  vec3 towards_n = room_direction(p, n);
  float seen = visible(r);
#if HAS_DIFFUSE && LOOKUP4
#if HAS_IRRADIANCE
  sum += filtered_diffuse(co, v_irradiance * u_gain);
#else
  sum += filtered_diffuse(co, environment_stacked(towards_n, 9.0));
#endif
#endif
  vec3 shine = filtered_lobes(co, towards_n, towards_r);
#if FLOOR_MIRROR
  // What the car hides of the room is in its mirror image already.
  // Nine taps around the mirror image: a polished floor spreads it by some degrees.
  vec2 at = gl_FragCoord.xy * u_mirror_step.xy;
  vec2 s = u_mirror_step.zw;
  vec4 image = texture2D(u_mirror, at) * 0.2;
  image += (texture2D(u_mirror, at + vec2(s.x, 0.0)) + texture2D(u_mirror, at - vec2(s.x, 0.0)) +
            texture2D(u_mirror, at + vec2(0.0, s.y)) + texture2D(u_mirror, at - vec2(0.0, s.y))) * 0.12;
  image += (texture2D(u_mirror, at + s) + texture2D(u_mirror, at - s) + texture2D(u_mirror, at + vec2(s.x, -s.y)) +
            texture2D(u_mirror, at + vec2(-s.x, s.y))) * 0.08;
  vec3 coded = image.xyz * image.xyz;
  vec3 a = fetch_albedo(co, 1.0).xyz;
  vec3 mirrored = coded / max(vec3(1.0) - coded, vec3(0.02)) * (a * a * u_albedo_scale.x) / u_frame.x;
  shine = mix(shine, mirrored, image.w);
#else
  shine *= seen;
#endif
  sum += shine;
#endif
#if PATH == 2
  sum += sampled_environment(p, n, o, texel, lod);
#endif
#if PATH > 0 && HAS_COAT
  vec3 c = r;
#if ORANGE_PEEL
  c = mirror_direction(coat_normal, o);
#endif
  sum += environment_sharp(room_direction(p, c)) * (fresnel_dielectric(co, u_coat_ior) * visible(r));
#endif
#if SPARKLE_LIGHTS > 0
  vec3 glints = sparkle(u_sparkle_at[0], u_sparkle[0], p, n, o, texel, lod);
#if SPARKLE_LIGHTS > 1
  glints += sparkle(u_sparkle_at[1], u_sparkle[1], p, n, o, texel, lod);
#endif
#if SPARKLE_LIGHTS > 2
  glints += sparkle(u_sparkle_at[2], u_sparkle[2], p, n, o, texel, lod);
#endif
#if SPARKLE_LIGHTS > 3
  glints += sparkle(u_sparkle_at[3], u_sparkle[3], p, n, o, texel, lod);
#endif
  sum = max(sum + glints, vec3(0.0));
#endif
#if NUM_LIGHTS > 0
  sum += light_on_paint(u_light_at[0], u_light[0], p, n, o, texel, lod, FLAKE_LIGHTS > 0 ? 1.0 : 0.0);
#if NUM_LIGHTS > 1
  sum += light_on_paint(u_light_at[1], u_light[1], p, n, o, texel, lod, FLAKE_LIGHTS > 1 ? 1.0 : 0.0);
#endif
#if NUM_LIGHTS > 2
  sum += light_on_paint(u_light_at[2], u_light[2], p, n, o, texel, lod, FLAKE_LIGHTS > 2 ? 1.0 : 0.0);
#endif
#if NUM_LIGHTS > 3
  sum += light_on_paint(u_light_at[3], u_light[3], p, n, o, texel, lod, FLAKE_LIGHTS > 3 ? 1.0 : 0.0);
#endif
#endif
#if LESS_MEAN_FLAKES && NUM_LIGHTS > 0 && OUTPUT != 1
  sum = max(sum, vec3(0.0));
#endif
#if SURFACE == 6 || SURFACE == 7
  sum += u_emission;
#endif
#if SURFACE == 1
#if HAS_COAT
  float f = fresnel_dielectric(co, u_coat_ior);
#else
  float f = 0.0;
#endif
  return vec4(sum, u_cover + (1.0 - u_cover) * f);
#elif SURFACE == 9
  // Polished dark concrete in a pool of light, fading into the hall.
  return vec4(mix(sum, u_backdrop.xyz / u_frame.x, smoothstep(2.8, 6.7, length(p.xy))), 1.0);
#else
  return vec4(sum, 1.0);
#endif
#endif
}

void main() {
  float distance_m = length(v_to_eye);
  vec3 o = v_to_eye / distance_m;
  vec3 n = normalize(v_normal);
  // Interpolated normals may turn away at silhouettes: bend them back to just facing the eye.
  float co = dot(n, o);
  if (co < 0.0) n = normalize(n + o * (0.001 - co));
  vec4 c = shade(n, o, v_position, distance_m);
  vec3 lit = c.xyz * u_frame.x;
#if OUTPUT == 0
  vec3 shown = display_transform(min(lit, vec3(8000.0)));  // white for long; the tone curve needs some room above
  shown += vec3(u_frame.y * dither_noise(gl_FragCoord.x, gl_FragCoord.y));
  gl_FragColor = vec4(shown, c.w);
#elif OUTPUT == 3
  gl_FragColor = vec4(vec3(SURFACE == 9 ? 0.0 : 1.0), 1.0);
#elif OUTPUT == 1
  gl_FragColor = vec4(min(lit, vec3(60000.0)), c.w);  // 65504 is the largest half float
#else
  // From below one looks into the open underside: what is seen from its back there is dark, not a hole to the sky.
  gl_FragColor = vec4(gl_FrontFacing ? sqrt(lit / (lit + vec3(1.0))) : vec3(0.0), 1.0);
#endif
}

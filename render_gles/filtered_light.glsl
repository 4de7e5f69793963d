// Light from the environment for moving pictures: one prefiltered look-up per part of the paint, times that part's
// directional albedo (core/directional_albedo.hpp). LOOKUP0..4: which of lobes 0 to 2, the flakes and the diffuse
// part are looked up; on PATH 3 lights give the others, or a share that the scales leave out (light_shares.hpp).
//
// From the surroundings: the functions of environment.glsl; sampler2D u_albedo (columns over sqrt(n.o); rows per
// material: diffuse, lobe 0, [lean, level / 9] of lobes 0 and 1, of lobe 2 and the flakes, lobe 1, lobe 2, flakes;
// rgb = sqrt(albedo / scale)), u_albedo_row (first row of this material + 0.5), u_albedo_scale (lobes 0 to 2, flakes),
// u_diffuse_scale. NARROW0..2: 1 where that lobe's level may lie below 2.
uniform sampler2D u_albedo;
uniform float u_albedo_row;
uniform float u_diffuse_scale;
uniform vec4 u_albedo_scale;

vec4 fetch_albedo(real co, real row) {
  return texture2D(u_albedo, vec2(sqrt(co), (u_albedo_row + row) * 0.015625));
}
// shape: lean and level.
vec3 stacked_term(vec4 t, real scale, vec2 shape, vec3 towards_n, vec3 towards_r) {
  vec3 a = t.xyz;
  return a * a * scale * environment_stacked(mix(towards_n, towards_r, shape.x), max(shape.y * 9.0, 2.0));
}
vec3 narrow_term(vec4 t, real scale, vec2 shape, vec3 towards_n, vec3 towards_r) {
  vec3 a = t.xyz;
  return a * a * scale * environment_at(mix(towards_n, towards_r, shape.x), shape.y * 9.0);
}

// Everything but the diffuse part and the coat's mirror. towards_*: room_direction of the normal and of the mirrored
// view direction.
vec3 filtered_lobes(real co, vec3 towards_n, vec3 towards_r) {
  vec3 sum = vec3(0.0);
#if (LOBES > 0 && LOOKUP0) || (LOBES > 1 && LOOKUP1)
  vec4 shape01 = fetch_albedo(co, 2.0);
#endif
#if LOBES > 0 && LOOKUP0
#if NARROW0
  sum += narrow_term(fetch_albedo(co, 1.0), u_albedo_scale.x, shape01.xy, towards_n, towards_r);
#else
  sum += stacked_term(fetch_albedo(co, 1.0), u_albedo_scale.x, shape01.xy, towards_n, towards_r);
#endif
#endif
#if LOBES > 1 && LOOKUP1
#if NARROW1
  sum += narrow_term(fetch_albedo(co, 4.0), u_albedo_scale.y, shape01.zw, towards_n, towards_r);
#else
  sum += stacked_term(fetch_albedo(co, 4.0), u_albedo_scale.y, shape01.zw, towards_n, towards_r);
#endif
#endif
#if (LOBES > 2 && LOOKUP2) || (HAS_FLAKES && LOOKUP3)
  vec4 shape23 = fetch_albedo(co, 3.0);
#endif
#if LOBES > 2 && LOOKUP2
#if NARROW2
  sum += narrow_term(fetch_albedo(co, 5.0), u_albedo_scale.z, shape23.xy, towards_n, towards_r);
#else
  sum += stacked_term(fetch_albedo(co, 5.0), u_albedo_scale.z, shape23.xy, towards_n, towards_r);
#endif
#endif
#if HAS_FLAKES && LOOKUP3
  sum += stacked_term(fetch_albedo(co, 6.0), u_albedo_scale.w, shape23.zw, towards_n, towards_r);
#endif
  return sum;
}
vec3 filtered_diffuse(real co, vec3 irradiance) {
  vec3 a = fetch_albedo(co, 0.0).xyz;
  return a * a * u_diffuse_scale * irradiance;
}

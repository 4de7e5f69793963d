// Paint whose colour factor chi comes from a map over the plane of incidence (Kirchner et al. 2015) instead of a table.
// Stands before paint_model.glsl where COLOUR_MAP is 1 or 2, with isochromatic.glsl before it; fetch_map and u_map are
// paint_fetch.glsl's. The paths of light that know a direction use it; prefiltered light has chi in its albedo.
//
// Switch: COLOUR_MAP 1: places beyond the critical angle are clipped (cures A and C), 2: they slide (cure B).

// chi for one pair of directions in air, unit vectors above the horizon.
vec3 map_factor(vec3 n, vec3 i, vec3 o) {
  vec2 sines = isochromatic_sines(isoline(n, i, o, u_map.x), u_map.x);
#if COLOUR_MAP == 2
  return fetch_map(isochromatic_texel(isochromatic_slide(sines, u_map.y)));
#else
  return fetch_map(isochromatic_texel(isochromatic_clip(sines)));
#endif
}

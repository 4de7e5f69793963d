// What paint_model.glsl expects from their surroundings, in GLSL: uniforms and texture fetches.
// All textures but u_random are RGBA8; sizes and meaning stand in core/paint_textures.hpp. The C++ twin is core/paint_model.hpp.

uniform vec3 u_diffuse;
uniform vec4 u_lobe[3];
uniform vec3 u_inv_m;
uniform float u_coat_ior;
uniform float u_refraction_ior;

#if HAS_TABLE
uniform sampler2D u_chi;
uniform float u_table_size;
uniform float u_chi_scale;

// The sampler's own linear filter works with 8-bit weights or results on some hardware, which would show as steps
// across a bonnet; four nearest taps cost little and are the same everywhere.
vec3 chi_texel(vec2 corner) { return texture2D(u_chi, (corner + 0.5) / u_table_size).xyz; }
vec3 fetch_chi(float u, float v) {
  vec2 last = vec2(u_table_size - 1.0);
  vec2 at = clamp(vec2(u, v) * u_table_size - 0.5, vec2(0.0), last);
  vec2 low = min(floor(at), max(last - 1.0, vec2(0.0)));
  vec2 w = at - low;
  vec3 upper = mix(chi_texel(low), chi_texel(low + vec2(1.0, 0.0)), w.x);
  vec3 lower = mix(chi_texel(low + vec2(0.0, 1.0)), chi_texel(low + vec2(1.0, 1.0)), w.x);
  vec3 root = mix(upper, lower, w.y);
  return root * root * u_chi_scale;
}
#endif

#if COLOUR_MAP > 0
uniform sampler2D u_map_nodes;
uniform vec4 u_map;  // index; which way places slide (1, -1); last column; MapTexture::scale

// Counted from the map's middle row, so that 16 bits keep four binary places of 64 nodes.
vec3 map_texel(vec2 node) {
  vec4 t = texture2D(u_map_nodes,
                     (node + vec2(0.5, u_map.z + 0.5)) / vec2(u_map.z + 1.0, 2.0 * u_map.z + 1.0));
  vec3 root = t.xyz * (t.w * u_map.w);
  return root * root;
}
// place: of isochromatic_texel, [0, 1] x [-1, 1]. Values are blended, not their roots, as core::ColourMap does.
vec3 fetch_map(vec2 place) {
  vec2 at = place * u_map.z;
  vec2 low = min(floor(at), vec2(u_map.z - 1.0));
  vec2 w = at - low;
  vec3 upper = mix(map_texel(low), map_texel(low + vec2(1.0, 0.0)), w.x);
  vec3 lower = mix(map_texel(low + vec2(0.0, 1.0)), map_texel(low + vec2(1.0, 1.0)), w.x);
  return mix(upper, lower, w.y);
}
#endif

#if HAS_FLAKES
uniform sampler2D u_mean;
uniform float u_slice_count;
uniform float u_level_count;
uniform float u_bins_per_rad;
uniform vec2 u_flake_cells;
uniform vec3 u_lab_lo;
uniform vec3 u_lab_span;

const float ANGLE_GRID = 16.0;
const float RANK_STEPS = 256.0;
const float RANDOM_EDGE = 512.0;

// Shared exponent in A, biased by 128; A = 0 stands for black.
vec3 fetch_mean(float bin_h, float bin_i) {
  vec4 t = texture2D(u_mean, (vec2(bin_h, bin_i) + 0.5) / ANGLE_GRID);
  float exponent = floor(t.w * 255.0 + 0.5);
  return exponent > 0.5 ? t.xyz * exp2(exponent - 128.0) : vec3(0.0);
}
#if SINGLE_FLAKES
uniform sampler2D u_slice;
uniform sampler2D u_rank;
uniform sampler2D u_corner;
uniform sampler2D u_random;
uniform vec2 u_corner_size;  // texels: 3 width, asked rows (the rank table has as many)

vec4 fetch_slice(float bin_h, float bin_i) { return texture2D(u_slice, (vec2(bin_h, bin_i) + 0.5) / ANGLE_GRID); }
vec4 fetch_rank(float step_index, float row) {
  return texture2D(u_rank, vec2((step_index + 0.5) / RANK_STEPS, (row + 0.5) / u_corner_size.y));
}
vec4 fetch_corner(float x, float row) { return texture2D(u_corner, (vec2(x, row) + 0.5) / u_corner_size); }
// LUMINANCE_ALPHA: two bytes. One value a texel: pairs in one RGBA texel save a fetch and take twice the memory
// (docs/decisions.md says what it costs).
vec2 fetch_random(float x, float y) {
  vec4 t = texture2D(u_random, (vec2(x, y) + 0.5) / RANDOM_EDGE);
  return vec2(t.x, t.w);
}
#else
// No light shows single flakes. A compiler may still not see that their code is dead (Mesa does not unroll the loop
// over lights, which made the mean as dear as the flakes); "no slice anywhere" removes it for certain.
vec4 fetch_slice(float bin_h, float bin_i) { return vec4(0.0, 1.0, 0.0, 0.0); }
vec4 fetch_rank(float step_index, float row) { return vec4(0.0); }
vec4 fetch_corner(float x, float row) { return vec4(0.0); }
vec2 fetch_random(float x, float y) { return vec2(0.0); }
#endif
#endif

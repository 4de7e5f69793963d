// The paint model, written once: this text is GLSL ES 1.00 and, included inside the struct of paint_model.hpp, C++.
//
// Rules of the house: literals through R(); `real` for scalars; components only as .x .y .z .w (no swizzles); loops
// with constant bounds; no names that begin with gl_. What the surroundings provide, in both languages:
//   uniforms     u_diffuse, u_lobe[3], u_inv_m, u_coat_ior, u_refraction_ior, u_table_size,
//                u_slice_count, u_level_count, u_bins_per_rad, u_flake_cells, u_lab_lo, u_lab_span
//   constants    LINEAR_FROM_XYZ_R/G/B (vec3, white folded in), LAB_DELTA, MAX_EXPONENT, LEAST, LOBES
//   fetches      fetch_chi, fetch_mean, fetch_slice, fetch_rank, fetch_corner, fetch_random
//
// All reflectances here are radiance factors rho = pi * f: a light that gives a white diffuser the radiance E/pi gives
// this surface the radiance rho * (n.i) * E/pi. Directions are unit vectors that point away from the surface.
//
// Sources: Guenther et al. 2005 eq. 1; Golla & Klein 2018 eq. 1 to 7 and 3.2; Kneiphof et al. 2018 eq. 6.

// Below this cosine a lobe returns 0: the divisions by n.i and n.o have no meaning there and the true product with
// n.i goes to 0 (1.7e-3 is 89.9 degrees; also what other AxF importers use).
#define MIN_COSINE R(1.7e-3)

real pow5(real x) {
  real x2 = x * x;
  return x2 * x2 * x;
}

// Unpolarised Fresnel reflectance of a dielectric seen from outside; c = cosine of incidence, ior >= 1.
// g = sqrt(ior^2 - 1 + c^2) (Cook & Torrance 1982, eq. 7). Exactly 0 at ior = 1.
real fresnel_dielectric(real c, real ior) {
  real g2 = (ior - R(1.0)) * (ior + R(1.0)) + c * c;
  real g = sqrt(max(g2, R(0.0)));
  real a = (ior - R(1.0)) * (ior + R(1.0)) / max((g + c) * (g + c), LEAST);  // (g - c)/(g + c) without cancellation
  real b_up = c * (g + c) - R(1.0);
  real b_down = c * (g - c) + R(1.0);
  real b = b_up / max(b_down, R(1e-4));
  return min(R(0.5) * a * a * (R(1.0) + b * b), R(1.0));
}

// Schlick's approximation (1994) with h.o as its cosine; f0 in [0, 1].
real fresnel_schlick(real ho, real f0) {
  return f0 + (R(1.0) - f0) * pow5(clamp(R(1.0) - ho, R(0.0), R(1.0)));
}

// The direction inside a coat of index eta >= 1 (Snell); eta = 1 changes nothing. cos^2 inside is 1 - (1 - c^2)/eta^2,
// written without its cancellation: at grazing angles and eta = 1 16 bits would keep nothing of c.
vec3 refract_into(vec3 d, vec3 n, real eta) {
  real c = dot(n, d);
  real cos2 = ((eta - R(1.0)) * (eta + R(1.0)) + c * c) / (eta * eta);
  return (d - n * c) * (R(1.0) / eta) + n * sqrt(max(cos2, R(0.0)));
}

// Beckmann D * G / (i_z o_z) of one lobe, without s and F. tan_h = tan(theta_h), nh = n.h, ho = h.o.
// D = exp(-tan^2/m^2) / (m^2 nh^4). All of it is one power of two: with m = 1e-3, 1/m^2 = 1e6 does not fit 16 bits, nor
// does 1/(i_z o_z) at grazing angles, but their logarithms do. The ratio tan/m is clamped at 16, where exp(-256) is 0 in
// every format, so that its square fits. G is the V-cavity term (Cook & Torrance 1982, eq. 8), kept above 0 for its
// logarithm. `through` is what the coat lets pass of it, at least LEAST: beside a grazing peak of 1e6 stands a coat that
// passes 4e-4, and 16 bits hold neither. MAX_EXPONENT and LEAST come from the surroundings. In 16 bits they are 15, so
// that lobes of s F <= 1 sum to less than 65504 (what that cuts off is 400 times white at 89.7 degrees), and 6.2e-5, the
// least that is held in full; else they are out of every lobe's reach.
real lobe_shape(real tan_h, real nh, real ho, real iz, real oz, real inv_m, real through) {
  real x = min(tan_h * inv_m, R(16.0));
  real g = min(R(1.0), R(2.0) * nh * min(iz, oz) / max(ho, MIN_COSINE));
  real e = R(2.0) * log2(inv_m) - x * x * R(1.4426950408889634) - R(4.0) * log2(max(nh, MIN_COSINE));
  return exp2(min(e + (log2(max(g, LEAST) / iz) + log2(through / oz)), MAX_EXPONENT));
}

// Everything about one pair of directions that the terms below share. Angles in radians.
struct Geometry {
  real iz;       // n.i inside the coat
  real oz;       // n.o inside the coat
  real nh;       // n.h
  real ho;       // h.o = h.i
  real tan_h;    // tan(theta_h)
  real theta_h;  // between h and n
  real theta_i;  // between h and i (the difference angle)
};

Geometry paint_geometry(vec3 n, vec3 i, vec3 o) {
  Geometry g;
  vec3 sum = i + o;
  vec3 diff = i - o;
  real sum_length = max(length(sum), R(1e-4));
  real nsum = dot(n, sum);
  vec3 c = cross(n, sum);
  real sin_h = length(c);
  g.iz = dot(n, i);
  g.oz = dot(n, o);
  g.nh = nsum / sum_length;
  g.ho = R(0.5) * sum_length;
  g.tan_h = sin_h / max(nsum, R(1e-4));
  g.theta_h = atan(sin_h, max(nsum, R(0.0)));
  g.theta_i = atan(length(diff), sum_length);
  return g;
}

// a + sum of lobes, without chi, times `through` > 0: the radiance factor of the smooth part.
vec3 lobes_factor(Geometry g, real through) {
  vec3 sum = u_diffuse * through;
  if (g.iz > MIN_COSINE && g.oz > MIN_COSINE) {
#if LOBES > 0
    sum += make_vec3(u_lobe[0]) *
           (fresnel_schlick(g.ho, u_lobe[0].w) * lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, u_inv_m.x, through));
#endif
#if LOBES > 1
    sum += make_vec3(u_lobe[1]) *
           (fresnel_schlick(g.ho, u_lobe[1].w) * lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, u_inv_m.y, through));
#endif
#if LOBES > 2
    sum += make_vec3(u_lobe[2]) *
           (fresnel_schlick(g.ho, u_lobe[2].w) * lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, u_inv_m.z, through));
#endif
  }
  return sum;
}

#if HAS_TABLE
// chi with its angles clamped to theta_i <= pi/2 - theta_h, where real tables end.
vec3 chi_factor(real theta_h, real theta_i) {
  real ti = max(min(theta_i, R(1.5707963267948966) - theta_h), R(0.0));
  real per_rad = (u_table_size - R(1.0)) * R(0.6366197723675814);  // nodes at 0 and 90 degrees
  return fetch_chi((theta_h * per_rad + R(0.5)) / u_table_size, (ti * per_rad + R(0.5)) / u_table_size);
}
#endif

#if HAS_FLAKES
// Place on the paint in texels, without the mesh's own uvs: p (mm) projected along the normal's largest axis. The
// pattern is random, so where the axis changes nothing shows; stretch is at most sqrt(3).
vec2 surface_texel(vec3 p, vec3 n, real texels_per_mm) {
  real ax = abs(n.x);
  real ay = abs(n.y);
  real az = abs(n.z);
  vec2 q = az >= max(ax, ay) ? vec2(p.x, p.y) : (ay >= ax ? vec2(p.x, p.z) : vec2(p.y, p.z));
  return q * texels_per_mm;
}
// log2 of a pixel's footprint in texels (geometric mean of its axes), plus log2(1.5): a glint narrower than about
// 1.5 pixels would alias when the car turns. pixel_texels: texels per pixel and mm of distance.
real surface_lod(real distance_mm, real co, real pixel_texels) {
  return log2(max(distance_mm * pixel_texels, R(1e-4))) - R(0.5) * log2(max(co, R(0.05))) + R(0.585);
}

// Lab of a radiance factor to linear sRGB, >= 0 (CIE 15:2004; the toe is linear).
real lab_component(real f) {
  return f > LAB_DELTA ? f * f * f : R(3.0) * LAB_DELTA * LAB_DELTA * (f - R(4.0) / R(29.0));
}
vec3 linear_from_lab_factor(vec3 lab) {
  real fy = (lab.x + R(16.0)) / R(116.0);
  vec3 xyz = vec3(lab_component(fy + lab.y / R(500.0)), lab_component(fy), lab_component(fy - lab.z / R(200.0)));
  return max(vec3(dot(LINEAR_FROM_XYZ_R, xyz), dot(LINEAR_FROM_XYZ_G, xyz), dot(LINEAR_FROM_XYZ_B, xyz)),
             vec3(R(0.0)));
}

// A 16-bit number from two bytes of an RGBA8 texel (low, high), as [0, 1]. No intermediate value leaves 16 bits' range.
real from_bytes(real low, real high) {
  return high * R(0.9961089494163424) + low * R(0.0038910505836576);  // 65280/65535, 255/65535
}

// What a flake shows depends on where half vector and light stand towards it; a texel's random value must change with
// these angles or nothing twinkles. The plane (theta_h, theta_i) is cut into random cells, u_flake_cells of them per
// angle bin (0: one value for all angles), and each cell has its own Gaussian value g at each texel. Between cells they
// are blended with weights of square sum 1, which leaves the sum Gaussian, so that no angle changes the distribution;
// with cos and sin of an even angle every angle also changes at the same rate: inside a cell two directions an angle d
// apart correlate by cos(pi d / (2 cell)). FLAKE_CELLS 4: blended between the cells around; 1: the nearest cell's value,
// which jumps.
#ifndef FLAKE_CELLS
#define FLAKE_CELLS 4
#endif

// The value of cell (h, i), low and high byte. Cells and levels look at other places of the texture; no two of 91 x 16
// cells and 13 levels at the same.
vec2 random_value(vec2 cell, real level, real h, real i) {
  return fetch_random(cell.x + R(203.0) * level + R(129.0) * h + R(231.0) * i,
                      cell.y + R(311.0) * level + R(187.0) * h + R(227.0) * i);
}
// Those of cell (h, i) in x y and of its neighbour (h + 1, i) in z w.
vec4 random_pair(vec2 cell, real level, real h, real i) {
  vec2 here = random_value(cell, level, h, i);
  vec2 next = random_value(cell, level, h + R(1.0), i);
  return vec4(here.x, here.y, next.x, next.y);
}

// The Gaussian value of a texel at these angles, in bins. The bytes stand for -4.75 to 4.75: 1 in 490,000 lies outside.
real flake_gaussian(vec2 cell, real level, real fh, real fi) {
  real ch = fh * u_flake_cells.x;
  real ci = fi * u_flake_cells.y;
#if FLAKE_CELLS == 1
  vec2 t = random_value(cell, level, floor(ch + R(0.5)), floor(ci + R(0.5)));
  return R(9.5) * (from_bytes(t.x, t.y) - R(0.5));
#else
  real h = floor(ch);
  real i = floor(ci);
  real to_h = R(1.5707963267948966) * (ch - h);
  real this_h = cos(to_h);
  real next_h = sin(to_h);
  real middle = R(0.5) * (this_h + next_h);
  vec4 t = random_pair(cell, level, h, i);
  real g = this_h * from_bytes(t.x, t.y) + next_h * from_bytes(t.z, t.w) - middle;
  if (u_flake_cells.y > R(0.0)) {
    real to_i = R(1.5707963267948966) * (ci - i);
    t = random_pair(cell, level, h, i + R(1.0));
    g = cos(to_i) * g + sin(to_i) * (this_h * from_bytes(t.x, t.y) + next_h * from_bytes(t.z, t.w) - middle);
  }
  return R(9.5) * g;
#endif
}

// sqrt(1 - u) of the rank u = Phi(g): what is left above it, in the warp of the rank table (rank_table.hpp). Never
// through u, which has no digits left where flakes are rare. For g >= 0 it is exp(-g^2/4) sqrt(erfcx(g/sqrt 2)/2), and
// the root's reciprocal is smooth: minimax polynomial with p(0) = sqrt 2, so that both halves meet. Relative error of
// 1 - u, at double: below 5.5e-4 for g up to 5 (1 - u = 2.9e-7), and 4.5e-3 up to 5.6.
real flake_depth(real g) {
  real x = abs(g);
  real p = R(1.4142135623730951) + x * (R(0.5679818) + x * (R(-0.0265621) + x * (R(-0.001095607) + x * R(0.0002455818))));
  real y = exp2(R(-0.36067376022224085) * x * x) / p;
  return g < R(0.0) ? sqrt((R(1.0) - y) * (R(1.0) + y)) : y;
}

// The random numbers of one texel: x = sqrt(1 - rank), y z w = place inside the cuboid along L, a, b. `cell` counts
// texels of that level. The place stays with the texel at all angles (docs/decisions.md says by how little that shows):
// low bytes of two Gaussian values, which are uniform. The third comes from both: fract(97 y + 57 z) is uniform, and
// independent of each of them alone.
vec4 flake_random(vec2 cell, real level, real fh, real fi) {
  real x = cell.x + R(203.0) * level + R(229.0);
  real y = cell.y + R(311.0) * level + R(257.0);
  vec2 one = fetch_random(x, y);
  vec2 two = fetch_random(x + R(129.0), y + R(187.0));
  real l = fract(R(97.0) * one.x + R(57.0) * two.x);
  return vec4(flake_depth(flake_gaussian(cell, level, fh, fi)), l, one.x, two.x);
}

// One slice at one level: rank -> tuple -> cuboid -> Lab -> linear sRGB.
vec3 flake_tap(real bin_h, real bin_i, real level, vec4 random) {
  vec4 where = fetch_slice(bin_h, bin_i);
  if (where.y > R(0.5)) {
    return vec3(R(0.0));  // outside the table there are no flakes
  }
  real row = level * u_slice_count + floor(where.x * R(255.0) + R(0.5));
  // The rank table counts from the dark end; counted from the bright one, 16 bits resolve the rare flakes.
  real scaled = random.x * R(256.0);
  real below = min(floor(scaled), R(255.0));
  real f = min(R(1.0) - (scaled - below), R(0.999));  // 1 would pass thresholds that mean "not within this step"
  vec4 entry = fetch_rank(R(255.0) - below, row);
  real tuple = floor(entry.x * R(255.0) + R(0.5));
  tuple += f >= entry.y ? R(1.0) : R(0.0);
  tuple += f >= entry.z ? R(1.0) : R(0.0);
  tuple += f >= entry.w ? R(1.0) : R(0.0);
  vec4 cl = fetch_corner(R(3.0) * tuple, row);
  vec4 ca = fetch_corner(R(3.0) * tuple + R(1.0), row);
  vec4 cb = fetch_corner(R(3.0) * tuple + R(2.0), row);
  vec3 q = vec3(mix(from_bytes(cl.x, cl.y), from_bytes(cl.z, cl.w), random.y),
                mix(from_bytes(ca.x, ca.y), from_bytes(ca.z, ca.w), random.z),
                mix(from_bytes(cb.x, cb.y), from_bytes(cb.z, cb.w), random.w));
  return linear_from_lab_factor(u_lab_lo + u_lab_span * q);
}

// One level by the nearest slice's distribution. fh, fi: angles in bins.
vec3 flake_nearest(real fh, real fi, vec2 surface_texel, real level) {
  vec4 random = flake_random(floor(surface_texel * exp2(-level)), level, fh, fi);
  return flake_tap(floor(fh + R(0.5)), floor(fi + R(0.5)), level, random);
}

// All angle taps of one level. FLAKE_TAPS 1: the nearest slice; 4: bilinear between the four around, at one rank, which
// blends their quantiles.
vec3 flake_level(real fh, real fi, vec2 surface_texel, real level) {
#if FLAKE_TAPS == 1
  return flake_nearest(fh, fi, surface_texel, level);
#else
  vec4 random = flake_random(floor(surface_texel * exp2(-level)), level, fh, fi);
  real h0 = floor(fh);
  real i0 = floor(fi);
  real wh = fh - h0;
  real wi = fi - i0;
  return (flake_tap(h0, i0, level, random) * (R(1.0) - wh) + flake_tap(h0 + R(1.0), i0, level, random) * wh) *
             (R(1.0) - wi) +
         (flake_tap(h0, i0 + R(1.0), level, random) * (R(1.0) - wh) +
          flake_tap(h0 + R(1.0), i0 + R(1.0), level, random) * wh) *
             wi;
#endif
}

// The flakes' mean, for lights and distances at which single flakes do not show: bilinear between slices.
vec3 flake_mean(real theta_h, real theta_i) {
  real fh = theta_h * u_bins_per_rad;
  real fi = theta_i * u_bins_per_rad;
  real h0 = floor(fh);
  real i0 = floor(fi);
  real wh = fh - h0;
  real wi = fi - i0;
  return (fetch_mean(h0, i0) * (R(1.0) - wh) + fetch_mean(h0 + R(1.0), i0) * wh) * (R(1.0) - wi) +
         (fetch_mean(h0, i0 + R(1.0)) * (R(1.0) - wh) + fetch_mean(h0 + R(1.0), i0 + R(1.0)) * wh) * wi;
}

// Flakes as they show in a pixel. surface_texel: place on the paint in level-0 texels; lod: log2 of the pixel's
// footprint in level-0 texels. The last level is one texel, whose colour is the mean.
vec3 flake_factor(real theta_h, real theta_i, vec2 surface_texel, real lod) {
  real fh = theta_h * u_bins_per_rad;
  real fi = theta_i * u_bins_per_rad;
  real last = u_level_count - R(1.0);
  if (lod >= last) {
    return flake_mean(theta_h, theta_i);
  }
  real l = max(lod, R(0.0));
  real l0 = floor(l);
  real f = l - l0;
  vec3 sum = flake_level(fh, fi, surface_texel, l0) * (R(1.0) - f);
  if (f > R(0.0)) {
    sum += (l0 + R(1.0) >= last ? flake_mean(theta_h, theta_i) : flake_level(fh, fi, surface_texel, l0 + R(1.0))) * f;
  }
  return sum;
}
#endif

// The radiance factor of the whole paint for light from i seen from o, except the coat's mirror image.
// show_flakes: 1 for single flakes, 0 for their mean.
vec3 paint_factor(vec3 n, vec3 i, vec3 o, vec2 surface_texel, real lod, real show_flakes) {
  real ci = dot(n, i);
  real co = dot(n, o);
  if (ci <= R(0.0) || co <= R(0.0)) {
    return vec3(R(0.0));
  }
  real through = R(1.0);
#if HAS_COAT
  through = max((R(1.0) - fresnel_dielectric(ci, u_coat_ior)) * (R(1.0) - fresnel_dielectric(co, u_coat_ior)), LEAST);
#endif
#if HAS_REFRACTION
  Geometry g = paint_geometry(n, refract_into(i, n, u_refraction_ior), refract_into(o, n, u_refraction_ior));
#else
  Geometry g = paint_geometry(n, i, o);
#endif
  vec3 factor = lobes_factor(g, through);
#if HAS_TABLE
  factor *= chi_factor(g.theta_h, g.theta_i);
#endif
#if COLOUR_MAP > 0
  factor *= map_factor(n, i, o);
#endif
#if HAS_FLAKES
  if (show_flakes > R(0.5)) {
    factor += flake_factor(g.theta_h, g.theta_i, surface_texel, lod) * through;
  } else {
    factor += flake_mean(g.theta_h, g.theta_i) * through;
  }
#endif
  return factor;
}

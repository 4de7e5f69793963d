// The built-in studio, written once for shader and CPU (same rules as paint_model.glsl).
//
// A dark hall: a long soft box overhead between two slim bright tubes, a panel along each flank, a box before the nose
// and one behind the tail, and a floor with a pool of light. It is a function, not a picture: nothing to download, and a rough lobe
// can ask for it already blurred. Lengths in mm, axes as in packs/scene.hpp. Radiances are relative to the exposure.
//
// From the surroundings: u_studio_gain (0 switches the studio off), u_floor_shadow (half length and half width of what
// stands on the floor, mm; 0 = nothing).

// A box of half width h convolved with a box of half width w, at distance x from the centre: 1 well inside, 0 well
// outside, energy kept however wide the blur. The ramps are smooth, so that no edge shows in a curved mirror.
real soft_step(real t) {
  real c = clamp(t * R(0.5) + R(0.5), R(0.0), R(1.0));
  return c * c * (R(3.0) - R(2.0) * c);
}
real soft_box(real x, real h, real w) {
  return soft_step((x + h) / w) - soft_step((x - h) / w);
}

// What lies under the car on the floor: 1 = open, 0 = fully covered; soft by `w` mm.
real floor_open(vec2 q, real w) {
  return R(1.0) - soft_box(q.x, u_floor_shadow.x, w) * soft_box(q.y, u_floor_shadow.y, w);
}

// Radiance that arrives at p (mm) from direction d (unit). blur: tangent of the half angle over which a lobe averages.
vec3 studio_radiance(vec3 p, vec3 d, real blur) {
  // Hall: a dark wall, a little lighter at the horizon, so that the silhouette of a dark car still reads.
  real up = clamp(d.z, R(-1.0), R(1.0));
  real horizon = exp2(R(-10.0) * up * up / (R(1.0) + R(6.0) * blur));
  vec3 sum = vec3(R(0.030), R(0.033), R(0.038)) + vec3(R(0.085), R(0.090), R(0.100)) * horizon;

  // Overhead, 3.3 m high and 6.4 m long, cool white: a box 1.5 m wide, and beside it two tubes of 0.24 m, the brightest
  // things in the room. The tubes are what draws a crisp line along a shoulder: a coat mirrors only 4 % of them.
  real tz = (R(3300.0) - p.z) / max(d.z, R(0.03));
  real wz = tz * blur;
  vec3 qz = p + d * tz;
  real ahead = soft_box(qz.x, R(3200.0), R(260.0) + wz * R(1.6)) * soft_step((d.z - R(0.05)) / (R(0.05) + blur));
  real over = R(2.6) * soft_box(qz.y, R(750.0), R(140.0) + wz);
  over += R(13.0) * soft_box(abs(qz.y) - R(1650.0), R(120.0), R(35.0) + wz);
  sum += vec3(R(0.97), R(1.0), R(1.03)) * (over * ahead);

  // Flank panels: 7.6 m long, 0.7 m to 1.9 m high, 4.6 m from the middle; the left one (y > 0) is the key.
  real side = d.y < R(0.0) ? R(-1.0) : R(1.0);
  real ty = (R(4600.0) - side * p.y) / max(abs(d.y), R(0.03));
  real wy = R(120.0) + ty * blur;
  vec3 qy = p + d * ty;
  real flank = soft_box(qy.x - R(300.0), R(3800.0), wy * R(1.6)) * soft_box(qy.z - R(1300.0), R(600.0), wy);
  flank *= soft_step((abs(d.y) - R(0.08)) / (R(0.08) + blur));
  sum += (side > R(0.0) ? vec3(R(1.75), R(1.72), R(1.66)) : vec3(R(0.95), R(1.0), R(1.08))) * flank;

  // Nose and tail boxes: 3.2 m wide, 0.8 m to 2 m high, 6.5 m away.
  real along = d.x < R(0.0) ? R(-1.0) : R(1.0);
  real tx = (R(6500.0) - along * p.x) / max(abs(d.x), R(0.03));
  real wx = R(160.0) + tx * blur;
  vec3 qx = p + d * tx;
  real ends = soft_box(qx.y, R(1600.0), wx) * soft_box(qx.z - R(1400.0), R(600.0), wx);
  ends *= soft_step((abs(d.x) - R(0.08)) / (R(0.08) + blur));
  sum += vec3(R(1.05), R(1.08), R(1.12)) * ends;

  // Floor: a pool of light around the stage, darker where the car stands. Blurred lobes see part of it from above.
  real down = soft_step(-d.z / (R(0.04) + blur));
  real tf = max(p.z, R(1.0)) / max(-d.z, R(0.05));
  vec3 qf = p + d * tf;
  real r2 = (qf.x * qf.x * R(0.6) + qf.y * qf.y) * R(1e-6);
  real pool = R(0.05) + R(0.34) * exp2(R(-0.075) * r2);
  pool *= R(0.12) + R(0.88) * floor_open(vec2(qf.x, qf.y), R(350.0) + tf * blur);
  sum = sum * (R(1.0) - down) + vec3(R(1.0), R(0.99), R(0.97)) * (pool * down);
  return sum * u_studio_gain;
}

// Stripes for judging surfaces: what body designers reflect in a flank. d: the mirrored view direction.
vec3 stripe_radiance(vec3 d) {
  real angle = atan(d.y, d.z) * R(0.3183098861837907);  // around the car's length, in units of 180 degrees
  real s = abs(fract(angle * R(12.0)) - R(0.5)) * R(2.0);
  real v = clamp((s - R(0.5)) * R(14.0) + R(0.5), R(0.0), R(1.0));
  return vec3(R(0.03) + R(0.87) * v);
}

vec3 mirror_direction(vec3 n, vec3 o) {
  return n * (R(2.0) * dot(n, o)) - o;
}

// The coat's mirror image of the studio.
vec3 coat_mirror(vec3 n, vec3 o, vec3 p) {
#if HAS_COAT
  return studio_radiance(p, mirror_direction(n, o), R(0.0)) * fresnel_dielectric(max(dot(n, o), R(0.0)), u_coat_ior);
#else
  return vec3(R(0.0));
#endif
}

// The studio seen through the smooth part of the paint, lobe by lobe: each lobe mirrors the studio blurred by its own
// roughness, weighted by its albedo. For light from everywhere that is the integral of D F G 4 (h.o) / o_z over h,
// which at normal view is 4 s F (the D4 albedo test); a lobe of roughness m spreads a mirrored ray by about 2 m,
// and by the index more where the coat refracts. chi is taken where the lobes peak, theta_h = 0.
// u_flake_fill: albedo of the mean flakes at normal view over their value at (0, 0), per channel.
vec3 paint_environment(vec3 n, vec3 o, vec3 p, real open) {
  real co = max(dot(n, o), R(0.02));
  vec3 r = mirror_direction(n, o);
#if HAS_REFRACTION
  real cb = dot(n, refract_into(o, n, u_refraction_ior));
  real spread = R(2.0) * u_refraction_ior;
#else
  real cb = co;
  real spread = R(2.0);
#endif
  vec3 sum = u_diffuse * studio_radiance(p, n, R(1.2)) * open;
#if LOBES > 0
  vec3 wide = studio_radiance(p, r, spread / u_inv_m.x) * open;
  sum += make_vec3(u_lobe[0]) * (R(4.0) * fresnel_schlick(cb, u_lobe[0].w)) * wide;
#endif
#if LOBES > 1
  sum += make_vec3(u_lobe[1]) * (R(4.0) * fresnel_schlick(cb, u_lobe[1].w)) *
         studio_radiance(p, r, spread / u_inv_m.y) * (R(0.5) + R(0.5) * open);
#endif
#if LOBES > 2
  sum += make_vec3(u_lobe[2]) * (R(4.0) * fresnel_schlick(cb, u_lobe[2].w)) *
         studio_radiance(p, r, spread / u_inv_m.z) * (R(0.5) + R(0.5) * open);
#endif
#if HAS_TABLE || HAS_FLAKES
  real theta_o = min(atan(sqrt(max(R(1.0) - cb * cb, R(0.0))), cb), R(1.0));
#endif
#if HAS_TABLE
  sum *= chi_factor(R(0.0), theta_o);
#endif
#if HAS_FLAKES && LOBES > 0
  sum += flake_mean(R(0.0), theta_o) * u_flake_fill * wide;
#endif
#if HAS_COAT
  // In through the coat from everywhere (diffuse transmission about 1 - F at 60 degrees), out towards the eye.
  sum *= (R(1.0) - fresnel_dielectric(co, u_coat_ior)) * (R(1.0) - fresnel_dielectric(R(0.5), u_coat_ior));
#endif
  return sum;
}

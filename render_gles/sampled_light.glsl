// Light from the environment for still pictures: every frame draws one direction for each part of the paint from that
// part's own distribution, and asks the environment at the level whose width fits the gap between neighbouring samples
// (filtered importance sampling, Krivanek & Colbert 2008). The mean over u_sample_count frames is the integral.
//
// From the surroundings: paint_model.glsl, environment.glsl; u_sample (the frame's place in a rank-1 lattice, xy, and
// number of frames, z); u_flake_m (Beckmann roughness of the mean flakes); varyings' visible(d).
uniform vec3 u_sample;
#if HAS_FLAKES
uniform float u_flake_m;
#endif

// The lattice rotated by white noise, another one for each part: what is left of the error is grain without structure.
vec2 sample_place(real part) {
  vec2 at = gl_FragCoord.xy + vec2(31.0, 17.0) * part;
  vec2 noise = fract(sin(vec2(dot(at, vec2(12.9898, 78.233)), dot(at, vec2(39.3468, 11.1357)))) * 43758.5453);
  return fract(u_sample.xy + noise);
}
vec3 tangent_of(vec3 n) {
  return normalize(abs(n.z) < 0.9 ? cross(n, vec3(0.0, 0.0, 1.0)) : cross(n, vec3(1.0, 0.0, 0.0)));
}

// Level for samples of this density (per steradian, of one frame): a Beckmann level of roughness m peaks at
// 1 / (4 pi m^2); it is taken 1.4 times as wide as the gap between the samples of all frames. Measured against the
// reference (docs/figures.md): 1.0 leaves more grain, 2.0 a bias of a step. Levels follow log2(m / 0.04) closely.
real sample_level(real density) {
  real m = 1.4 * inversesqrt(max(density * u_sample.z * 12.566370614, 1e-6));
  real x = log2(m * 25.0);
  return clamp(x > 0.0 ? 2.0 + x * (1.0 + 0.11 * x) : m * 50.0, 0.0, 9.0);
}

vec3 sampled_radiance(vec3 p, vec3 d, real density) {
  return environment_at(room_direction(p, d), sample_level(density)) * visible(d);
}

real coat_through(real ci, real co) {
#if HAS_COAT
  return (1.0 - fresnel_dielectric(ci, u_coat_ior)) * (1.0 - fresnel_dielectric(co, u_coat_ior));
#else
  return 1.0;
#endif
}

// A direction of light whose half vector inside the coat is Beckmann-distributed. Gives the geometry inside, the
// direction outside, and in `weight` (1 / density) * cos per unit of rho / pi; 0 where no light comes from there.
// Density of `in`: D cos(theta_h) / (4 pi h.o); outside it is smaller by eta^2 cos_in / cos_out.
real lobe_direction(vec3 n, vec3 inside_o, real m, vec2 u, out vec3 i, out Geometry g, out real density) {
  real tan_h = m * sqrt(-log2(max(1.0 - u.x, 1e-7)) * 0.6931471806);
  real c = inversesqrt(1.0 + tan_h * tan_h);
  vec3 t = tangent_of(n);
  real phi = 6.283185307 * u.y;
  vec3 h = (t * cos(phi) + cross(n, t) * sin(phi)) * (tan_h * c) + n * c;
  real ho = dot(h, inside_o);
  vec3 in_i = h * (2.0 * ho) - inside_o;
  real iz = dot(n, in_i);
  i = n;
  density = 1.0;
  g = paint_geometry(n, in_i, inside_o);
#if HAS_REFRACTION
  real eta = u_refraction_ior;
#else
  real eta = 1.0;
#endif
  real sine2 = (1.0 - iz * iz) * eta * eta;
  if (ho <= MIN_COSINE || iz <= MIN_COSINE || g.oz <= MIN_COSINE || sine2 >= 1.0) return 0.0;
  real ci = sqrt(1.0 - sine2);
  i = (in_i - n * iz) * eta + n * ci;
  real x = min(tan_h / m, 16.0);
  real d_cos = exp2(-x * x * 1.4426950409 - 2.0 * log2(m) - 3.0 * log2(c));
  density = d_cos * ci / (12.566370614 * ho * eta * eta * iz);
  return eta * eta * iz * 4.0 * ho / d_cos;
}

vec3 sampled_lobe(vec3 p, vec3 n, vec3 o, vec3 inside_o, vec4 lobe, real inv_m, real part) {
  vec3 i;
  Geometry g;
  real density;
  real weight = lobe_direction(n, inside_o, 1.0 / inv_m, sample_place(part), i, g, density);
  if (weight <= 0.0) return vec3(0.0);
  vec3 rho = lobe.xyz * (fresnel_schlick(g.ho, lobe.w) * lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, inv_m, 1.0));
#if HAS_TABLE
  rho *= chi_factor(g.theta_h, g.theta_i);
#endif
#if COLOUR_MAP > 0
  rho *= map_factor(n, i, o);
#endif
  return rho * (weight * coat_through(dot(n, i), dot(n, o))) * sampled_radiance(p, i, density);
}

vec3 sampled_environment(vec3 p, vec3 n, vec3 o, vec2 texel, real lod) {
#if HAS_REFRACTION
  vec3 inside_o = refract_into(o, n, u_refraction_ior);
#else
  vec3 inside_o = o;
#endif
  vec3 sum = vec3(0.0);
  real co = dot(n, o);
  {
    vec2 u = sample_place(0.0);
    vec3 t = tangent_of(n);
    real phi = 6.283185307 * u.y;
    real ci = sqrt(1.0 - u.x);
    vec3 i = (t * cos(phi) + cross(n, t) * sin(phi)) * sqrt(u.x) + n * ci;
    vec3 rho = u_diffuse * coat_through(ci, co);
#if HAS_TABLE
#if HAS_REFRACTION
    Geometry g = paint_geometry(n, refract_into(i, n, u_refraction_ior), inside_o);
#else
    Geometry g = paint_geometry(n, i, inside_o);
#endif
    rho *= chi_factor(g.theta_h, g.theta_i);
#endif
#if COLOUR_MAP > 0
    rho *= map_factor(n, i, o);
#endif
    sum += rho * sampled_radiance(p, i, ci * 0.3183098862);
  }
#if LOBES > 0
  sum += sampled_lobe(p, n, o, inside_o, u_lobe[0], u_inv_m.x, 1.0);
#endif
#if LOBES > 1
  sum += sampled_lobe(p, n, o, inside_o, u_lobe[1], u_inv_m.y, 2.0);
#endif
#if LOBES > 2
  sum += sampled_lobe(p, n, o, inside_o, u_lobe[2], u_inv_m.z, 3.0);
#endif
#if HAS_FLAKES
  {
    vec3 i;
    Geometry g;
    real density;
    real weight = lobe_direction(n, inside_o, u_flake_m, sample_place(4.0), i, g, density);
    if (weight > 0.0) {
#if SINGLE_FLAKES
      vec3 rho = flake_factor(g.theta_h, g.theta_i, texel, lod);
#else
      vec3 rho = flake_mean(g.theta_h, g.theta_i);
#endif
      sum += rho * (weight * coat_through(dot(n, i), co)) * sampled_radiance(p, i, density);
    }
  }
#endif
  return sum;
}

// The waves in a clear coat's surface: they bend its mirror image and nothing else, for flakes and lobes lie below it.
//
// Twelve plane waves through space, so that no uvs and no derivatives are needed and both halves of the car agree. Their
// directions are the six axes of an icosahedron, twice: the squares of the sines between these and any normal add up
// to 12 * 2/3, so every face of the body is rough by the same amount. A slope of rms u_peel (radians) needs an amplitude
// a of each wave with 12 * 2/3 * a^2 / 2 = u_peel^2: a = u_peel / 2. Wavelengths are 2.4 to 9 mm, what wave scanners
// call the range Wc and Wd; a slow warp of the place keeps the eye from finding a lattice.
//
// A wave narrower than four pixels is faded, one narrower than two is gone: from afar nothing can alias.
// From the surroundings: float u_peel (radians, rms); float u_peel_pixel (width of a pixel at 1 m distance, mm).
uniform float u_peel;
uniform float u_peel_pixel;

// Waves along the axes (0, 1, +-t), (1, +-t, 0), (t, 0, +-1) with t the golden ratio, scaled to unit length. q in mm;
// `pixel`: mm. k0, k1: wave numbers (radians per mm) along the two axes.
vec3 peel_pair(vec3 q, vec3 axis0, vec3 axis1, float k0, float k1, float pixel) {
  vec2 fade = clamp(vec2(3.141592654) / (vec2(k0, k1) * pixel) - vec2(1.0), 0.0, 1.0);
  return axis0 * (fade.x * sin(k0 * dot(axis0, q))) + axis1 * (fade.y * sin(k1 * dot(axis1, q)));
}

// n tilted by the slope of the waves at p (m).
vec3 peeled_normal(vec3 n, vec3 p, float distance_m, float co) {
  const float s = 0.525731112;
  const float t = 0.850650808;
  float pixel = max(distance_m * u_peel_pixel, 1e-4) * inversesqrt(max(co, 0.05));
  vec3 q = p * 1000.0;
  q += 2.0 * sin(q.yzx * 0.21 + vec3(0.3, 1.7, 4.1)) + 0.8 * sin(q.zxy * 0.47 + vec3(2.9, 0.6, 5.3));
  vec3 slope = peel_pair(q, vec3(0.0, s, t), vec3(0.0, s, -t), 0.70, 0.79, pixel) +
               peel_pair(q, vec3(s, t, 0.0), vec3(s, -t, 0.0), 0.89, 1.00, pixel) +
               peel_pair(q, vec3(t, 0.0, s), vec3(-t, 0.0, s), 1.13, 1.27, pixel);
  q += vec3(11.3, 4.7, 7.9);
  slope += peel_pair(q, vec3(0.0, s, t), vec3(0.0, s, -t), 1.84, 2.07, pixel) +
           peel_pair(q, vec3(s, t, 0.0), vec3(s, -t, 0.0), 2.33, 2.62, pixel) +
           peel_pair(q, vec3(t, 0.0, s), vec3(-t, 0.0, s), 1.43, 1.62, pixel);
  slope *= 0.5 * u_peel;
  return normalize(n - (slope - n * dot(n, slope)));
}

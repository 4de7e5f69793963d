// Isochromatic lines, written once: this text is GLSL ES 1.00 and, included inside the struct of isochromatic.hpp, C++.
// Same rules as paint_model.glsl; it needs nothing from its surroundings.
//
// All pairs of directions that reach the eye from flakes of one tilt (theta_flake) at one angle of incidence on the
// flake (theta_inc) lie on one line and show one colour (Kirchner & Ferrero 2014). Each line meets the plane of
// incidence twice, where the angles inside the coat are theta_inc + theta_flake and theta_inc - theta_flake: Kirchner
// et al. 2015, eq. 5 to 7, collapse to this sum and difference, without a division and without a singular case. A
// difference below zero puts light and eye on the same side of the normal (phi' = 0), else opposite (phi' = 180).
//
// Nothing is refracted here. With g = sqrt(index^2 - 1 + c^2) = index times the cosine inside (Fresnel's g), and the
// parts of i + o and i - o along the surface, which refraction divides by the index, everything is index times the
// vector inside the coat, and the sines that come out are those in air.

// Of i + o and i - o inside the coat, times its index. Unchanged, to the last bit, when i and o are exchanged.
struct Isoline {
  real along;       // part of the sum along the normal, >= 1e-4
  real across;      // length of its part in the surface; tan(theta_flake) = across / along
  real difference;  // length of the difference, 2 index sin(theta_inc)
};

// 16 bits, index in [1.05, 2.5]: c^2 below 6e-5 (89.5 degrees) adds nothing to index^2 - 1 >= 0.1, so along stays
// within [0.64, 5]. A length below 7.8e-3 squares to less than 6.1e-5, the smallest normal number, and becomes 0:
// theta_flake or theta_inc is then wrong by 0.45 degrees at most, right at the mirror or the retro direction.
// Index 1: along = ci + co, below 1e-4 only where both directions lie in the horizon; the clamp makes the normal the
// half vector of opposite ones.
Isoline isoline(vec3 n, vec3 i, vec3 o, real index) {
  real ci = max(dot(n, i), R(0.0));
  real co = max(dot(n, o), R(0.0));
  real bend = (index - R(1.0)) * (index + R(1.0));
  Isoline line;
  line.along = max(sqrt(bend + ci * ci) + sqrt(bend + co * co), R(1e-4));
  line.across = length(cross(n, i + o));
  real upright = (ci - co) * ((ci + co) / line.along);  // g_i - g_o without cancellation
  real level = length(cross(n, i - o));
  line.difference = sqrt(upright * upright + level * level);
  return line;
}

// Sines in air of the two in-plane angles: x of theta_inc + theta_flake, in [0, index]; y of theta_inc - theta_flake,
// signed, in [-1, 1]. x > 1 is beyond the critical angle. The other in-plane solution has light and eye exchanged.
// The sines of theta_flake are taken from lengths divided by the larger one, so that at index 1 and grazing angles,
// where both are small, their squares do not vanish in 16 bits. Below index sqrt 2 the sum can pass 90 degrees inside
// the coat, where its sine would fall again: it stays at its largest value instead.
vec2 isochromatic_sines(Isoline line, real index) {
  real larger = max(line.along, line.across);
  real a = line.along / larger;
  real b = line.across / larger;
  real c = line.difference / sqrt(a * a + b * b);
  real inc = a * c;  // 2 index sin(theta_inc) cos(theta_flake)
  real x = line.along < b * c ? index : R(0.5) * (inc + line.across);
  return vec2(x, clamp(R(0.5) * (inc - line.across), R(-1.0), R(1.0)));
}

// 1 - cos of an angle by its sine, without cancellation: s^2 / (1 + cos). Sines beyond 1 are clipped. 1 - s is exact
// from s = 1/2 on, 1 - s^2 is not.
real isochromatic_versine(real sine) {
  real s = min(abs(sine), R(1.0));
  return s * s / (R(1.0) + sqrt((R(1.0) - s) * (R(1.0) + s)));
}

// Place in the colour map as it is drawn: x = 1 - cos(theta'_ill) in [0, 1]; y = 1 - cos(theta'_det) in the half
// phi' = 180, its negative in the half phi' = 0, so that the halves meet where theta'_det = 0 and the gloss line is
// x = y. Cure A of the critical angle: a sine beyond 1 is clipped.
vec2 isochromatic_clip(vec2 sines) {
  real y = isochromatic_versine(sines.y);
  return vec2(isochromatic_versine(sines.x), sines.y < R(0.0) ? -y : y);
}

// Cure B: beyond the critical angle the cosine is imaginary; its magnitude continues the map to the right of x = 1, and
// the place moves back to x = 1 on a diagonal. towards_gloss 1: perpendicular to the gloss line, as KI print it; -1:
// beside the gloss line, x - y kept, which keeps the aspecular angle, as their argument for it has it. With index <= 2.5
// the magnitude stays below 2.3.
vec2 isochromatic_slide(vec2 sines, real towards_gloss) {
  vec2 place = isochromatic_clip(sines);
  real beyond = sqrt(max(sines.x * sines.x - R(1.0), R(0.0)));
  return vec2(place.x, clamp(place.y + towards_gloss * beyond, R(-1.0), R(1.0)));
}

// cos(theta'_ill), cos(theta'_det), and the half: 1 for phi' = 180, -1 for phi' = 0.
vec3 isochromatic_cosines(vec2 place) {
  return vec3(R(1.0) - place.x, R(1.0) - abs(place.y), place.y < R(0.0) ? R(-1.0) : R(1.0));
}

// Place in the texture, [0, 1] x [-1, 1]: sqrt(1 - cos) = sqrt(2) sin(theta / 2) is nearly even in the angle, and a
// colour that is smooth across the normal stays smooth. Over cosines it has a cusp there: a texel of 1/64 beside the
// normal would span 10 degrees.
vec2 isochromatic_texel(vec2 place) {
  real y = sqrt(abs(place.y));
  return vec2(sqrt(place.x), place.y < R(0.0) ? -y : y);
}

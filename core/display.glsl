// From scene-linear sRGB to the screen's bytes, written once for shader and CPU (same rules as paint_model.glsl).

// Tone curve on the largest channel alone, all three scaled alike, so that a paint keeps its hue and saturation: linear
// up to 0.45, then a rational shoulder (slope 1 where it begins, 1 far away) that still tells 2 from 4, because a silver
// flashes that bright. Only what would be far brighter than the screen's white loses colour, as film and eyes do: half
// way at 16 times white.
real tone_curve(real x) {
  real over = max(x - R(0.45), R(0.0));
  return x <= R(0.45) ? x : R(0.45) + over / (R(1.0) + over / R(0.55));
}
real srgb_curve(real x) {
  return x <= R(0.0031308) ? x * R(12.92) : R(1.055) * pow(x, R(0.4166666667)) - R(0.055);
}
vec3 display_transform(vec3 linear) {
  vec3 v = max(linear, vec3(R(0.0)));
  real peak = max(max(v.x, v.y), v.z);
  real white = peak / (peak + R(16.0));
  v = v * (R(1.0) - white) + vec3(peak * white);
  v = v * (tone_curve(peak) / max(peak, R(1e-6)));
  return vec3(srgb_curve(v.x), srgb_curve(v.y), srgb_curve(v.z));
}
// Breaks up banding before the 8-bit rounding: interleaved gradient noise (Jimenez 2014), +-half a step.
real dither_noise(real x, real y) {
  return (fract(R(52.9829189) * fract(R(0.06711056) * x + R(0.00583715) * y)) - R(0.5)) / R(255.0);
}

// Light on a point of a scan, written once for shader and CPU (same rules as core/display.glsl).

// Times albedo: what a two-sided leaf with this unit normal sends towards `to_eye` (any length). `open`: the share of
// the sky that it sees, [0, 1]; up and key: unit vectors, upwards and towards the key light; sky, sun: linear.
vec3 scan_light(vec3 normal, vec3 to_eye, real open, vec3 up, vec3 key, vec3 sky, vec3 sun) {
  vec3 n = dot(normal, to_eye) < R(0.0) ? -normal : normal;
  real front = dot(n, key);
  // Leaves let about a third through, greener than they throw it back.
  vec3 light = sun * max(front, R(0.0)) + vec3(R(0.25), R(0.38), R(0.10)) * sun * max(-front, R(0.0));
  real reached = R(0.12) + R(0.88) * open;  // what the rays were too coarse to see, and what bounces
  return light * (R(0.35) + R(0.65) * reached) + sky * ((R(0.6) + R(0.4) * dot(n, up)) * reached);
}

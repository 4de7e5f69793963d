// The finished picture, for the panel: copied, or taken to the panel's primaries and curve. Appended to display.glsl,
// for its noise. With PROFILE, WARNING and TABLE_SIZE defined.
varying vec2 v_at;  // in the picture, row 0 at the bottom
uniform sampler2D u_picture;
uniform float u_bgr;         // 1: blue first
uniform float u_brightness;  // of the picture's display values, [0, 1]
#if PROFILE
// Numbers in [0, 1] of 16 bits, high byte in x and low byte in y. Rows from below: the pixel value of each of the
// panel's channels by the square root of its light, and the square root of light by the picture's 8-bit sRGB value.
// Square roots, because even steps of them are nearly even steps to the eye, on any panel.
uniform sampler2D u_tables;
uniform mat3 u_panel;  // the panel's linear RGB of linear sRGB

float table(float at, float row) {
  vec4 t = texture2D(u_tables, vec2(at, (row + 0.5) * 0.25));
  return t.x * 0.99610895 + t.y * 0.00389105;  // 255 * 256 and 255 of 65535, which itself is beyond 16-bit floats
}
float light(float pixel) {
  float root = table(pixel * (255.0 / 256.0) + 0.5 / 256.0, 3.0);
  return root * root;
}
float pixel(float lit, float row) {
  return table(sqrt(clamp(lit, 0.0, 1.0)) * ((TABLE_SIZE - 1.0) / TABLE_SIZE) + 0.5 / TABLE_SIZE, row);
}
#endif

void main() {
  vec3 c = u_brightness * texture2D(u_picture, v_at).xyz;
#if PROFILE
  vec3 lit = u_panel * vec3(light(c.x), light(c.y), light(c.z));
  // Noise before the second rounding, too, or the curve would band what the picture's own noise had smoothed. Its axes
  // change places, so that the two do not walk in step; a little under half a step, so that black and white stay clean.
  vec3 noise = vec3(0.95 * dither_noise(gl_FragCoord.y + 31.0, gl_FragCoord.x + 17.0));
  c = vec3(pixel(lit.x, 0.0), pixel(lit.y, 1.0), pixel(lit.z, 2.0)) + noise;
#if WARNING
  float excess = max(max(lit.x, max(lit.y, lit.z)) - 1.0, -min(lit.x, min(lit.y, lit.z)));
  if (excess > GAMUT_TOLERANCE) {
    float across = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0);
    if (across < 3.0) c = vec3(0.0);
    else if (across < 6.0) c = vec3(1.0);
  }
#endif
#endif
  gl_FragColor = vec4(u_bgr > 0.5 ? vec3(c.z, c.y, c.x) : c, 1.0);
}

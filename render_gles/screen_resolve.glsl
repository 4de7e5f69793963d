// The mean of all frames so far (sums in two textures), shown. Appended to display.glsl.
varying vec2 v_at;
uniform sampler2D u_first;
uniform sampler2D u_second;
uniform vec2 u_factors;  // of the two sums
uniform float u_dither;
uniform float u_alpha;
void main() {
  vec3 lit = texture2D(u_first, v_at).xyz * u_factors.x + texture2D(u_second, v_at).xyz * u_factors.y;
  vec3 shown = display_transform(lit) + vec3(u_dither * dither_noise(gl_FragCoord.x, gl_FragCoord.y));
  gl_FragColor = vec4(shown, u_alpha);
}

// The floor under a scan, with the shade of what stands above it. With display.glsl before it.
varying vec2 v_at;
uniform sampler2D u_shade;  // x: of the earlier scan, w: of the later one
uniform float u_time, u_dither;
uniform vec3 u_floor_light, u_backdrop;  // linear

void main() {
  vec4 shade = texture2D(u_shade, v_at * 0.5 + 0.5);
  float dark = mix(shade.x, shade.w, u_time);
  float reach = clamp(1.0 - dot(v_at, v_at), 0.0, 1.0);
  vec3 colour = mix(u_backdrop, u_floor_light * (1.0 - 0.85 * dark), reach * reach);
  gl_FragColor = vec4(display_transform(colour) + u_dither * vec3(dither_noise(gl_FragCoord.x, gl_FragCoord.y)), 1.0);
}

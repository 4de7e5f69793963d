// A texture times a factor; with alpha u_alpha where that is not negative.
varying vec2 v_at;
uniform sampler2D u_first;
uniform float u_factor;
uniform float u_alpha;
void main() {
  vec4 t = texture2D(u_first, v_at) * u_factor;
  gl_FragColor = u_alpha < 0.0 ? t : vec4(t.xyz, u_alpha);
}

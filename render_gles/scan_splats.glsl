// Points that the CPU has drawn, over the floor: texel for pixel.
varying vec2 v_at;
uniform sampler2D u_splats;

void main() {
  vec4 texel = texture2D(u_splats, v_at);
  if (texel.w < 0.5) discard;
  gl_FragColor = vec4(texel.xyz, 1.0);
}

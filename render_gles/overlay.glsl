// A rectangle of the overlay. TEXTURE 0: only a factor on what is there; 1: a part of a picture; 2: a tile, whose bytes
// come blue first. FACTOR: whether u_factor counts.
varying vec2 v_at;
uniform sampler2D u_texture;
uniform vec4 u_factor;
void main() {
#if TEXTURE == 2
  vec4 c = texture2D(u_texture, v_at).zyxw;
#elif TEXTURE == 1
  vec4 c = vec4(texture2D(u_texture, v_at).xyz, 1.0);
#else
  vec4 c = vec4(1.0);
#endif
#if FACTOR
  c *= u_factor;
#endif
  gl_FragColor = c;
}

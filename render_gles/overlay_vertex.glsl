// A rectangle of the overlay: its corners come in clip space.
attribute vec2 a_corner;
attribute vec2 a_at;
varying vec2 v_at;
void main() {
  v_at = a_at;
  gl_Position = vec4(a_corner, 0.0, 1.0);
}

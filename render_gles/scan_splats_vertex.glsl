attribute vec2 a_corner;  // [-1, 1]
uniform vec4 u_rectangle; // its middle and half its edges, clip space
uniform vec2 u_used;      // share of the texture that it shows
varying vec2 v_at;

void main() {
  v_at = (a_corner * 0.5 + 0.5) * u_used;
  gl_Position = vec4(u_rectangle.xy + a_corner * u_rectangle.zw, 0.0, 1.0);
}

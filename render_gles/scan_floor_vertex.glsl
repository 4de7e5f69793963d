attribute vec2 a_corner;     // [-1, 1]
uniform mat4 u_floor;        // clip space of the floor's square
varying vec2 v_at;           // on the floor, [-1, 1]

void main() {
  v_at = a_corner;
  gl_Position = u_floor * vec4(a_corner, 0.0, 1.0);
}

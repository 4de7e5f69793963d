// All surfaces: world position and normal go through; the camera is the only transform (scenes are built in place).
// attribute vec3 a_position (mm), a_normal; attribute float a_open (1 = open, 0 = closed; baked occlusion).
// uniform mat4 u_clip_from_world.
attribute vec3 a_position;
attribute vec3 a_normal;
attribute float a_open;
uniform mat4 u_clip_from_world;
varying vec3 v_position;
varying vec3 v_normal;
varying float v_open;

void main() {
  v_position = a_position;
  v_normal = a_normal;
  v_open = a_open;
  gl_Position = u_clip_from_world * vec4(a_position, 1.0);
}

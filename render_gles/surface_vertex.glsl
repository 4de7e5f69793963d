// All surfaces: the camera is the only transform (scenes are built in place). Distances leave in metres, so that 16-bit
// fragment shaders keep a millimetre or two.
//
// attribute vec3 a_position (mm), a_normal, a_irradiance (square root, see packs/scene.hpp), a_visible0..2 (bytes).
// uniform mat4 u_clip_from_world; uniform vec3 u_eye (mm); uniform float u_irradiance_range.
attribute vec3 a_position;
attribute vec3 a_normal;
uniform mat4 u_clip_from_world;
uniform vec3 u_eye;
varying vec3 v_position;  // m
varying vec3 v_to_eye;    // m
varying vec3 v_normal;
#if HAS_IRRADIANCE
attribute vec3 a_irradiance;
uniform float u_irradiance_range;
varying vec3 v_irradiance;
#endif
#if HAS_VISIBILITY
attribute vec3 a_visible0;
attribute vec3 a_visible1;
attribute vec3 a_visible2;
varying vec3 v_visible0;
varying vec3 v_visible1;
varying vec3 v_visible2;
#endif

void main() {
  v_position = a_position * 0.001;
  v_to_eye = (u_eye - a_position) * 0.001;
  v_normal = a_normal;
#if HAS_IRRADIANCE
  v_irradiance = a_irradiance * a_irradiance * u_irradiance_range;
#endif
#if HAS_VISIBILITY
  // Bytes arrive as [0, 1]; a coefficient is (byte - 128) / 64.
  v_visible0 = a_visible0 * 3.984375 - 2.0;
  v_visible1 = a_visible1 * 3.984375 - 2.0;
  v_visible2 = a_visible2 * 3.984375 - 2.0;
#endif
  gl_Position = u_clip_from_world * vec4(a_position, 1.0);
}

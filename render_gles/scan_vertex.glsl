// A point of a scan on its straight way from one scan to the next, lit where it is. With R(), display.glsl and
// scan_light.glsl before it; ScanSplatter does the same on the CPU.
attribute vec4 a_from, a_to;                // place in the pack's cube; size
attribute vec4 a_from_normal, a_to_normal;  // unit vector; sky seen
uniform float u_time;                       // [0, 1] within the step
uniform mat4 u_clip;                        // clip space of the pack's cube
uniform vec3 u_up, u_key;                   // unit vectors in the scan's axes: upwards, towards the key light
uniform vec3 u_eye;                         // in the pack's cube
uniform vec3 u_albedo, u_sky, u_sun;        // linear; light of the sky from above and of the key light
uniform float u_point;                      // size in pixels at clip w of 1
uniform vec2 u_sizes;                       // least and most pixels of a splat
varying vec3 v_colour;

void main() {
  vec4 place = mix(a_from, a_to, u_time);
  vec4 surface = mix(a_from_normal, a_to_normal, u_time);
  gl_Position = u_clip * vec4(place.xyz, 1.0);
  float size = u_point * place.w / gl_Position.w;
  gl_PointSize = clamp(size, u_sizes.x, u_sizes.y);
  // Gone altogether: outside of what is seen.
  if (place.w < 0.004) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  vec3 n = surface.xyz / max(length(surface.xyz), 0.01);
  vec3 light = scan_light(n, u_eye - place.xyz, surface.w, u_up, u_key, u_sky, u_sun);
  v_colour = display_transform(u_albedo * light);
}

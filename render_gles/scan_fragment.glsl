varying vec3 v_colour;

void main() {
#if ROUND
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  if (dot(at, at) > 1.0) discard;
#endif
  gl_FragColor = vec4(v_colour, 1.0);
}

// The environment, written once for shader and CPU (same rules as paint_model.glsl). core/environment.hpp says what the
// atlas holds; its sizes stand here once more because GLSL cannot read C++ (a test compares them).
//
// From the surroundings: fetch_environment(x, y) (linearly filtered RGBA at texel coordinates of the atlas),
// u_room (centre x y z, radius; radius 0 = far away), u_environment_scale (range times the mood's gain).

#define ENV_STACK_X R(773.0)
#define ENV_STACK_EDGE R(96.0)
#define ENV_STACK_STEP R(98.0)

vec3 decode_environment(vec4 t) {
  vec3 c = make_vec3(t) * t.w;
  return c * c * u_environment_scale;
}

// Where the ray from p (mm) along d (unit) meets the room, as a direction from the room's centre (not normalised:
// the octahedral map does not need it).
vec3 room_direction(vec3 p, vec3 d) {
  if (u_room.w <= R(0.0)) return d;
  vec3 q = p - make_vec3(u_room);
  real b = dot(q, d);
  real t = sqrt(max(b * b - dot(q, q) + u_room.w * u_room.w, R(0.0))) - b;
  if (d.z < R(-1e-4)) t = min(t, max(p.z, R(0.0)) / -d.z);
  return q + d * t;
}

// Unit square of the octahedral map.
vec2 octahedral_uv(vec3 d) {
  real s = R(1.0) / (abs(d.x) + abs(d.y) + abs(d.z));
  real x = d.x * s;
  real y = d.y * s;
  if (d.z < R(0.0)) {
    real fx = (R(1.0) - abs(y)) * (x < R(0.0) ? R(-1.0) : R(1.0));
    y = (R(1.0) - abs(x)) * (y < R(0.0) ? R(-1.0) : R(1.0));
    x = fx;
  }
  return vec2(x * R(0.5) + R(0.5), y * R(0.5) + R(0.5));
}

// The map itself. d: as room_direction gives it.
vec3 environment_sharp(vec3 d) {
  vec2 uv = octahedral_uv(d);
  return decode_environment(fetch_environment(R(1.0) + uv.x * R(512.0), R(1.0) + uv.y * R(512.0)));
}
// The levels of one size; level in [2, 9].
vec3 environment_stacked(vec3 d, real level) {
  vec2 uv = octahedral_uv(d);
  real k = min(floor(level), R(8.0)) - R(2.0);
  real f = level - R(2.0) - k;
  real x = ENV_STACK_X + uv.x * ENV_STACK_EDGE;
  real y = R(1.0) + k * ENV_STACK_STEP + uv.y * ENV_STACK_EDGE;
  return decode_environment(fetch_environment(x, y)) * (R(1.0) - f) +
         decode_environment(fetch_environment(x, y + ENV_STACK_STEP)) * f;
}
// Any level in [0, 9].
vec3 environment_at(vec3 d, real level) {
  if (level >= R(2.0)) return environment_stacked(d, level);
  vec2 uv = octahedral_uv(d);
  vec3 middle = decode_environment(fetch_environment(R(1.0) + uv.x * R(256.0), R(515.0) + uv.y * R(256.0)));
  if (level >= R(1.0)) {
    vec3 rough = decode_environment(
        fetch_environment(ENV_STACK_X + uv.x * ENV_STACK_EDGE, R(1.0) + uv.y * ENV_STACK_EDGE));
    return middle * (R(2.0) - level) + rough * (level - R(1.0));
  }
  return environment_sharp(d) * (R(1.0) - level) + middle * level;
}

// The part of the light from d (unit) that the car lets through to a vertex: a quadratic in the direction, clamped.
// v0 = coefficients of 1, x, y; v1 = z, xy, yz; v2 = zx, x^2 - y^2, 3 z^2 - 1.
real visible_part(vec3 v0, vec3 v1, vec3 v2, vec3 d) {
  real v = v0.x + v0.y * d.x + v0.z * d.y + v1.x * d.z + v1.y * d.x * d.y + v1.z * d.y * d.z + v2.x * d.z * d.x +
           v2.y * (d.x * d.x - d.y * d.y) + v2.z * (R(3.0) * d.z * d.z - R(1.0));
  return clamp(v, R(0.0), R(1.0));
}

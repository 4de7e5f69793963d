#include "packs/tools/car/mirror.hpp"

#include <cmath>

#include "packs/tools/car/field.hpp"
#include "packs/tools/car/mesh_cutter.hpp"
#include "packs/tools/car/soft_math.hpp"

namespace lackwerk::packs::car {

namespace {

struct MirrorShape {
  Vec3 centre_mm{715.0, 948.0, 1040.0};
  Vec3 half_size_mm{90.0, 112.0, 60.0};
  double rear_face_x_mm = -26.0;  ///< from the centre: where the shell is cut off for the glass
  double rear_edge_mm = 16.0;
  double sweep = 0.30;       ///< the shell leans back towards its tip
  double taper = 0.16;       ///< and grows flatter
  double power = 2.7;        ///< 2 = ellipsoid, more = boxier
  double base_z_mm = -26.0;  ///< below: black
  double glass_scale = 0.86;
};

class MirrorField final : public Field {
 public:
  explicit MirrorField(const MirrorShape& shape) : shape_(shape) {}

  [[nodiscard]] double value(const Vec3& p) const override {
    const double scale = norm(p);
    const double shell = (scale - 1.0) * shape_.half_size_mm.z;
    return soft_max(shell, shape_.rear_face_x_mm - local(p).x, shape_.rear_edge_mm);
  }

  /// 1 on the shell, less inside, ignoring x where `flat`.
  [[nodiscard]] double norm(const Vec3& p, bool flat = false) const {
    const Vec3 q = local(p);
    const double thin = 1.0 - shape_.taper * q.y / shape_.half_size_mm.y;
    const auto term = [this](double v) { return std::pow(v * v + 1e-6, 0.5 * shape_.power); };
    const double x = flat ? 0.0 : term(q.x / shape_.half_size_mm.x);
    return std::pow(x + term(q.y / shape_.half_size_mm.y) + term(q.z / (shape_.half_size_mm.z * thin)),
                    1.0 / shape_.power);
  }

  [[nodiscard]] Vec3 local(const Vec3& p) const {
    Vec3 q = p - shape_.centre_mm;
    q.x += shape_.sweep * q.y;
    return q;
  }

 private:
  MirrorShape shape_;
};

Patch build_stalk(const MirrorShape& shape) {
  // Rises from the door's shoulder into the shell.
  const Vec3 foot{shape.centre_mm.x + 52.0, 832.0, 948.0};
  const Vec3 head = shape.centre_mm + Vec3{18.0, -52.0, -38.0};
  constexpr int rows = 9;
  constexpr int around = 16;
  const Patch tube = grid(rows, around + 1, [&](int r, int c) {
    const double t = static_cast<double>(r) / (rows - 1);
    const double a = 2.0 * 3.14159265358979323846 * (c % around) / around;
    const double half_long = 58.0 - 16.0 * t;
    const double half_thin = 17.0 + 10.0 * (1.0 - t) * (1.0 - t);
    const Vec3 middle = foot + (head - foot) * t + Vec3{0.0, 0.0, -14.0 * std::sin(3.14159 * t)};
    return middle + Vec3{half_long * std::cos(a), -0.45 * half_thin * std::sin(a), half_thin * std::sin(a)};
  });
  constexpr double smooth_deg = 80.0;
  return with_normals(tube, smooth_deg);
}

}  // namespace

MirrorPatches build_mirror() {
  const MirrorShape shape;
  const MirrorField field(shape);
  const Vec3 reach{170.0, 160.0, 120.0};
  SurfaceMesh mesh = wrap_field(field, {shape.centre_mm - reach, shape.centre_mm + reach, shape.centre_mm.x + 5.0,
                                        shape.centre_mm.x + 15.0, shape.centre_mm.z, shape.centre_mm.y, 48.0});
  refine(mesh, field, {[](const Vec3&) { return Tolerance{26.0, 14.0, 0.8}; }, 4.0});
  const auto glass = [&](const Vec3& p) { return (field.norm(p, true) - shape.glass_scale) * shape.half_size_mm.z; };
  const auto behind = [&](const Vec3& p) { return field.local(p).x < shape.rear_face_x_mm + 14.0; };
  const auto base = [&](const Vec3& p) { return p.z - shape.centre_mm.z - shape.base_z_mm; };
  MeshCutter cutter(mesh, field);
  cutter.cut({glass, behind});
  cutter.cut({base, [](const Vec3&) { return true; }});
  const auto middle = [&mesh](const Triangle& t) {
    return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0;
  };
  const auto is_glass = [&](const Triangle& t) { return behind(middle(t)) && glass(middle(t)) < 0.0; };
  const auto is_base = [&](const Triangle& t) { return base(middle(t)) < 0.0; };
  MirrorPatches mirror;
  mirror.glass = extract(mesh, field, is_glass);
  mirror.base = extract(mesh, field, [&](const Triangle& t) { return !is_glass(t) && is_base(t); });
  mirror.cap = extract(mesh, field, [&](const Triangle& t) { return !is_glass(t) && !is_base(t); });
  append(mirror.base, build_stalk(shape));
  return mirror;
}

}  // namespace lackwerk::packs::car

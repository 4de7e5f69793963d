// The painted body as one implicit solid.
//
// Why it exists: side, plan and section curves of `BodyShape` meet here in one function whose every derivative is
// continuous, so that the mesh can be as fine or coarse as it likes while normals stay exact. Immutable after
// construction, safe to share between threads.
#pragma once

#include "packs/tools/car/body_shape.hpp"
#include "packs/tools/car/field.hpp"

namespace lackwerk::packs::car {

class BodyField final : public Field {
 public:
  explicit BodyField(const BodyShape& shape);

  [[nodiscard]] double value(const Vec3& p) const override;

  /// Distance-like height over windscreen, roof and rear window; pillars are measured with it.
  [[nodiscard]] double over_roof(const Vec3& p) const;
  /// Distance-like height over the cabin's side glass.
  [[nodiscard]] double beside_cabin(const Vec3& p) const;
  /// x along the cabin's centre profile: constant along the bowed edges of windscreen and rear window.
  [[nodiscard]] double roof_x(const Vec3& p) const { return p.x + cabin_sweep_(p.x) * p.y * p.y; }
  /// Height of the shoulder line at x.
  [[nodiscard]] double shoulder_z(double x) const { return shoulder_z_(x); }
  /// Negative where the cabin, positive where the lower body makes the surface.
  [[nodiscard]] double cabin_over_body(const Vec3& p) const;

 private:
  [[nodiscard]] double rounded_abs(double y) const;
  [[nodiscard]] double flank_half_width(double x, double z) const;
  [[nodiscard]] double deck_height(double x, double y) const;
  [[nodiscard]] double lower_body(const Vec3& p) const;
  [[nodiscard]] double cabin(const Vec3& p) const;

  BodyShape shape_;
  SoftProfile plan_, shoulder_z_, shoulder_rounding_, undercut_, sill_flare_z_, deck_z_, crease_y_, crease_kick_,
      crest_y_, deck_edge_, nose_x_, tail_x_, floor_z_, cabin_plan_, roof_z_, cabin_sweep_, rail_rounding_,
      waist_rounding_;
};

}  // namespace lackwerk::packs::car

#include "packs/tools/car/body_field.hpp"

#include <cmath>

namespace lackwerk::packs::car {

namespace {

/// soft_ramp made even in y, so that it adds no crease at the centre line.
double even_ramp(double y, double start, double rounding) {
  return soft_ramp(y - start, rounding) + soft_ramp(-y - start, rounding);
}

double blister(double distance_from_axle, double z, double half_width, const LowerBodyShape& lower) {
  const double beyond = soft_ramp(distance_from_axle - lower.blister_start_radius_mm, lower.blister_rounding_mm);
  const double below = soft_ramp(lower.blister_low_z_mm - z, lower.blister_rounding_mm);
  return half_width - lower.blister_slope * beyond - lower.blister_low_slope * below;
}

}  // namespace

BodyField::BodyField(const BodyShape& shape)
    : shape_(shape),
      plan_(shape.lower.plan_half_width),
      shoulder_z_(shape.lower.shoulder_z),
      shoulder_rounding_(shape.lower.shoulder_rounding),
      undercut_(shape.lower.lower_undercut),
      sill_flare_z_(shape.lower.sill_flare_z),
      deck_z_(shape.lower.deck_z),
      crease_y_(shape.lower.bonnet_crease_y),
      crease_kick_(shape.lower.bonnet_crease_kick),
      crest_y_(shape.lower.fender_crest_y),
      deck_edge_(shape.lower.deck_edge_rounding),
      nose_x_(shape.lower.nose_x),
      tail_x_(shape.lower.tail_x),
      floor_z_(shape.lower.floor_z),
      cabin_plan_(shape.cabin.plan_half_width),
      roof_z_(shape.cabin.roof_z),
      cabin_sweep_(shape.cabin.plan_sweep_per_mm),
      rail_rounding_(shape.cabin.rail_rounding),
      waist_rounding_(shape.cabin.waist_rounding) {}

double BodyField::rounded_abs(double y) const {
  // Shifted so that the full width, not the centre, keeps its exact value (error under 0.1 mm for |y| > 600).
  constexpr double typical_half_width_mm = 900.0;
  const double e = shape_.symmetry_rounding_mm;
  const double shift = std::hypot(typical_half_width_mm, e) - typical_half_width_mm;
  return std::hypot(y, e) - shift;
}

double BodyField::flank_half_width(double x, double z) const {
  const LowerBodyShape& lower = shape_.lower;
  const double plan = plan_(x);
  const double rise = z - shoulder_z_(x);
  const double undercut = undercut_(x);
  // The crown must not turn the face outward again far below the line, where it is not used: a ramp, not a parabola.
  const double above = soft_ramp(rise, 60.0);
  const double upper = plan - lower.upper_lean * rise - lower.upper_crown_per_mm * above * above;
  const double under_flare = soft_ramp(sill_flare_z_(x) - z, lower.sill_flare_rounding_mm);
  const double under_roll = soft_ramp(lower.sill_roll_z_mm - z, lower.sill_roll_rounding_mm);
  const double bow = z - lower.door_crown_z_mm;
  const double door = plan + undercut * rise - lower.door_crown_per_mm * bow * bow +
                      (lower.sill_flare + undercut) * under_flare - (lower.sill_flare + lower.sill_roll) * under_roll;
  const double dz = z - shape_.wheels.centre_z_mm;
  const double front =
      blister(std::hypot(x - shape_.wheels.front_axle_x_mm, dz), z, lower.blister_half_width_front_mm, lower);
  const double rear =
      blister(std::hypot(x - shape_.wheels.rear_axle_x_mm, dz), z, lower.blister_half_width_rear_mm, lower);
  const double side = soft_max(soft_max(door, front, lower.blister_blend_mm), rear, lower.blister_blend_mm);
  return soft_min(upper, side, shoulder_rounding_(x));
}

double BodyField::deck_height(double x, double y) const {
  const LowerBodyShape& lower = shape_.lower;
  return deck_z_(x) - lower.deck_crown_per_mm * y * y +
         crease_kick_(x) * even_ramp(y, crease_y_(x), lower.bonnet_crease_rounding_mm) -
         lower.fender_fall * even_ramp(y, crest_y_(x), lower.fender_crest_rounding_mm);
}

double BodyField::lower_body(const Vec3& p) const {
  const LowerBodyShape& lower = shape_.lower;
  const double side = rounded_abs(p.y) - flank_half_width(p.x, p.z);
  const double top = p.z - deck_height(p.x, p.y);
  const double nose = p.x - nose_x_(p.z) + lower.nose_sweep_per_mm * p.y * p.y +
                      lower.nose_corner_sweep * even_ramp(p.y, lower.nose_corner_y_mm, lower.nose_corner_rounding_mm);
  const double tail = -p.x - tail_x_(p.z) + lower.tail_sweep_per_mm * p.y * p.y +
                      lower.tail_corner_sweep * even_ramp(p.y, lower.tail_corner_y_mm, lower.tail_corner_rounding_mm);
  const double floor = floor_z_(p.x) - p.z;
  double f = soft_max(side, nose, lower.nose_flank_mm);
  f = soft_max(f, tail, lower.tail_flank_mm);
  // One edge rounding that is wide along the fenders and tight at nose and tail, where the deck meets the faces.
  const double toward_nose = smooth_step(1950.0, 2230.0, p.x);
  const double toward_tail = smooth_step(-2050.0, -2230.0, p.x);
  double edge = deck_edge_(p.x);
  edge += (lower.nose_edge_mm - edge) * toward_nose;
  edge += (lower.tail_edge_mm - edge) * toward_tail;
  f = soft_max(f, top, edge);
  return soft_max(f, floor, lower.floor_edge_mm);
}

double BodyField::over_roof(const Vec3& p) const {
  // Windscreen and rear window are bowed in plan: the farther out, the farther along the profile.
  const double x = roof_x(p);
  constexpr double step_mm = 1.0;
  const double slope = (roof_z_(x + step_mm) - roof_z_(x - step_mm)) / (2.0 * step_mm);
  return (p.z - roof_z_(x) + shape_.cabin.roof_crown_per_mm * p.y * p.y) / std::sqrt(1.0 + slope * slope);
}

double BodyField::beside_cabin(const Vec3& p) const {
  const CabinShape& cabin = shape_.cabin;
  const double rise = p.z - cabin.belt_z_mm;
  const double above = soft_ramp(rise, 80.0);
  return rounded_abs(p.y) - cabin_plan_(p.x) + cabin.tumblehome * rise + cabin.tumblehome_gain_per_mm * above * above;
}

double BodyField::cabin(const Vec3& p) const {
  const double shell = soft_max(beside_cabin(p), over_roof(p), rail_rounding_(p.x));
  return soft_max(shell, shape_.cabin.bottom_z_mm - p.z, 10.0);
}

double BodyField::cabin_over_body(const Vec3& p) const { return cabin(p) - lower_body(p); }

double BodyField::value(const Vec3& p) const { return soft_min(lower_body(p), cabin(p), waist_rounding_(p.x)); }

}  // namespace lackwerk::packs::car

#include "packs/tools/car/body_graphics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/trigonometric.hpp>
#include <utility>

namespace lackwerk::packs::car {

namespace {

// Mesh edges along borders.
constexpr double panel_mm = 36.0;     // shut lines
constexpr double straight_mm = 30.0;  // gently curved ones
constexpr double round_mm = 15.0;     // with small radii
constexpr double small_mm = 7.0;      // as small as a door handle

using View = std::function<Vec2(const Vec3&)>;

Vec2 side_view(const Vec3& p) { return {p.x, p.z}; }
Vec2 end_view(const Vec3& p) { return {p.y, p.z}; }
Vec2 top_view(const Vec3& p) { return {p.x, p.y}; }

/// Looks at a corner of the car at an angle in plan: u runs from the centre line around the corner. `forward` is +1 at
/// the nose, -1 at the tail.
View corner_view(double origin_x, double angle_deg, double forward) {
  const double c = std::cos(glm::radians(angle_deg));
  const double s = std::sin(glm::radians(angle_deg));
  return [=](const Vec3& p) { return Vec2{c * p.y + s * forward * (origin_x - p.x), p.z}; };
}

}  // namespace

BodyGraphics::BodyGraphics(const BodyField& body, const WheelLayout& wheels, const GraphicsShape& shape)
    : body_(body),
      wheels_(wheels),
      shape_(shape),
      belt_z_(shape.belt_z),
      lower_edge_z_(shape.lower_edge_z),
      diffuser_(shape.diffuser) {
  draw_openings_and_lights();
  draw_shut_lines();
  collect_cuts();
}

void BodyGraphics::draw_openings_and_lights() {
  constexpr double nose_from_x_mm = 1650.0;
  constexpr double tail_from_x_mm = -1650.0;
  const auto at_nose = [](const Vec3& p) { return p.x > nose_from_x_mm; };
  const auto at_tail = [](const Vec3& p) { return p.x < tail_from_x_mm; };
  const auto closed = [](const Corners& corners, const View& view) {
    return [outline = Outline(corners), view](const Vec3& p) { return outline.distance(view(p)); };
  };
  for (const Corners* corners : {&shape_.grille, &shape_.side_intake, &shape_.low_intake}) {
    openings_.push_back({closed(*corners, end_view), at_nose});
  }
  const View nose_view = corner_view(shape_.nose_u_origin_x_mm, shape_.nose_corner_deg, 1.0);
  const View tail_view = corner_view(shape_.tail_u_origin_x_mm, shape_.tail_corner_deg, -1.0);
  light_frames_.push_back({closed(shape_.head_lamp, nose_view), at_nose});
  light_frames_.push_back({closed(shape_.tail_frame, tail_view), at_tail});
  clear_lights_.push_back({closed(shape_.head_light, nose_view), at_nose});
  for (const Corners& module : shape_.lamp_modules) clear_lights_.push_back({closed(module, nose_view), at_nose});
  red_lights_.push_back({closed(shape_.tail_light, tail_view), at_tail});
  red_lights_.push_back({closed(shape_.reflector, tail_view), at_tail});
  badges_.push_back({closed(shape_.nose_badge, end_view), at_nose});
  badges_.push_back({closed(shape_.tail_badge, end_view), at_tail});
  recesses_.push_back({closed(shape_.plate_recess, end_view), at_tail});
}

void BodyGraphics::draw_shut_lines() {
  const auto closed = [this](const Corners& corners, const View& view, const std::function<bool(const Vec3&)>& where,
                             double edge_mm = panel_mm) {
    shut_lines_.push_back({[outline = Outline(corners), view](const Vec3& p) { return outline.distance(view(p)); },
                           [this, where](const Vec3& p) { return where(p) && takes_shut_lines(p); }, edge_mm});
  };
  const auto open = [this](const Corners& corners, const View& view, const std::function<bool(const Vec3&)>& where,
                           double edge_mm = panel_mm) {
    shut_lines_.push_back({[stroke = Stroke(corners), view](const Vec3& p) { return stroke.side(view(p)); },
                           [this, where](const Vec3& p) { return where(p) && takes_shut_lines(p); }, edge_mm});
  };
  const auto flank = [](const Vec3& p) { return p.y > 600.0 && std::abs(p.x) < 1900.0 && p.z < 1060.0; };
  closed(shape_.doors, side_view, flank);
  closed(shape_.front_handle, side_view, flank, small_mm);
  closed(shape_.rear_handle, side_view, flank, small_mm);
  closed(shape_.charge_flap, side_view, flank, round_mm);
  const Outline doors(shape_.doors);
  open(shape_.door_split, side_view,
       [doors, flank](const Vec3& p) { return flank(p) && doors.distance(side_view(p)) < 0.0; });
  const auto bonnet = [sides = Outline(shape_.bonnet), front_z = SoftProfile(shape_.bonnet_front_z)](const Vec3& p) {
    return std::fmax(sides.distance(top_view(p)), front_z(p.y) - p.z);
  };
  shut_lines_.push_back(
      {bonnet, [this](const Vec3& p) { return p.x > 850.0 && p.z > 600.0 && !on_cabin(p) && takes_shut_lines(p); }});
  closed(shape_.boot, end_view,
         [this](const Vec3& p) { return p.x < -1880.0 && p.z > 600.0 && p.z < shape_.tail_frame[1].at.y; });
  open(shape_.boot_side, top_view,
       [this](const Vec3& p) { return p.x < shape_.boot_side.front().at.x && p.z > shape_.tail_frame[1].at.y - 20.0; });
  const double bumper_from_z = shape_.front_bumper.back().at.y - 200.0;
  open(shape_.front_bumper, corner_view(shape_.nose_u_origin_x_mm, shape_.nose_corner_deg, 1.0),
       [bumper_from_z, u = corner_view(shape_.nose_u_origin_x_mm, shape_.nose_corner_deg, 1.0),
        from = shape_.front_bumper.front().at.x](const Vec3& p) {
         return p.x > 1700.0 && p.y > 600.0 && p.z > bumper_from_z && u(p).x > from;
       });
  open(shape_.rear_bumper, side_view,
       [from = shape_.rear_bumper.front().at, to = shape_.rear_bumper.back().at](const Vec3& p) {
         return p.y > 600.0 && p.x < from.x && p.x > to.x;
       });
}

bool BodyGraphics::on_cabin(const Vec3& p) const { return body_.cabin_over_body(p) < 0.0; }

double BodyGraphics::wheel_opening(const Vec3& p) const {
  const double axle_x = p.x > 0.0 ? wheels_.front_axle_x_mm : wheels_.rear_axle_x_mm;
  const double radial = std::hypot(p.x - axle_x, p.z - wheels_.centre_z_mm) - wheels_.arch_radius_mm;
  return std::fmax(radial, wheels_.well_inner_y_mm - p.y);
}

double BodyGraphics::side_window(const Vec3& p) const {
  const double rail = body_.over_roof(p) + shape_.rail_width_mm;
  const double belt = belt_z_(p.x) - p.z;
  const Vec2 from_tip = side_view(p) - shape_.quarter_tip.at;
  const double quarter = glm::dot(from_tip, shape_.quarter_direction);
  const double r = shape_.window_corner_mm;
  return soft_max(soft_max(rail, belt, r), quarter, r);
}

double BodyGraphics::front_window(const Vec3& p, double bottom_mm) const {
  // The lower edge runs parallel to the bonnet, whatever its shape; the upper edge across the bowed roof profile.
  const double top = shape_.screen_top_x_mm - body_.roof_x(p);
  const double upper = soft_max(body_.beside_cabin(p) + shape_.front_pillar_mm, top, shape_.screen_corner_mm);
  return std::fmax(upper, body_.cabin_over_body(p) - bottom_mm);
}

double BodyGraphics::front_glass(const Vec3& p) const {
  return std::fmax(front_black(p) + shape_.frit_mm, front_window(p, shape_.screen_bottom_mm));
}

double BodyGraphics::rear_window(const Vec3& p) const {
  const double x = body_.roof_x(p);
  const double ends = std::fmax(x - shape_.rear_top_x_mm, shape_.rear_bottom_x_mm - x);
  return soft_max(body_.beside_cabin(p) + shape_.rear_pillar_mm, ends, shape_.screen_corner_mm);
}

double BodyGraphics::lower_edge(const Vec3& p) const {
  const double sill = p.z - lower_edge_z_(p.x);
  return p.x < -1900.0 ? std::fmin(sill, diffuser_.distance(end_view(p))) : sill;
}

double BodyGraphics::pillar(const Vec3& p) const {
  const double lean = shape_.centre_pillar_lean * (p.z - belt_z_(p.x));
  const double centre = std::abs(p.x - shape_.centre_pillar_x_mm + lean) - shape_.centre_pillar_half_mm;
  const double rear = std::abs(p.x - shape_.rear_pillar_x_mm + lean) - shape_.rear_pillar_half_mm;
  return std::fmin(centre, rear);
}

bool BodyGraphics::takes_shut_lines(const Vec3& p) const {
  if (side_window(p) < 0.0 && p.y > 300.0 && on_cabin(p)) return false;
  if (lower_edge(p) < 0.0) return false;
  if (p.z > 850.0 && p.x > 0.0 && front_black(p) < 0.0) return false;
  if (p.z > 850.0 && p.x < -500.0 && on_cabin(p) && rear_window(p) < 0.0) return false;
  const auto covers = [&p](const std::vector<Drawn>& group) {
    return std::any_of(group.begin(), group.end(), [&p](const Drawn& d) { return d.contains(p); });
  };
  return !covers(openings_) && !covers(light_frames_) && !covers(badges_);
}

void BodyGraphics::add_cut(std::function<double(const Vec3&)> distance, std::function<bool(const Vec3&)> active,
                           double edge_mm) {
  cuts_.push_back({std::move(distance), std::move(active)});
  cut_edge_mm_.push_back(edge_mm);
}

std::vector<Cut> BodyGraphics::glass_cuts() const {
  const auto side = [](const Vec3& p) { return p.z > 850.0 && p.y > 400.0; };
  const auto front = [](const Vec3& p) { return p.z > 850.0 && p.x > 0.0; };
  const auto rear = [this](const Vec3& p) { return p.x < -500.0 && p.z > 850.0 && on_cabin(p); };
  const auto inside_frame = [this](const Vec3& p) { return p.z > 850.0 && side_window(p) < -shape_.frame_mm; };
  return {{[this](const Vec3& p) { return side_window(p) + shape_.frame_mm; }, side},
          {[this](const Vec3& p) { return pillar(p); }, inside_frame},
          {[this](const Vec3& p) { return front_glass(p); }, front},
          {[this](const Vec3& p) { return rear_window(p) + shape_.frit_mm; }, rear}};
}

void BodyGraphics::collect_cuts() {
  const auto low = [](const Vec3& p) { return p.z < 800.0; };
  add_cut([this](const Vec3& p) { return wheel_opening(p); }, low, 22.0);
  add_cut([this](const Vec3& p) { return lower_edge(p); }, low, straight_mm);
  const std::vector<Cut> glass = glass_cuts();
  for (const double inset : {0.0, shape_.bright_strip_mm}) {
    add_cut([this, inset](const Vec3& p) { return side_window(p) + inset; }, glass[0].active, straight_mm);
  }
  for (const Cut& cut : glass) add_cut(cut.distance, cut.active, straight_mm);
  add_cut([this](const Vec3& p) { return front_black(p); }, glass[2].active, straight_mm);
  add_cut([this](const Vec3& p) { return rear_window(p); }, glass[3].active, straight_mm);
  for (const Drawn& drawn : openings_) add_cut(drawn.distance, drawn.active, 18.0);
  add_cut([this](const Vec3& p) { return openings_.front().distance(p) + shape_.grille_frame_mm; },
          openings_.front().active, straight_mm);
  for (const std::vector<Drawn>* group : {&light_frames_, &red_lights_, &badges_}) {
    for (const Drawn& drawn : *group) add_cut(drawn.distance, drawn.active, round_mm);
  }
  for (const Drawn& drawn : clear_lights_) add_cut(drawn.distance, drawn.active, small_mm);
  for (const Drawn& drawn : recesses_) add_cut(drawn.distance, drawn.active, 18.0);
  for (const Drawn& drawn : shut_lines_) {
    for (const double offset : {-shape_.shut_line_half_mm, shape_.shut_line_half_mm}) {
      add_cut([distance = drawn.distance, offset](const Vec3& p) { return distance(p) + offset; }, drawn.active,
              drawn.edge_mm);
    }
  }
}

bool BodyGraphics::is_dull(const Vec3& p) const {
  constexpr double underside_z_mm = 205.0;
  constexpr double inside_mm = -12.0;
  if (p.z < underside_z_mm || (p.z < 450.0 && lower_edge(p) < inside_mm) ||
      (p.z < 800.0 && wheel_opening(p) < inside_mm))
    return true;
  return std::any_of(openings_.begin(), openings_.end(),
                     [&p](const Drawn& d) { return d.active(p) && d.distance(p) < inside_mm; });
}

bool BodyGraphics::is_window(const Vec3& p) const {
  const Region region = p.z > 850.0 ? window_region(p) : Region::paint;
  return region != Region::paint;
}

double BodyGraphics::edge_limit(const Vec3& p) const {
  constexpr double zone_mm = 14.0;  // on either side of a border
  constexpr double gentle = 0.8;    // of the limit with distance, so that triangle sizes change gently
  constexpr double open_mm = 48.0;
  constexpr double dull_mm = 110.0;
  const bool dull = is_dull(p);
  const double growth = dull ? 2.5 : gentle;
  double limit = dull ? dull_mm : open_mm;
  for (std::size_t i = 0; i < cuts_.size(); ++i) {
    if (cut_edge_mm_[i] >= limit || !cuts_[i].active(p)) continue;
    const double beyond = std::fmax(0.0, std::abs(cuts_[i].distance(p)) - zone_mm);
    limit = std::fmin(limit, cut_edge_mm_[i] + growth * beyond);
  }
  return limit;
}

Region BodyGraphics::window_region(const Vec3& p) const {
  if (const double side = side_window(p); p.y > 400.0 && side < 0.0) {
    if (side > -shape_.bright_strip_mm) return Region::window_bright;
    return side > -shape_.frame_mm || pillar(p) < 0.0 ? Region::window_frame : Region::side_glass;
  }
  if (p.x > 0.0 && front_black(p) < 0.0) {
    return front_glass(p) < 0.0 ? Region::front_glass : Region::cowl;
  }
  if (p.x < -500.0 && on_cabin(p) && rear_window(p) < 0.0) {
    return rear_window(p) < -shape_.frit_mm ? Region::rear_glass : Region::window_frame;
  }
  return Region::paint;
}

Region BodyGraphics::region(const Vec3& p) const {
  if (p.z < 800.0 && wheel_opening(p) < 0.0) return Region::opening;
  if (p.z > 850.0) {
    if (const Region window = window_region(p); window != Region::paint) return window;
  }
  const auto covers = [&p](const std::vector<Drawn>& group) {
    return std::any_of(group.begin(), group.end(), [&p](const Drawn& d) { return d.contains(p); });
  };
  if (openings_.front().contains(p)) {
    return openings_.front().distance(p) > -shape_.grille_frame_mm ? Region::grille_frame : Region::grille;
  }
  if (covers(openings_)) return Region::intake;
  if (covers(clear_lights_)) return Region::head_light;
  if (covers(red_lights_)) return Region::tail_light;
  if (light_frames_.front().contains(p)) return Region::head_lamp;
  if (light_frames_.back().contains(p)) return Region::tail_frame;
  if (covers(badges_)) return Region::badge;
  if (covers(recesses_)) return Region::plate_recess;
  if (p.z < shape_.under_edge_z_mm) return Region::underbody;
  if (p.z < 800.0 && lower_edge(p) < 0.0) return Region::lower_trim;
  for (const Drawn& drawn : shut_lines_) {
    if (std::abs(drawn.distance(p)) < shape_.shut_line_half_mm && drawn.active(p)) return Region::shut_line;
  }
  return Region::paint;
}

}  // namespace lackwerk::packs::car

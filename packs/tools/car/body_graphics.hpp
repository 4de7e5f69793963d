// Where one material ends and the next begins on the body: windows, lamps, intakes, shut lines, wheel openings.
//
// Why it exists: the drawing is kept apart from the surface it is drawn on, so either can change alone. All curves
// belong to the left half; the right half is its mirror picture. Immutable after construction; refers to the body
// field, which must outlive it. Any thread.
#pragma once

#include <functional>
#include <vector>

#include "packs/tools/car/body_field.hpp"
#include "packs/tools/car/graphics_shape.hpp"
#include "packs/tools/car/mesh_cutter.hpp"

namespace lackwerk::packs::car {

enum class Region {
  paint,
  opening,        ///< wheel openings: nothing there
  shut_line,      ///< gaps between panels
  side_glass,     ///< door and quarter windows
  front_glass,    ///< windscreen
  rear_glass,     ///< rear window
  window_frame,   ///< black pillars and borders of the glass
  window_bright,  ///< bright strip around the side windows
  cowl,           ///< black border of the windscreen, widest at the bonnet
  head_lamp,      ///< glass of the head lamp
  head_light,     ///< its light guide and modules
  tail_light,     ///< the light band and the reflectors
  tail_frame,     ///< black around the band
  grille_frame,   ///< bright
  badge,          ///< bright
  plate_recess,   ///< painted hollow for the rear plate
  grille,         ///< the opening between the head lamps
  intake,         ///< lower openings in the bumper
  lower_trim,     ///< black sills and bumper undersides
  underbody,      ///< last: `build_body` counts on it
};

class BodyGraphics {
 public:
  BodyGraphics(const BodyField& body, const WheelLayout& wheels, const GraphicsShape& shape);
  BodyGraphics(const BodyGraphics&) = delete;  // the cuts refer to this object
  BodyGraphics& operator=(const BodyGraphics&) = delete;
  ~BodyGraphics() = default;

  /// In the order in which they must be made: important borders first.
  [[nodiscard]] const std::vector<Cut>& cuts() const { return cuts_; }
  /// The region of a triangle, by its middle.
  [[nodiscard]] Region region(const Vec3& p) const;
  /// How long a mesh edge may be here: short near borders, shortest near the curved outlines of lamps and handles.
  [[nodiscard]] double edge_limit(const Vec3& p) const;
  /// Where nobody will see a reflection: underside, wheel openings, inside of intakes.
  [[nodiscard]] bool is_dull(const Vec3& p) const;
  /// Height over the border of the black lower edge: negative on sills and diffuser.
  [[nodiscard]] double lower_edge(const Vec3& p) const;
  /// On or next to glass.
  [[nodiscard]] bool is_window(const Vec3& p) const;
  /// Just the borders of the glass, for the lining behind it.
  [[nodiscard]] std::vector<Cut> glass_cuts() const;

 private:
  /// A curve drawn in one view, and where on the car it counts.
  struct Drawn {
    std::function<double(const Vec3&)> distance;  ///< negative inside (closed) or on the right (open)
    std::function<bool(const Vec3&)> active;
    double edge_mm = 0.0;  ///< for shut lines: how long mesh edges may be beside it
    [[nodiscard]] bool contains(const Vec3& p) const { return active(p) && distance(p) < 0.0; }
  };

  [[nodiscard]] bool on_cabin(const Vec3& p) const;
  [[nodiscard]] double wheel_opening(const Vec3& p) const;
  [[nodiscard]] double side_window(const Vec3& p) const;
  [[nodiscard]] double front_window(const Vec3& p, double bottom_mm) const;
  [[nodiscard]] double front_glass(const Vec3& p) const;
  [[nodiscard]] double front_black(const Vec3& p) const { return front_window(p, shape_.cowl_end_mm); }
  [[nodiscard]] double rear_window(const Vec3& p) const;

  [[nodiscard]] double pillar(const Vec3& p) const;
  [[nodiscard]] bool takes_shut_lines(const Vec3& p) const;
  [[nodiscard]] Region window_region(const Vec3& p) const;
  void draw_openings_and_lights();
  void draw_shut_lines();
  void collect_cuts();
  /// `edge_mm`: how long mesh edges may be along this border.
  void add_cut(std::function<double(const Vec3&)> distance, std::function<bool(const Vec3&)> active, double edge_mm);

  const BodyField& body_;
  WheelLayout wheels_;
  GraphicsShape shape_;
  SoftProfile belt_z_, lower_edge_z_;
  Outline diffuser_;
  std::vector<Drawn> openings_;  ///< grille first, then intakes
  std::vector<Drawn> clear_lights_;
  std::vector<Drawn> red_lights_;
  std::vector<Drawn> light_frames_;  ///< head lamp glass, then tail frame
  std::vector<Drawn> badges_;
  std::vector<Drawn> recesses_;
  std::vector<Drawn> shut_lines_;
  std::vector<Cut> cuts_;
  std::vector<double> cut_edge_mm_;  ///< as long as cuts_
};

}  // namespace lackwerk::packs::car

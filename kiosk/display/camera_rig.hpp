// Where the eye may go: one pure function from three numbers to a camera, from around the whole car to single flakes.
//
// Why it exists: zooming must be continuous from the room to a macro view, come back exactly, and never pass through
// the body. Angles and closeness are kept, the camera follows from them, so nothing drifts. Values; any thread.
//
// Around the car the eye stands on spheres about the far camera's target. The smallest of them, the shell, holds the
// whole car. Within the shell lies the spot, a place on the surface with the direction it is looked at from; around
// that direction a cone is taken to be free of the body (on the built-in car's bonnet it is; a test walks it). Coming
// nearer, the eye first turns on the shell until it is within the cone and then goes straight down inside it: the path
// is always outside the shell, on it, or inside the cone. The turn is as large as it must be: who stands before the
// bonnet goes straight in.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "packs/scene.hpp"

namespace lackwerk::kiosk {

/// What the eye must keep within, as the scene says. Nothing known: the farthest distance alone keeps it near.
struct Room {
  glm::vec3 centre_mm{0.0f};
  float radius_mm = 0.0f;  ///< of a sphere; 0: unknown or infinitely far (core::Environment::room_radius_mm)
};

/// The three numbers.
struct RigPlace {
  double azimuth_deg = 0.0;    ///< not wrapped: a tour that has gone round twice comes back the way it is told to
  double elevation_deg = 0.0;  ///< [-10, 85]
  double closeness = 0.0;      ///< ln(home distance / distance); 0: the far camera's own distance
  bool operator==(const RigPlace&) const = default;
};

class CameraRig {
 public:
  static constexpr double lowest_elevation_deg = -10.0, highest_elevation_deg = 85.0;
  /// The eye stays this far above the floor, so that the floor never covers the picture.
  static constexpr double lowest_eye_mm = 60.0;
  /// Three times the distance still shows a whole car on a portrait panel.
  static constexpr double farthest_share = 3.0;
  /// The built-in car's corners lie within 0.54 of the hero camera's distance from its target; cars that are framed
  /// like it (packs/tools/import_placement) and a sphere at 4.6 radii too.
  static constexpr double shell_share = 0.56;
  /// Half the macro camera's distance: at its 13 degrees from 75 mm a pixel of 720 rows sees 0.024 mm, so that a flake
  /// texel of 0.05 to 0.1 mm covers two to four pixels, and one at 480 rows still.
  static constexpr double nearest_share = 0.5;

  /// `cameras`: not empty. The first one is home; the spot is the one called "macro", if its eye lies within the shell.
  explicit CameraRig(std::vector<packs::Camera> cameras, Room room = {});

  [[nodiscard]] const RigPlace& place() const { return place_; }
  /// The place of the camera that was chosen last.
  [[nodiscard]] const RigPlace& home_place() const { return home_; }
  /// Largest closeness: the macro view, or the shell where there is no spot.
  [[nodiscard]] double nearest_closeness() const;
  [[nodiscard]] static double farthest_closeness();
  /// The closeness at which the eye reaches the shell.
  [[nodiscard]] double shell_closeness() const;

  /// The camera there. `place` within its limits (clamped).
  [[nodiscard]] packs::Camera camera_at(const RigPlace& place) const;
  /// `place` within elevation and closeness limits; what is not finite is as in `place()`.
  [[nodiscard]] RigPlace within_limits(const RigPlace& place) const;

  void set_place(const RigPlace& place) { place_ = within_limits(place); }
  void orbit(double azimuth_deg, double elevation_deg);
  /// `factor` on the distance, > 0.
  void zoom(double factor);
  /// Takes a camera of the scene as the new home (outside the shell) or spot (inside it) and returns it; null: there is
  /// none. place() is then where that camera is.
  const packs::Camera* choose(const std::string& name);
  [[nodiscard]] const packs::Camera& first() const { return cameras_.front(); }
  /// The home camera is the scene's first, and the spot its macro camera: nothing else was chosen.
  [[nodiscard]] bool is_usual() const;

 private:
  /// A place on the surface and how it is looked at.
  struct Spot {
    glm::dvec3 at{}, towards_eye{};
    double distance_mm = 0.0, vertical_fov_deg = 0.0;
  };
  void take_far(const packs::Camera& camera);
  void take_spot(const packs::Camera& camera);
  void take_macro();
  [[nodiscard]] double lowest_elevation_at(double distance_mm) const;
  [[nodiscard]] double way_to_shell(const glm::dvec3& direction) const;
  [[nodiscard]] glm::dvec3 around(const RigPlace& place, double distance_mm) const;
  [[nodiscard]] double in_room(const glm::dvec3& from, const glm::dvec3& direction, double distance_mm) const;

  std::vector<packs::Camera> cameras_;
  Room room_;
  std::size_t far_ = 0;                 ///< of cameras_: the one whose target is orbited
  std::optional<std::size_t> spotted_;  ///< of cameras_: the one whose spot is approached
  glm::dvec3 target_{};
  double distance_mm_ = 1.0, shell_mm_ = 1.0;
  std::optional<Spot> spot_;
  RigPlace place_, home_;
};

}  // namespace lackwerk::kiosk

#include "packs/tools/import_placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <sstream>

namespace lackwerk::packs {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double shortest_car_mm = 2000.0, longest_car_mm = 8000.0;
constexpr double most_extent_mm = 2e5;  // far inside what a pack takes, cameras included

struct Box {
  glm::dvec3 low{0.0}, high{0.0};
  [[nodiscard]] glm::dvec3 size() const { return high - low; }
};

template <class Points, class Where>
Box box_of(const Points& points, const Where& where) {
  Box box;
  bool any = false;
  for (const auto& point : points) {
    const glm::dvec3 p = where(glm::dvec3(point));
    box.low = any ? glm::min(box.low, p) : p;
    box.high = any ? glm::max(box.high, p) : p;
    any = true;
  }
  return box;
}

/// Rows of the matrix: where our x, y and z come from.
glm::dmat3 from_rows(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z) {
  return glm::transpose(glm::dmat3(x, y, z));
}

glm::dmat3 upright(bool up_is_y, const glm::dvec3& size) {
  if (up_is_y && size.z >= size.x) return from_rows({0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  if (up_is_y) return from_rows({1, 0, 0}, {0, 0, -1}, {0, 1, 0});
  if (size.y > size.x) return from_rows({0, -1, 0}, {1, 0, 0}, {0, 0, 1});
  return glm::dmat3(1.0);
}

glm::dmat3 turned_about_z(double degrees) {
  const double quarter = degrees / 90.0;
  const double c = std::cos(degrees * pi / 180.0), s = std::sin(degrees * pi / 180.0);
  // Quarter turns exactly: nothing moves by a rounding error.
  if (quarter == std::floor(quarter))
    return from_rows({std::round(c), -std::round(s), 0}, {std::round(s), std::round(c), 0}, {0, 0, 1});
  return from_rows({c, -s, 0}, {s, c, 0}, {0, 0, 1});
}

struct Unit {
  const char* name;
  double mm;
};
constexpr std::array<Unit, 4> units = {
    {{"metres", 1000.0}, {"centimetres", 10.0}, {"millimetres", 1.0}, {"inches", 25.4}}};

Result<Unit> unit_for(double length, const PlacementWish& wish, const std::string& file) {
  if (wish.length_mm > 0.0) return Unit{"by the length asked for", wish.length_mm / length};
  if (wish.in_metres) return units[0];
  for (const Unit& unit : units)
    if (length * unit.mm >= shortest_car_mm && length * unit.mm <= longest_car_mm) return unit;
  std::ostringstream text;
  text << "a length of " << length << " is that of no car in metres, centimetres, millimetres or inches";
  return fail(file, "unit", text.str(), "say how long it is with --length-mm");
}

/// A camera of the built-in car, in shares of its box: x and y of half its length, z of its height.
struct Stand {
  const char* name;
  glm::vec3 eye, target;
  float vertical_fov_deg;
};
constexpr float car_half_length_mm = 2320.0f, car_height_mm = 1470.0f;
constexpr std::array<Stand, 6> stands = {{
    {"hero", {4620, 3120, 1020}, {330, -60, 640}, 28.0f},
    {"side", {0, 6900, 950}, {0, 0, 690}, 24.0f},
    {"rear", {-4650, 3150, 1200}, {-380, -60, 640}, 28.0f},
    {"front", {6900, 0, 880}, {1000, 0, 660}, 20.0f},
    {"rim", {2900, 2500, 800}, {1080, 880, 560}, 28.0f},
    {"stripe", {300, 3900, 1150}, {-150, 800, 720}, 30.0f},
}};

/// Highest point of the paint above or below (x, y), and its surface's direction.
struct Spot {
  glm::dvec3 at, normal;
};
std::optional<Spot> paint_above(const std::vector<MeshPart>& parts, double x, double y) {
  std::optional<Spot> best;
  for (const MeshPart& part : parts) {
    if (part.kind != SurfaceKind::paint) continue;
    for (std::size_t k = 0; k + 2 < part.indices.size(); k += 3) {
      const glm::dvec3 a(part.positions_mm[part.indices[k]]), b(part.positions_mm[part.indices[k + 1]]),
          c(part.positions_mm[part.indices[k + 2]]);
      const double whole = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      if (std::abs(whole) < 1e-9) continue;
      const double v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / whole;
      const double w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / whole;
      if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
      const glm::dvec3 p = a + (b - a) * v + (c - a) * w;
      if (best && p.z <= best->at.z) continue;
      const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
      best = Spot{p, n.z < 0.0 ? -n : n};
    }
  }
  return best;
}

/// About 60 mm of the bonnet's paint, along a slanted direction; where there is none, of any paint.
Camera macro_camera(const std::vector<MeshPart>& parts, const Box& box) {
  constexpr double eye_distance_mm = 150.0;
  constexpr float field_of_view_deg = 13.0f;
  const glm::dvec3 half = 0.5 * box.size();
  std::optional<Spot> spot;
  for (const double along : {0.67, 0.55, 0.4, 0.2, 0.0, -0.5})
    if (!spot) spot = paint_above(parts, along * half.x, 0.22 * half.y);
  if (!spot) {
    for (const MeshPart& part : parts)
      if (part.kind == SurfaceKind::paint && !spot)
        spot = Spot{glm::dvec3(part.positions_mm[part.indices[0]]), glm::dvec3(part.normals[part.indices[0]])};
  }
  if (!spot) spot = Spot{{0.0, 0.0, box.high.z}, {0.0, 0.0, 1.0}};
  const glm::dvec3 slanted = glm::normalize(spot->normal + glm::dvec3(0.75, 0.4, 0.0));
  return {"macro", glm::vec3(spot->at + slanted * eye_distance_mm), glm::vec3(spot->at), field_of_view_deg};
}

}  // namespace

Result<Placement> place_model(const std::vector<glm::vec3>& positions, const PlacementWish& wish,
                              const std::string& file) {
  const Box raw = box_of(positions, [](const glm::dvec3& p) { return p; });
  const glm::dvec3 size = raw.size();
  bool up_is_y = wish.up == UpAxis::y || (wish.up == UpAxis::guess && wish.up_is_y);
  // A car is longest along one horizontal axis and flatter than it is wide.
  if (wish.up == UpAxis::guess && !wish.up_is_y)
    up_is_y = size.z >= size.x && size.z >= size.y ? true : size.y < size.z && size.y < size.x;
  Placement out;
  out.turn = turned_about_z(wish.rotate_deg) * upright(up_is_y, size);
  const auto turned = [&out](const glm::dvec3& p) { return out.turn * p; };
  Box box = box_of(positions, turned);
  const double length = std::max(box.size().x, box.size().y);
  if (!(length > 0.0)) return fail(file, "positions", "the model has no extent", "export it again");
  const auto unit = unit_for(length, wish, file);
  if (!unit) return tl::unexpected(unit.error());
  if (!(length * unit->mm <= most_extent_mm && box.size().z * unit->mm <= most_extent_mm && length * unit->mm >= 1.0))
    return fail(file, "unit", "the model would be " + std::to_string(length * unit->mm) + " mm long",
                "say how long it is with --length-mm");
  out.turn *= unit->mm;
  box = box_of(positions, turned);
  out.shift_mm = {-0.5 * (box.low.x + box.high.x), -0.5 * (box.low.y + box.high.y), -box.low.z};
  std::ostringstream note;
  note << "up is " << (up_is_y ? "y" : "z") << (wish.up == UpAxis::guess && !wish.up_is_y ? " (guessed)" : "")
       << ", unit " << unit->name << (wish.length_mm > 0.0 || wish.in_metres ? "" : " (guessed)") << ", "
       << std::lround(box.size().x) << " x " << std::lround(box.size().y) << " x " << std::lround(box.size().z)
       << " mm";
  out.note = note.str();
  return out;
}

std::vector<Camera> framed_cameras(const std::vector<MeshPart>& parts) {
  Box box;
  bool any = false;
  for (const MeshPart& part : parts) {
    const Box own = box_of(part.positions_mm, [](const glm::dvec3& p) { return p; });
    box.low = any ? glm::min(box.low, own.low) : own.low;
    box.high = any ? glm::max(box.high, own.high) : own.high;
    any = true;
  }
  const glm::dvec3 size = box.size();
  // Tall things need distance as much as long ones; the sides keep the car's proportions.
  const auto height = static_cast<float>(size.z) / car_height_mm;
  const float distance = std::max(static_cast<float>(0.5 * std::max(size.x, size.y)) / car_half_length_mm, height);
  const glm::vec3 scale{distance, distance, height};
  std::vector<Camera> cameras;
  cameras.reserve(stands.size() + 1);
  for (const Stand& stand : stands)
    cameras.push_back({stand.name, stand.eye * scale, stand.target * scale, stand.vertical_fov_deg});
  cameras.insert(cameras.begin() + 5, macro_camera(parts, box));
  return cameras;
}

}  // namespace lackwerk::packs

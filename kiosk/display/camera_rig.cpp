#include "kiosk/display/camera_rig.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "core/check.hpp"

namespace lackwerk::kiosk {
namespace {

/// Half the angle of the cone that is free of the body. Built-in car: the roof's edge stands 100 degrees from the macro
/// camera's direction, the bonnet's tangent plane 58 to 120.
constexpr double free_cone_deg = 40.0;
/// Whoever comes from afar off the direction ends up within this of it: some way from the cone's rim.
constexpr double kept_cone_deg = 28.0;
/// Part of the way in within which the eye turns.
constexpr double turning_part = 0.4;
/// A spot that is looked at from outside the shell: the shell is as far from it as this many of its own distances.
constexpr double beyond_spot = 1.25;
/// Of the room's radius: the wall itself would fill the picture with what lies behind it.
constexpr double room_share = 0.95;

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }
/// The turn on the shell comes to rest at its end; it begins at once, so that its inverse has no steep place where
/// turning first becomes necessary.
double turned_after(double t) { return t * (2.0 - t); }
double time_of_turn(double turned) { return 1.0 - std::sqrt(1.0 - turned); }

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  // Better than the arc cosine near 0.
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

CameraRig::CameraRig(std::vector<packs::Camera> cameras, Room room) : cameras_(std::move(cameras)), room_(room) {
  check_at_most(std::size_t{1}, cameras_.size(), "a scene has a camera");
  take_far(cameras_.front());
  take_macro();
}

void CameraRig::take_macro() {
  spot_.reset();
  spotted_.reset();
  for (std::size_t k = 0; k < cameras_.size() && !spotted_; ++k) {
    if (cameras_[k].name != "macro" || k == far_) continue;
    spotted_ = k;
    take_spot(cameras_[k]);
  }
}

void CameraRig::take_far(const packs::Camera& camera) {
  target_ = glm::dvec3(camera.target_mm);
  const glm::dvec3 from_target = glm::dvec3(camera.eye_mm) - target_;
  distance_mm_ = std::max(glm::length(from_target), 1.0);
  // The first camera says where the car is; another target needs a shell as much larger as it lies off.
  const glm::dvec3 first_target(cameras_.front().target_mm);
  const double first_shell = shell_share * glm::length(glm::dvec3(cameras_.front().eye_mm) - first_target);
  shell_mm_ = std::max(first_shell + glm::length(target_ - first_target), 1.0);
  home_ = {glm::degrees(std::atan2(from_target.y, from_target.x)),
           glm::degrees(std::asin(std::clamp(from_target.z / distance_mm_, -1.0, 1.0))), 0.0};
  place_ = home_;
}

void CameraRig::take_spot(const packs::Camera& camera) {
  const glm::dvec3 at(camera.target_mm), from_spot = glm::dvec3(camera.eye_mm) - at;
  const double distance = glm::length(from_spot);
  if (!(distance > 0.0) || glm::length(at - target_) >= shell_mm_) {
    spot_.reset();
    return;
  }
  spot_ = Spot{at, from_spot / distance, distance, static_cast<double>(camera.vertical_fov_deg)};
}

double CameraRig::farthest_closeness() { return -std::log(farthest_share); }
double CameraRig::shell_closeness() const { return std::max(std::log(distance_mm_ / shell_mm_), 0.0); }

double CameraRig::nearest_closeness() const {
  return spot_ ? std::log(distance_mm_ / (nearest_share * spot_->distance_mm)) : shell_closeness();
}

bool CameraRig::is_usual() const {
  if (far_ != 0) return false;
  return !spotted_ || cameras_[*spotted_].name == "macro";
}

double CameraRig::lowest_elevation_at(double distance_mm) const {
  const double sine = std::clamp((lowest_eye_mm - target_.z) / distance_mm, -1.0, 1.0);
  return std::clamp(glm::degrees(std::asin(sine)), lowest_elevation_deg, highest_elevation_deg);
}

RigPlace CameraRig::within_limits(const RigPlace& place) const {
  const auto finite = [](double value, double otherwise) { return std::isfinite(value) ? value : otherwise; };
  return {finite(place.azimuth_deg, place_.azimuth_deg),
          std::clamp(finite(place.elevation_deg, place_.elevation_deg), lowest_elevation_deg, highest_elevation_deg),
          std::clamp(finite(place.closeness, place_.closeness), farthest_closeness(), nearest_closeness())};
}

glm::dvec3 CameraRig::around(const RigPlace& place, double distance_mm) const {
  const double a = glm::radians(place.azimuth_deg);
  const double e = glm::radians(std::max(place.elevation_deg, lowest_elevation_at(distance_mm)));
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

double CameraRig::in_room(const glm::dvec3& from, const glm::dvec3& direction, double distance_mm) const {
  if (room_.radius_mm <= 0.0f) return distance_mm;
  // Where the ray meets the sphere; from outside of it the room says nothing.
  const glm::dvec3 offset = from - glm::dvec3(room_.centre_mm);
  const double radius = room_share * static_cast<double>(room_.radius_mm);
  const double along = glm::dot(offset, direction);
  const double rest = glm::dot(offset, offset) - radius * radius;
  if (rest >= 0.0) return distance_mm;
  return std::min(distance_mm, -along + std::sqrt(along * along - rest));
}

double CameraRig::way_to_shell(const glm::dvec3& direction) const {
  const glm::dvec3 offset = spot_->at - target_;
  const double along = glm::dot(offset, direction);
  return -along + std::sqrt(std::max(along * along - glm::dot(offset, offset) + shell_mm_ * shell_mm_, 0.0));
}

packs::Camera CameraRig::camera_at(const RigPlace& wanted) const {
  const RigPlace place = within_limits(wanted);
  packs::Camera camera = cameras_[far_];
  const double distance = distance_mm_ * std::exp(-place.closeness);
  if (!spot_ || distance >= shell_mm_) {
    const glm::dvec3 direction = around(place, distance);
    camera.eye_mm = glm::vec3(target_ + in_room(target_, direction, distance) * direction);
    camera.eye_mm.z = std::max(camera.eye_mm.z, static_cast<float>(lowest_eye_mm));
    return camera;
  }
  const Spot& spot = *spot_;
  const double nearest = nearest_share * spot.distance_mm;
  const double t = std::clamp(std::log(shell_mm_ / distance) / std::log(shell_mm_ / nearest), 0.0, 1.0);

  // The direction from the spot: where the visitor stands on the shell, turned into the cone.
  const glm::dvec3 start = glm::normalize(target_ + shell_mm_ * around(place, shell_mm_) - spot.at);
  const double free_cone = glm::radians(free_cone_deg), kept_cone = glm::radians(kept_cone_deg);
  const double off = angle_between(start, spot.towards_eye);
  const double end = kept_cone * std::tanh(off / kept_cone);
  const double angle = end + (off - end) * (1.0 - turned_after(std::min(t / turning_part, 1.0)));
  const glm::dvec3 aside = start - glm::dot(start, spot.towards_eye) * spot.towards_eye;
  const double aside_length = glm::length(aside);
  const glm::dvec3 direction = aside_length > 1e-12
                                   ? std::cos(angle) * spot.towards_eye + std::sin(angle) * aside / aside_length
                                   : spot.towards_eye;

  // Down from the shell as soon as the direction is within the free cone.
  const double turned = off > free_cone ? turning_part * time_of_turn((off - free_cone) / (off - end)) : 0.0;
  const double way = way_to_shell(direction);
  const double down = std::clamp((t - turned) / (1.0 - turned), 0.0, 1.0);
  const double height = way * std::pow(nearest / way, down);
  camera.eye_mm = glm::vec3(spot.at + in_room(spot.at, direction, height) * direction);
  camera.eye_mm.z = std::max(camera.eye_mm.z, static_cast<float>(lowest_eye_mm));

  // Target and field of view are the spot's own from its camera's distance on.
  const double own = std::log(way / spot.distance_mm) / std::log(way / nearest);
  const double in = smooth(std::clamp(down / std::max(own, 0.1), 0.0, 1.0));
  camera.target_mm = glm::vec3(target_ + in * (spot.at - target_));
  camera.vertical_fov_deg =
      static_cast<float>(std::exp(std::log(static_cast<double>(cameras_[far_].vertical_fov_deg)) * (1.0 - in) +
                                  std::log(spot.vertical_fov_deg) * in));
  return camera;
}

void CameraRig::orbit(double azimuth_deg, double elevation_deg) {
  RigPlace next = place_;
  next.azimuth_deg = std::remainder(next.azimuth_deg + azimuth_deg, 360.0);
  // What the floor holds up is not to be turned back first.
  const double distance = std::max(distance_mm_ * std::exp(-place_.closeness), shell_mm_);
  const double held = std::max(next.elevation_deg, lowest_elevation_at(distance));
  next.elevation_deg = (elevation_deg == 0.0 ? next.elevation_deg : held) + elevation_deg;
  set_place(next);
}

void CameraRig::zoom(double factor) {
  RigPlace next = place_;
  next.closeness -= std::log(factor);
  set_place(next);
}

const packs::Camera* CameraRig::choose(const std::string& name) {
  const auto found =
      std::find_if(cameras_.begin(), cameras_.end(), [&](const packs::Camera& camera) { return camera.name == name; });
  if (found == cameras_.end()) return nullptr;
  const auto index = static_cast<std::size_t>(found - cameras_.begin());
  const auto own_shell = [&] {
    const glm::dvec3 first_target(cameras_.front().target_mm), target(found->target_mm);
    return shell_share * glm::length(glm::dvec3(cameras_.front().eye_mm) - first_target) +
           glm::length(target - first_target);
  };
  const double distance = glm::length(glm::dvec3(found->eye_mm) - glm::dvec3(found->target_mm));
  // Outside its shell, another far camera; inside, another spot.
  if (index == 0 || distance >= own_shell()) {
    far_ = index;
    take_far(*found);
    take_macro();
    return &*found;
  }
  far_ = 0;
  take_far(cameras_.front());
  spotted_ = index;
  // The shell lies beyond the camera itself, so that the spot's own view is reached on the way in.
  const glm::dvec3 spot(found->target_mm), beyond = beyond_spot * (glm::dvec3(found->eye_mm) - spot);
  shell_mm_ = std::max(shell_mm_, glm::length(spot + beyond - target_));
  take_spot(*found);
  if (!spot_) return &*found;
  // The place whose camera this is: on the shell in its own direction, as far down as it stands.
  const glm::dvec3 on_shell = spot_->at + way_to_shell(spot_->towards_eye) * spot_->towards_eye - target_;
  const double way = way_to_shell(spot_->towards_eye), nearest = nearest_share * spot_->distance_mm;
  const double down = std::log(way / spot_->distance_mm) / std::log(way / nearest);
  place_ = within_limits({glm::degrees(std::atan2(on_shell.y, on_shell.x)),
                          glm::degrees(std::asin(std::clamp(on_shell.z / shell_mm_, -1.0, 1.0))),
                          std::log(distance_mm_ / shell_mm_) + down * std::log(shell_mm_ / nearest)});
  return &*found;
}

}  // namespace lackwerk::kiosk

#include "kiosk/display/mix_desk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/check.hpp"
#include "kiosk/display/morph_path.hpp"
#include "kiosk/display/ui/layout.hpp"
#include "kiosk/display/ui/paint_pad.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr double never_began = -std::numeric_limits<double>::infinity();

std::vector<double> mixed(const std::vector<double>& a, const std::vector<double>& b, double part) {
  std::vector<double> out = a;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += (b[k] - a[k]) * part;
  return out;
}

std::vector<double> in_order(const std::vector<double>& weights, const std::vector<std::size_t>& order) {
  std::vector<double> out;
  out.reserve(order.size());
  for (const std::size_t paint : order) out.push_back(weights[paint]);
  return out;
}

double squared(ui::Place a, ui::Place b) { return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]); }

}  // namespace

double eased(double part) {
  const double t = std::clamp(part, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

std::vector<std::size_t> by_liveliness(const ui::Content& content) {
  std::vector<std::size_t> order(content.paints.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return content.paints[a].lively < content.paints[b].lively; });
  return order;
}

Hue hue_at(double position, std::size_t paints) {
  // Paint k stands at (k + 1) / n: the white end has a way of its own.
  const double along = std::clamp(position, 0.0, 1.0) * static_cast<double>(paints) - 1.0;
  return {weights_at(along, static_cast<int>(paints), PathEnds::open), std::clamp(-along, 0.0, 1.0)};
}

std::vector<double> sparkle_at(double position, const std::vector<std::size_t>& order) {
  const auto n = static_cast<double>(order.size());
  const std::vector<double> along =
      weights_at(std::clamp(position, 0.0, 1.0) * (n - 1.0), static_cast<int>(order.size()), PathEnds::open);
  std::vector<double> weights(order.size(), 0.0);
  for (std::size_t k = 0; k < order.size(); ++k) weights[order[k]] = along[k];
  return weights;
}

MixDesk::MixDesk(const ui::Content& content)
    : paints_(content.paints.size()),
      order_(by_liveliness(content)),
      limit_(std::max(content.beyond_limit, 0.0)),
      glide_since_ms_(never_began) {
  check_at_most(std::size_t{1}, paints_, "paints on the desk");
  reset();
}

void MixDesk::reset(std::optional<double> now_ms) {
  if (now_ms)
    blend(*now_ms);
  else
    blend_from_.reset();
  scripted_.reset();
  swatches_ = ui::first_places(paints_);
  puck_ = swatches_.front();
  path_.reset();
  glide_since_ms_ = never_began;
  sparkle_free_ = hue_free_ = false;
  sparkle_ = hue_ = beyond_ = 0.0;
}

double MixDesk::progress(double since_ms, double over_ms, double now_ms) const {
  if (reduced_ || !(now_ms < since_ms + over_ms)) return 1.0;
  return std::max((now_ms - since_ms) / over_ms, 0.0);
}

void MixDesk::blend(double now_ms) {
  blend_from_ = weights(now_ms);
  blend_since_ms_ = now_ms;
}

void MixDesk::by_hand(double now_ms) {
  if (!scripted_) return;
  blend(now_ms);
  scripted_.reset();
}

ui::Place MixDesk::puck(double now_ms) const {
  ui::Place at = puck_;
  const double left = 1.0 - eased(progress(glide_since_ms_, glide_ms, now_ms));
  for (std::size_t axis = 0; axis < 2 && left > 0.0; ++axis)
    at[axis] = std::clamp(at[axis] + left * glide_off_[axis], 0.0, 1.0);
  return at;
}

void MixDesk::put_puck(ui::Place place, double now_ms) {
  by_hand(now_ms);
  put_down(place);
}

void MixDesk::put_down(ui::Place place) {
  puck_ = {std::clamp(place[0], 0.0, 1.0), std::clamp(place[1], 0.0, 1.0)};
  path_.reset();
  glide_since_ms_ = never_began;
}

void MixDesk::send_puck(std::size_t swatch, double now_ms) {
  if (swatch >= paints_) return;
  by_hand(now_ms);
  const ui::Place from = puck(now_ms);
  put_down(swatches_[swatch]);
  glide_off_ = {from[0] - puck_[0], from[1] - puck_[1]};
  glide_since_ms_ = now_ms;
}

ui::Place MixDesk::on_path(double position) const {
  const double place = kiosk::on_path(position, static_cast<int>(paints_), PathEnds::closed);
  const auto k = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(k);
  const ui::Place &a = swatches_[k], &b = swatches_[(k + 1) % paints_];
  return {a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part};
}

double MixDesk::nearest_on_path(ui::Place place) const {
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < paints_; ++k) {
    const ui::Place &a = swatches_[k], &b = swatches_[(k + 1) % paints_];
    const double length = squared(a, b);
    const double along = (place[0] - a[0]) * (b[0] - a[0]) + (place[1] - a[1]) * (b[1] - a[1]);
    const double part = length > 0.0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    const double off = squared(place, on_path(static_cast<double>(k) + part));
    if (off >= least) continue;
    least = off;
    best = static_cast<double>(k) + part;
  }
  return best;
}

void MixDesk::turn_puck(double detents, double now_ms) {
  by_hand(now_ms);
  const ui::Place from = puck(now_ms);
  const bool begins = !path_;
  const double position = begins ? nearest_on_path(from) : *path_;
  const ui::Place entry = on_path(position);
  path_ = kiosk::on_path(position + detents / detents_a_paint, static_cast<int>(paints_), PathEnds::closed);
  puck_ = on_path(*path_);
  if (!begins) return;
  // From a place off the path it glides there, while the turn is already seen.
  glide_off_ = {from[0] - entry[0], from[1] - entry[1]};
  glide_since_ms_ = now_ms;
}

bool MixDesk::drag_swatch(std::size_t swatch, ui::Place to, double reach, double now_ms) {
  if (swatch >= paints_) return false;
  by_hand(now_ms);
  path_.reset();
  const ui::Place from = swatches_[swatch];
  const double way = std::sqrt(squared(from, to));
  const bool whole = reduced_ || way <= reach;
  const double part = whole ? 1.0 : reach / way;
  swatches_ = ui::move_swatch(std::move(swatches_), swatch,
                              {from[0] + (to[0] - from[0]) * part, from[1] + (to[1] - from[1]) * part});
  return !whole && squared(swatches_[swatch], from) > 0.0;
}

void MixDesk::set_sparkle(double position, double now_ms) {
  if (!sparkle_free_) toggle_sparkle_lock(now_ms);
  by_hand(now_ms);
  sparkle_ = std::clamp(position, 0.0, 1.0);
}

void MixDesk::set_hue(double position, double now_ms) {
  if (!hue_free_) toggle_hue_lock(now_ms);
  by_hand(now_ms);
  hue_ = std::clamp(position, 0.0, 1.0);
}

void MixDesk::toggle_sparkle_lock(double now_ms) {
  blend(now_ms);
  scripted_.reset();
  sparkle_ = sparkle(now_ms);
  sparkle_free_ = !sparkle_free_;
}

void MixDesk::toggle_hue_lock(double now_ms) {
  blend(now_ms);
  scripted_.reset();
  hue_ = hue(now_ms);
  hue_free_ = !hue_free_;
}

void MixDesk::set_beyond(double part, double now_ms) {
  by_hand(now_ms);
  beyond_ = std::clamp(part, 0.0, 1.0);
}

double MixDesk::sparkle(double now_ms) const {
  if (sparkle_free_) return sparkle_;
  if (paints_ < 2) return 0.0;
  const std::vector<double> base = scripted_ ? scripted_->base : ui::pad_weights(swatches_, puck(now_ms));
  return nearest_position(in_order(base, order_), static_cast<int>(paints_), PathEnds::open) /
         static_cast<double>(paints_ - 1);
}

double MixDesk::hue(double now_ms) const {
  if (hue_free_) return hue_;
  const std::vector<double> base = scripted_ ? scripted_->base : ui::pad_weights(swatches_, puck(now_ms));
  return (nearest_position(base, static_cast<int>(paints_), PathEnds::open) + 1.0) / static_cast<double>(paints_);
}

void MixDesk::script(input::ControlKind kind, const core::Weights& weights, double now_ms) {
  const ui::Place here = puck(now_ms);
  scripted_ = weights;
  blend_from_.reset();
  const bool moves_puck = kind == input::ControlKind::weights || kind == input::ControlKind::base;
  put_down(moves_puck ? ui::puck_for(swatches_, weights.base) : here);
  beyond_ = 0.0;
  sparkle_free_ = weights.flake_lightness != weights.base;
  const int n = static_cast<int>(paints_);
  if (sparkle_free_ && n > 1)
    sparkle_ = nearest_position(in_order(weights.flake_lightness, order_), n, PathEnds::open) / (n - 1.0);
  hue_free_ = weights.flake_colour != weights.base || weights.flake_white > 0.0;
  hue_ = (weights.flake_white > 0.0 ? 1.0 - weights.flake_white
                                    : nearest_position(weights.flake_colour, n, PathEnds::open) + 1.0) /
         n;
}

core::Weights MixDesk::wanted(double now_ms) const {
  const std::vector<double> base = ui::go_beyond(ui::pad_weights(swatches_, puck(now_ms)), beyond_ * limit_);
  core::Weights out = core::Weights::uniform(base);
  if (sparkle_free_) out.flake_lightness = sparkle_at(sparkle_, order_);
  if (hue_free_) {
    Hue hue = hue_at(hue_, paints_);
    out.flake_colour = std::move(hue.weights);
    out.flake_white = hue.white;
  }
  return out;
}

core::Weights MixDesk::weights(double now_ms) const {
  if (scripted_) return *scripted_;
  core::Weights out = wanted(now_ms);
  if (!blend_from_) return out;
  const double part = eased(progress(blend_since_ms_, blend_ms, now_ms));
  if (part >= 1.0) return out;
  out.base = mixed(blend_from_->base, out.base, part);
  out.flake_lightness = mixed(blend_from_->flake_lightness, out.flake_lightness, part);
  out.flake_colour = mixed(blend_from_->flake_colour, out.flake_colour, part);
  out.flake_white =
      std::clamp(blend_from_->flake_white + (out.flake_white - blend_from_->flake_white) * part, 0.0, 1.0);
  return out;
}

bool MixDesk::moves(double now_ms) const {
  if (scripted_) return false;
  return progress(glide_since_ms_, glide_ms, now_ms) < 1.0 ||
         (blend_from_ && progress(blend_since_ms_, blend_ms, now_ms) < 1.0);
}

void MixDesk::show(ui::Model& model, double now_ms) const {
  model.swatches = swatches_;
  model.puck = puck(now_ms);
  model.sparkle_free = sparkle_free_;
  model.hue_free = hue_free_;
  model.sparkle = sparkle(now_ms);
  model.hue = hue(now_ms);
  model.beyond = beyond_;
}

}  // namespace lackwerk::kiosk

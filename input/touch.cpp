#include "input/touch.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "input/knob_settings.hpp"

namespace lackwerk::input {
namespace {

/// Controls that wait to be handed out. A device that fills this has sent over a thousand separate touches while the
/// kiosk drew a few frames.
constexpr std::size_t max_waiting = 4 * max_controls_a_read;
constexpr std::size_t max_name = 80;
constexpr std::size_t max_notices = 32;

bool is_range(const AxisRange& range) {
  return std::isfinite(range.least) && std::isfinite(range.most) && range.least < range.most;
}

std::string title(const TouchDevice& device) {
  const char* kind = device.kind == TouchKind::screen    ? "touch screen"
                     : device.kind == TouchKind::pointer ? "pointer"
                                                         : "mouse";
  return std::string(kind) + " '" + clean_name(device.name) + "' (" + clean_name(device.node) + ")";
}

}  // namespace

bool is_usable(const CalibrationMatrix& matrix) {
  // The smallest share of its area a panel may be mapped to: a hundredth each way.
  constexpr double least_area = 1e-4;
  const double area = matrix[0] * matrix[4] - matrix[1] * matrix[3];
  return std::all_of(matrix.begin(), matrix.end(), [](double m) { return std::isfinite(m); }) &&
         std::abs(area) >= least_area;
}

std::string clean_name(const std::string& name) {
  std::string out = name.substr(0, max_name);
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out;
}

std::optional<std::string> refusal_of(const TouchDevice& device) {
  if (device.kind != TouchKind::mouse && !(is_range(device.x) && is_range(device.y)))
    return "announces axes without a range";
  if (device.slots < 1 || device.slots > max_slots) return "announces " + std::to_string(device.slots) + " fingers";
  return std::nullopt;
}

const TouchSettings* find_settings(const std::vector<TouchSettings>& settings, const TouchDevice& device) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  const auto has = [&](const std::string& text, const std::string& part) {
    return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
  };
  const std::string id =
      device_id(static_cast<std::uint16_t>(device.vendor), static_cast<std::uint16_t>(device.product));
  const auto found = std::find_if(settings.begin(), settings.end(), [&](const TouchSettings& entry) {
    return has(device.name, entry.match) || (entry.match.size() == id.size() && has(id, entry.match));
  });
  return found == settings.end() ? nullptr : &*found;
}

TouchScreens::TouchScreens(std::unique_ptr<TouchFeed> feed, std::vector<TouchSettings> settings, std::string output)
    : feed_(std::move(feed)), settings_(std::move(settings)), output_(std::move(output)) {}

void TouchScreens::set_output(const std::string& output) {
  if (output == output_) return;
  output_ = output;
  for (auto& [id, device] : devices_) {
    if (!is_elsewhere(device)) continue;
    cancel_all_of(id);
    say(false, title(device.info) + " is ignored: bound to " + device.bound + ", the kiosk shows on " + output_);
  }
}

void TouchScreens::suspend() {
  for (const auto& [id, device] : devices_) cancel_all_of(id);
  feed_->suspend();
}

void TouchScreens::resume() {
  if (!feed_->resume()) say(true, "touch screens cannot be opened again: the next change of seat tries again");
}

void TouchScreens::add_descriptors(std::vector<int>& out) const { feed_->add_descriptors(out); }

void TouchScreens::read(double /*now_ms*/, std::vector<Control>& out) {
  raw_.clear();
  // What a full queue could not hand out comes first; the feed's events wait where they are.
  if (queue_.size() < max_controls_a_read) feed_->read(raw_);
  // A feed may end what is held with an ordinary release just before it says that the device is gone. Nobody let go.
  std::map<int, std::size_t> gone_at;
  for (std::size_t k = 0; k < raw_.size(); ++k)
    if (raw_[k].kind == RawTouch::Kind::removed) gone_at[raw_[k].device] = k;
  for (std::size_t k = 0; k < raw_.size(); ++k) {
    const auto gone = gone_at.find(raw_[k].device);
    take(raw_[k], gone != gone_at.end() && k < gone->second);
  }
  const std::size_t count = std::min(queue_.size(), max_controls_a_read);
  out.insert(out.end(), std::make_move_iterator(queue_.begin()),
             std::make_move_iterator(queue_.begin() + static_cast<std::ptrdiff_t>(count)));
  queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(count));
  since_order_ = since_order_ > count ? since_order_ - count : 0;
}

double TouchScreens::wake_at_ms() const { return queue_.empty() && !feed_->has_more() ? never_ms : 0.0; }

void TouchScreens::add_devices(std::vector<DeviceStatus>& out) const {
  for (const auto& [id, device] : devices_) {
    std::string detail = clean_name(device.info.node);
    if (!device.refused.empty())
      detail += ": " + device.refused;
    else if (is_elsewhere(device))
      detail += ": bound to " + device.bound;
    const bool used = device.refused.empty() && !is_elsewhere(device);
    out.push_back({clean_name(device.info.name), "touch", used ? "ready" : "refused", std::move(detail), device.heard});
  }
}

void TouchScreens::take_notices(std::vector<Notice>& out) {
  feed_->take_notices(out);
  out.insert(out.end(), std::make_move_iterator(notices_.begin()), std::make_move_iterator(notices_.end()));
  notices_.clear();
}

void TouchScreens::take(const RawTouch& event, bool dying) {
  using Kind = RawTouch::Kind;
  if (event.kind == Kind::added) {
    if (event.added) add(*event.added);
    return;
  }
  if (event.kind == Kind::removed) return remove(event.device);
  const auto found = devices_.find(event.device);
  if (found == devices_.end()) return;
  Device& device = found->second;
  if (!device.refused.empty() || is_elsewhere(device)) return;
  ++device.heard;
  const ControlKind end_kind = dying ? ControlKind::touch_cancel : ControlKind::touch_up;
  switch (event.kind) {
    case Kind::down:
      return down(device, event);
    case Kind::move:
      return move(device, event.slot, event.x, event.y, event.time_us);
    case Kind::up:
    case Kind::release:
      return end(event.device, event.slot, end_kind, event.time_us);
    case Kind::cancel:
      return end(event.device, event.slot, ControlKind::touch_cancel, event.time_us);
    case Kind::point:
      if (!std::isfinite(event.x) || !std::isfinite(event.y)) return;
      device.x = event.x;
      device.y = event.y;
      return move(device, 0, device.x, device.y, event.time_us);
    case Kind::nudge:
      if (!std::isfinite(event.x) || !std::isfinite(event.y)) return;
      device.x = std::clamp(device.x + event.x / mouse_counts_a_panel, 0.0, 1.0);
      device.y = std::clamp(device.y + event.y / mouse_counts_a_panel, 0.0, 1.0);
      return move(device, 0, device.x, device.y, event.time_us);
    case Kind::press: {
      // No pointer is drawn, so a mouse has no place that anybody could know: every press begins in the middle.
      if (device.info.kind == TouchKind::mouse) device.x = device.y = 0.5;
      RawTouch at = event;
      at.x = device.x;
      at.y = device.y;
      return down(device, at);
    }
    case Kind::added:
    case Kind::removed:
      break;
  }
}

void TouchScreens::add(const TouchDevice& device) {
  // A refused device is not followed by its feed: the next one on its node takes its place in the list.
  std::erase_if(devices_, [&](const auto& entry) {
    return !entry.second.refused.empty() && entry.second.info.node == device.node;
  });
  if (devices_.size() >= max_touch_devices) {
    say(true, title(device) + " is ignored: more than " + std::to_string(max_touch_devices) + " devices");
    return;
  }
  Device& added = devices_[device.id];
  added.info = device;
  added.bound = device.output;
  if (const auto why = refusal_of(device)) return refuse(added, *why + "; replace it or its driver", true);
  if (const TouchSettings* entry = find_settings(settings_, device)) {
    if (!entry->output.empty()) added.bound = entry->output;
    if (entry->calibration && !(is_usable(*entry->calibration) && feed_->calibrate(device.id, *entry->calibration)))
      say(true, title(device) + " takes no calibration: its positions stay as they are");
  }
  if (is_elsewhere(added))
    say(false, title(device) + " is ignored: bound to " + added.bound + ", the kiosk shows on " + output_);
  else
    say(false, title(device) + " is ready" + (added.bound.empty() ? "" : ", bound to " + added.bound));
}

void TouchScreens::remove(int id) {
  const auto found = devices_.find(id);
  if (found == devices_.end()) return;
  cancel_all_of(id);
  say(false, title(found->second.info) + " is gone");
  devices_.erase(found);
}

void TouchScreens::down(Device& device, const RawTouch& event) {
  if (!std::isfinite(event.x) || !std::isfinite(event.y)) return;
  const int id = device.info.id;
  // A finger that goes down twice was lifted in between without a word: nothing was meant by the first one.
  end(id, event.slot, ControlKind::touch_cancel, event.time_us);
  if (!device.refused.empty()) return;
  const auto held =
      std::count_if(contacts_.begin(), contacts_.end(), [id](const Contact& c) { return c.device == id; });
  if (held >= max_fingers) {
    if (!device.too_many)
      say(false, title(device.info) + " has more than " + std::to_string(max_fingers) + " fingers: others are ignored");
    device.too_many = true;
    return;
  }
  int number = 0;
  while (std::any_of(contacts_.begin(), contacts_.end(), [number](const Contact& c) { return c.number == number; }))
    ++number;
  contacts_.push_back({id, event.slot, number});
  put({ControlKind::touch_down,
       {std::clamp(event.x, 0.0, 1.0), std::clamp(event.y, 0.0, 1.0)},
       {},
       number,
       event.time_us},
      id);
}

void TouchScreens::move(const Device& device, int slot, double x, double y, std::uint64_t time_us) {
  const auto contact = find(device.info.id, slot);
  if (contact == contacts_.end() || !std::isfinite(x) || !std::isfinite(y)) return;
  const std::vector<double> place{std::clamp(x, 0.0, 1.0), std::clamp(y, 0.0, 1.0)};
  const auto first = queue_.begin() + static_cast<std::ptrdiff_t>(since_order_);
  const auto waiting =
      std::find_if(first, queue_.end(), [&](const Control& c) { return c.contact == contact->number; });
  if (waiting == queue_.end()) {
    queue_.push_back({ControlKind::touch_move, place, {}, contact->number, time_us});
    return;
  }
  waiting->values = place;
  waiting->time_us = time_us;
}

void TouchScreens::end(int device, int slot, ControlKind how, std::uint64_t time_us) {
  const auto contact = find(device, slot);
  if (contact == contacts_.end()) return;
  const int number = contact->number;
  contacts_.erase(contact);
  put({how, {}, {}, number, time_us}, device);
}

void TouchScreens::cancel_all_of(int device) {
  for (auto held = contacts_.begin(); held != contacts_.end();) {
    if (held->device != device) {
      ++held;
      continue;
    }
    queue_.push_back({ControlKind::touch_cancel, {}, {}, held->number, 0});
    held = contacts_.erase(held);
  }
  since_order_ = queue_.size();
}

void TouchScreens::put(Control control, int device) {
  queue_.push_back(std::move(control));
  since_order_ = queue_.size();
  if (queue_.size() <= max_waiting) return;
  const auto mad = devices_.find(device);
  if (mad == devices_.end()) return;
  cancel_all_of(device);
  refuse(mad->second, "sends more touches than anybody can make; unplug it", true);
}

void TouchScreens::refuse(Device& device, std::string why, bool problem) {
  device.refused = std::move(why);
  say(problem, title(device.info) + " is refused: " + device.refused);
}

bool TouchScreens::is_elsewhere(const Device& device) const {
  return !device.bound.empty() && !output_.empty() && device.bound != output_;
}

void TouchScreens::say(bool problem, std::string text) {
  const bool said = std::any_of(notices_.begin(), notices_.end(), [&](const Notice& n) { return n.text == text; });
  if (!said && notices_.size() < max_notices) notices_.push_back({problem, std::move(text)});
}

std::vector<TouchScreens::Contact>::iterator TouchScreens::find(int device, int slot) {
  return std::find_if(contacts_.begin(), contacts_.end(),
                      [=](const Contact& c) { return c.device == device && c.slot == slot; });
}

}  // namespace lackwerk::input

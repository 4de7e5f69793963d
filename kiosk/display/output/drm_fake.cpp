#include "kiosk/display/output/drm_fake.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "core/check.hpp"

namespace lackwerk::kiosk {
namespace {

/// Rows end at multiples of this, as with real drivers: code that forgets the pitch shows.
constexpr std::uint32_t pitch_step = 256;

std::uint64_t get(const std::map<std::string, std::uint64_t>& values, const char* name) {
  const auto found = values.find(name);
  return found == values.end() ? 0 : found->second;
}

}  // namespace

DrmMode simple_mode(int width, int height, double refresh_hz, bool preferred) {
  DrmMode mode;
  const auto w = static_cast<std::uint16_t>(width), h = static_cast<std::uint16_t>(height);
  mode.horizontal = {w, static_cast<std::uint16_t>(w + 16), static_cast<std::uint16_t>(w + 48),
                     static_cast<std::uint16_t>(w + 160)};
  mode.vertical = {h, static_cast<std::uint16_t>(h + 3), static_cast<std::uint16_t>(h + 8),
                   static_cast<std::uint16_t>(h + 30)};
  mode.clock_khz =
      static_cast<std::uint32_t>(std::lround(refresh_hz * mode.horizontal.total * mode.vertical.total / 1000.0));
  mode.preferred = preferred;
  mode.name = std::to_string(width) + "x" + std::to_string(height);
  return mode;
}

FakeKmsDevice::FakeKmsDevice(int crtcs, bool atomic) {
  card_ = {"/fake/card0", "fake", atomic, true};
  for (int k = 0; k < crtcs; ++k) {
    const DrmId crtc = 40 + static_cast<DrmId>(k);
    crtcs_.push_back(crtc);
    objects_[crtc] = {{"ACTIVE", 0}, {"MODE_ID", 0}, {"GAMMA_LUT", 0}, {"VRR_ENABLED", 0}};
    for (const DrmPlaneType type : {DrmPlaneType::primary, DrmPlaneType::cursor}) {
      const DrmId id = (type == DrmPlaneType::primary ? 50 : 60) + static_cast<DrmId>(k);
      planes_.push_back({id, type, 1u << k, {drm_format_xrgb8888}, 0});
      objects_[id] = {{"FB_ID", 0},  {"CRTC_ID", 0}, {"SRC_X", 0},  {"SRC_Y", 0},  {"SRC_W", 0},   {"SRC_H", 0},
                      {"CRTC_X", 0}, {"CRTC_Y", 0},  {"CRTC_W", 0}, {"CRTC_H", 0}, {"rotation", 1}};
    }
  }
}

DrmId FakeKmsDevice::add_connector(const std::string& name) {
  DrmConnector connector;
  connector.id = 30 + static_cast<DrmId>(connectors_.size());
  connector.name = name;
  connector.possible_crtcs = (1u << crtcs_.size()) - 1u;
  objects_[connector.id] = {{"CRTC_ID", 0}, {"link-status", 0}, {"DPMS", 0}};
  connectors_.push_back(connector);
  return connector.id;
}

DrmConnector& FakeKmsDevice::connector(const std::string& name) {
  const auto found =
      std::find_if(connectors_.begin(), connectors_.end(), [&](const DrmConnector& one) { return one.name == name; });
  check_equal(found != connectors_.end(), true, "connector " + name + " of the fake card");
  return *found;
}

void FakeKmsDevice::plug(const std::string& name, std::vector<DrmMode> modes) {
  DrmConnector& one = connector(name);
  one.connected = true;
  one.modes = std::move(modes);
}

void FakeKmsDevice::unplug(const std::string& name) {
  DrmConnector& one = connector(name);
  one.connected = false;
  one.modes.clear();
}

void FakeKmsDevice::remove_primary_planes() {
  std::erase_if(planes_, [](const DrmPlane& plane) { return plane.type == DrmPlaneType::primary; });
}

void FakeKmsDevice::show_console(const std::string& name, const DrmMode& mode) {
  const DrmId crtc = crtcs_.front(), framebuffer = next_++, blob = next_++;
  framebuffers_[framebuffer] = {mode.size_px(), 0, static_cast<std::uint32_t>(mode.size_px()[0]) * 4, 0};
  modes_[blob] = mode;
  objects_[crtc]["MODE_ID"] = blob;
  objects_[crtc]["ACTIVE"] = 1;
  objects_[connector(name).id]["CRTC_ID"] = crtc;
  const DrmId plane = plane_of(crtc, DrmPlaneType::primary);
  objects_[plane]["FB_ID"] = framebuffer;
  objects_[plane]["CRTC_ID"] = crtc;
}

void FakeKmsDevice::fail_next(Call call, int code, int times, int first) {
  auto& list = faults_[call];
  list.insert(list.end(), static_cast<std::size_t>(first), 0);
  list.insert(list.end(), static_cast<std::size_t>(times), code);
}

int FakeKmsDevice::fault(Call call) {
  ++calls_[call];
  if (before) before(call);
  auto& list = faults_[call];
  if (list.empty()) return 0;
  const int code = list.front();
  list.pop_front();
  return code;
}

int FakeKmsDevice::calls(Call call) const {
  const auto found = calls_.find(call);
  return found == calls_.end() ? 0 : found->second;
}

void FakeKmsDevice::report_held() {
  events_.insert(events_.end(), held_.begin(), held_.end());
  held_.clear();
}

DrmId FakeKmsDevice::plane_of(DrmId crtc, DrmPlaneType type) const {
  const auto at = std::find(crtcs_.begin(), crtcs_.end(), crtc) - crtcs_.begin();
  for (const DrmPlane& plane : planes_)
    if (plane.type == type && ((plane.possible_crtcs >> at) & 1u) != 0) return plane.id;
  return 0;
}

std::uint64_t FakeKmsDevice::value(DrmId object, const std::string& name) const {
  const auto found = objects_.find(object);
  return found == objects_.end() ? 0 : get(found->second, name.c_str());
}

FakeKmsDevice::Panel FakeKmsDevice::panel(const std::string& name) const {
  Panel out;
  for (const DrmConnector& one : connectors_) {
    if (one.name != name) continue;
    out.connector = one.id;
    out.dpms_on = value(one.id, "DPMS") == 0;
    const auto crtc = static_cast<DrmId>(value(one.id, "CRTC_ID"));
    if (crtc == 0) return out;
    out.active = value(crtc, "ACTIVE") != 0;
    if (const auto mode = modes_.find(static_cast<DrmId>(value(crtc, "MODE_ID"))); mode != modes_.end())
      out.mode = mode->second;
    for (const DrmPlane& plane : planes_)
      if (plane.type == DrmPlaneType::primary && value(plane.id, "CRTC_ID") == crtc)
        out.framebuffer = static_cast<DrmId>(value(plane.id, "FB_ID"));
  }
  return out;
}

const std::uint8_t* FakeKmsDevice::pixels(DrmId framebuffer, std::uint32_t& pitch) const {
  const auto found = framebuffers_.find(framebuffer);
  if (found == framebuffers_.end()) return nullptr;
  const auto memory = dumb_.find(found->second.handle);
  if (memory == dumb_.end()) return nullptr;
  pitch = found->second.pitch;
  return memory->second.data();
}

DrmResult<DrmResources> FakeKmsDevice::resources() {
  if (const int code = fault(Call::resources); code != 0) return tl::unexpected<int>(code);
  DrmResources out;
  out.crtcs = crtcs_;
  for (const DrmConnector& one : connectors_) out.connectors.push_back(one.id);
  out.largest_px = {8192, 8192};
  return out;
}

DrmResult<DrmConnector> FakeKmsDevice::probe_connector(DrmId id) {
  if (const int code = fault(Call::probe); code != 0) return tl::unexpected<int>(code);
  for (DrmConnector one : connectors_)
    if (one.id == id) {
      one.crtc = static_cast<DrmId>(value(id, "CRTC_ID"));
      return one;
    }
  return tl::unexpected<int>(ENOENT);
}

DrmResult<std::vector<DrmPlane>> FakeKmsDevice::planes() {
  if (const int code = fault(Call::planes); code != 0) return tl::unexpected<int>(code);
  std::vector<DrmPlane> out = planes_;
  for (DrmPlane& plane : out) plane.crtc = static_cast<DrmId>(value(plane.id, "CRTC_ID"));
  return out;
}

DrmId FakeKmsDevice::property_id(DrmId object, const std::string& name) {
  DrmId& id = property_ids_[{object, name}];
  if (id == 0) {
    id = next_++;
    property_names_[id] = {object, name};
  }
  return id;
}

DrmResult<std::vector<DrmProperty>> FakeKmsDevice::properties(DrmId object, DrmObject /*kind*/) {
  if (const int code = fault(Call::properties); code != 0) return tl::unexpected<int>(code);
  const auto found = objects_.find(object);
  if (found == objects_.end()) return tl::unexpected<int>(ENOENT);
  std::vector<DrmProperty> out;
  for (const auto& [name, value] : found->second) out.push_back({property_id(object, name), name, value});
  return out;
}

DrmResult<DrmPipeState> FakeKmsDevice::pipe_state(DrmId crtc) {
  if (const int code = fault(Call::pipe_state); code != 0) return tl::unexpected<int>(code);
  DrmPipeState out;
  const auto mode = modes_.find(static_cast<DrmId>(value(crtc, "MODE_ID")));
  out.active = value(crtc, "ACTIVE") != 0 && mode != modes_.end();
  if (out.active) out.mode = mode->second;
  out.framebuffer = static_cast<DrmId>(value(plane_of(crtc, DrmPlaneType::primary), "FB_ID"));
  return out;
}

DrmResult<DrmId> FakeKmsDevice::create_mode_blob(const DrmMode& mode) {
  if (const int code = fault(Call::blob); code != 0) return tl::unexpected<int>(code);
  blobs_[next_] = mode;
  return next_++;
}

DrmResult<DrmId> FakeKmsDevice::add_framebuffer(const DrmFramebuffer& framebuffer) {
  if (const int code = fault(Call::framebuffer); code != 0) return tl::unexpected<int>(code);
  framebuffers_[next_] = framebuffer;
  return next_++;
}

void FakeKmsDevice::remove_framebuffer(DrmId id) {
  framebuffers_.erase(id);
  // As the kernel: what still shows it goes dark.
  for (const DrmPlane& plane : planes_) {
    Values& values = objects_[plane.id];
    if (get(values, "FB_ID") != id) continue;
    if (plane.type == DrmPlaneType::primary) objects_[static_cast<DrmId>(get(values, "CRTC_ID"))]["ACTIVE"] = 0;
    values["FB_ID"] = values["CRTC_ID"] = 0;
  }
}

DrmResult<DrmDumb> FakeKmsDevice::create_dumb(std::array<int, 2> size_px) {
  if (const int code = fault(Call::dumb); code != 0) return tl::unexpected<int>(code);
  DrmDumb out;
  out.size_px = size_px;
  out.handle = next_++;
  out.pitch = (static_cast<std::uint32_t>(size_px[0]) * 4 + pitch_step - 1) / pitch_step * pitch_step;
  out.bytes = std::uint64_t{out.pitch} * static_cast<std::uint64_t>(size_px[1]);
  dumb_[out.handle].resize(out.bytes, 0xEE);
  return out;
}

DrmResult<std::uint8_t*> FakeKmsDevice::map_dumb(const DrmDumb& buffer) {
  const auto found = dumb_.find(buffer.handle);
  if (found == dumb_.end()) return tl::unexpected<int>(ENOENT);
  ++mapped_;
  return found->second.data();
}

void FakeKmsDevice::unmap_dumb(const DrmDumb& /*buffer*/, std::uint8_t* /*mapped*/) { --mapped_; }

int FakeKmsDevice::apply(const std::vector<DrmSetting>& settings, Objects& objects) const {
  for (const DrmSetting& setting : settings) {
    const auto name = property_names_.find(setting.property);
    if (name == property_names_.end() || name->second.first != setting.object) return ENOENT;
    objects[setting.object][name->second.second] = setting.value;
  }
  return 0;
}

int FakeKmsDevice::check(const Objects& objects, bool allow_modeset) const {
  const auto now = [&](DrmId id, const char* name) { return get(objects.at(id), name); };
  for (const DrmId crtc : crtcs_) {
    bool routed = false;
    bool changed = now(crtc, "ACTIVE") != value(crtc, "ACTIVE") || now(crtc, "MODE_ID") != value(crtc, "MODE_ID");
    for (const DrmConnector& one : connectors_) {
      const bool here = now(one.id, "CRTC_ID") == crtc;
      routed |= here;
      changed |= here != (value(one.id, "CRTC_ID") == crtc);
    }
    if (changed && !allow_modeset) return EINVAL;
    const std::uint64_t mode = now(crtc, "MODE_ID");
    if (now(crtc, "ACTIVE") != 0 && (mode == 0 || !routed)) return EINVAL;
    if (mode != 0 && blobs_.count(static_cast<DrmId>(mode)) == 0 && mode != value(crtc, "MODE_ID")) return EINVAL;
    if (mode == 0 && routed) return EINVAL;
  }
  for (const DrmPlane& plane : planes_) {
    const auto framebuffer = static_cast<DrmId>(now(plane.id, "FB_ID"));
    if ((framebuffer == 0) != (now(plane.id, "CRTC_ID") == 0)) return EINVAL;
    if (framebuffer == 0 || framebuffer == value(plane.id, "FB_ID")) continue;
    const auto found = framebuffers_.find(framebuffer);
    if (found == framebuffers_.end()) return ENOENT;
    if (now(plane.id, "SRC_W") >> 16 > static_cast<std::uint64_t>(found->second.size_px[0]) ||
        now(plane.id, "SRC_H") >> 16 > static_cast<std::uint64_t>(found->second.size_px[1]))
      return ENOSPC;
  }
  return 0;
}

void FakeKmsDevice::flip_done(DrmId crtc, std::uint32_t cookie) {
  clock_us_ += 16'667;
  if (flips_come) pending_[crtc] = cookie;
  (flips_come ? events_ : held_).push_back({cookie, clock_us_});
}

DrmResult<void> FakeKmsDevice::commit(const std::vector<DrmSetting>& settings, const DrmCommit& how) {
  if (const int code = fault(how.test_only ? Call::test : Call::commit); code != 0) return tl::unexpected<int>(code);
  if (!card_.atomic) return tl::unexpected<int>(EOPNOTSUPP);
  if (!master_) return tl::unexpected<int>(EACCES);
  Objects next = objects_;
  if (const int code = apply(settings, next); code != 0) return tl::unexpected<int>(code);
  if (const int code = check(next, how.allow_modeset); code != 0) return tl::unexpected<int>(code);
  if (how.test_only) return {};
  DrmId touched = 0;
  for (const DrmSetting& setting : settings) {
    if (std::find(crtcs_.begin(), crtcs_.end(), setting.object) != crtcs_.end()) touched = setting.object;
    if (setting.object >= 50 && touched == 0)
      touched = static_cast<DrmId>(get(next[setting.object], "CRTC_ID"));  // of a plane: a flip
  }
  if (pending_.count(touched) == 1 && !how.wait) return tl::unexpected<int>(EBUSY);
  objects_ = std::move(next);
  for (const auto& [id, mode] : blobs_) modes_[id] = mode;
  if (how.event) flip_done(touched, how.cookie);
  return {};
}

DrmResult<void> FakeKmsDevice::set_crtc(DrmId crtc, DrmId framebuffer, std::array<int, 2> /*from*/, DrmId connector,
                                        const DrmMode* mode) {
  if (const int code = fault(Call::set_crtc); code != 0) return tl::unexpected<int>(code);
  if (!master_) return tl::unexpected<int>(EACCES);
  if (mode != nullptr && framebuffers_.count(framebuffer) == 0) return tl::unexpected<int>(ENOENT);
  // The kernel has a primary plane of its own even where it shows none.
  const auto at = static_cast<DrmId>(std::find(crtcs_.begin(), crtcs_.end(), crtc) - crtcs_.begin());
  Values& plane = objects_[50 + at];
  for (const DrmConnector& one : connectors_)
    if (value(one.id, "CRTC_ID") == crtc) objects_[one.id]["CRTC_ID"] = 0;
  if (mode == nullptr) {
    objects_[crtc]["ACTIVE"] = objects_[crtc]["MODE_ID"] = 0;
    plane["FB_ID"] = plane["CRTC_ID"] = 0;
    return {};
  }
  modes_[next_] = *mode;
  objects_[crtc]["MODE_ID"] = next_++;
  objects_[crtc]["ACTIVE"] = 1;
  objects_[connector]["CRTC_ID"] = crtc;
  plane["FB_ID"] = framebuffer;
  plane["CRTC_ID"] = crtc;
  pending_.erase(crtc);
  return {};
}

DrmResult<void> FakeKmsDevice::page_flip(DrmId crtc, DrmId framebuffer, std::uint32_t cookie) {
  if (const int code = fault(Call::page_flip); code != 0) return tl::unexpected<int>(code);
  if (!master_) return tl::unexpected<int>(EACCES);
  if (pending_.count(crtc) == 1) return tl::unexpected<int>(EBUSY);
  if (value(crtc, "ACTIVE") == 0) return tl::unexpected<int>(EINVAL);
  const auto at = static_cast<DrmId>(std::find(crtcs_.begin(), crtcs_.end(), crtc) - crtcs_.begin());
  objects_[50 + at]["FB_ID"] = framebuffer;
  flip_done(crtc, cookie);
  return {};
}

DrmResult<void> FakeKmsDevice::set_connector_property(DrmId connector, DrmId property, std::uint64_t value) {
  return apply({{connector, property, value}}, objects_) == 0 ? DrmResult<void>() : tl::unexpected<int>(ENOENT);
}

DrmResult<std::vector<DrmFlip>> FakeKmsDevice::read_flips(int /*timeout_ms*/) {
  if (const int code = fault(Call::read); code != 0) return tl::unexpected<int>(code);
  std::vector<DrmFlip> out(events_.begin(), events_.end());
  events_.clear();
  for (const DrmFlip& flip : out) std::erase_if(pending_, [&](const auto& one) { return one.second == flip.cookie; });
  return out;
}

DrmResult<void> FakeKmsDevice::set_master() {
  if (const int code = fault(Call::master); code != 0) return tl::unexpected<int>(code);
  if (another_master_) return tl::unexpected<int>(EBUSY);
  master_ = true;
  return {};
}

}  // namespace lackwerk::kiosk

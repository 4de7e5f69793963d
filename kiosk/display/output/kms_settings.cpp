#include "kiosk/display/output/kms_settings.hpp"

#include <algorithm>

namespace lackwerk::kiosk {
namespace {

using Names = PipeProperties::Names;

DrmResult<Names> read_names(KmsDevice& device, DrmId object, DrmObject kind) {
  auto all = device.properties(object, kind);
  if (!all) return tl::unexpected<int>(all.error());
  Names out;
  for (DrmProperty& property : *all) {
    std::string name = property.name;
    out.emplace(std::move(name), std::move(property));
  }
  return out;
}

bool has_all(const Names& names, std::initializer_list<const char*> wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](const char* name) { return names.count(name) == 1; });
}

/// Adds a property if the driver has it.
void set(std::vector<DrmSetting>& out, DrmId object, const Names& names, const char* name, std::uint64_t value) {
  if (const auto found = names.find(name); found != names.end()) out.push_back({object, found->second.id, value});
}

}  // namespace

bool PipeProperties::atomic() const {
  return has_all(connector, {"CRTC_ID"}) && has_all(crtc, {"MODE_ID", "ACTIVE"}) &&
         has_all(plane,
                 {"FB_ID", "CRTC_ID", "SRC_X", "SRC_Y", "SRC_W", "SRC_H", "CRTC_X", "CRTC_Y", "CRTC_W", "CRTC_H"});
}

DrmResult<PipeProperties> read_properties(KmsDevice& device, const Pipe& pipe, const DrmSnapshot& snapshot) {
  PipeProperties out;
  auto connector = read_names(device, pipe.connector.id, DrmObject::connector);
  if (!connector) return tl::unexpected<int>(connector.error());
  out.connector = std::move(*connector);
  auto crtc = read_names(device, pipe.crtc, DrmObject::crtc);
  if (!crtc) return tl::unexpected<int>(crtc.error());
  out.crtc = std::move(*crtc);
  if (pipe.plane != 0) {
    auto plane = read_names(device, pipe.plane, DrmObject::plane);
    if (!plane) return tl::unexpected<int>(plane.error());
    out.plane = std::move(*plane);
  }
  for (const DrmConnector& other : snapshot.connectors) {
    if (other.id == pipe.connector.id || other.crtc != pipe.crtc) continue;
    if (const auto names = read_names(device, other.id, DrmObject::connector))
      set(out.others_off, other.id, *names, "CRTC_ID", 0);
  }
  for (const DrmPlane& other : snapshot.planes) {
    if (other.id == pipe.plane || other.crtc != pipe.crtc) continue;
    if (const auto names = read_names(device, other.id, DrmObject::plane)) {
      set(out.others_off, other.id, *names, "FB_ID", 0);
      set(out.others_off, other.id, *names, "CRTC_ID", 0);
    }
  }
  return out;
}

std::vector<DrmSetting> full_state(const Pipe& pipe, const PipeProperties& properties, DrmId framebuffer,
                                   DrmId mode_blob) {
  std::vector<DrmSetting> out = properties.others_off;
  const auto width = std::uint64_t{pipe.mode.horizontal.display}, height = std::uint64_t{pipe.mode.vertical.display};
  const DrmId connector = pipe.connector.id, crtc = pipe.crtc, plane = pipe.plane;
  set(out, connector, properties.connector, "CRTC_ID", crtc);
  // drm_connector.c: user space writes GOOD after a link has failed, which makes the driver train it anew.
  set(out, connector, properties.connector, "link-status", 0);
  set(out, crtc, properties.crtc, "MODE_ID", mode_blob);
  set(out, crtc, properties.crtc, "ACTIVE", 1);
  for (const char* table : {"DEGAMMA_LUT", "CTM", "GAMMA_LUT"}) set(out, crtc, properties.crtc, table, 0);
  set(out, crtc, properties.crtc, "VRR_ENABLED", 0);
  set(out, plane, properties.plane, "FB_ID", framebuffer);
  set(out, plane, properties.plane, "CRTC_ID", crtc);
  set(out, plane, properties.plane, "SRC_X", 0);
  set(out, plane, properties.plane, "SRC_Y", 0);
  set(out, plane, properties.plane, "SRC_W", width << 16);  // 16.16 fixed point
  set(out, plane, properties.plane, "SRC_H", height << 16);
  set(out, plane, properties.plane, "CRTC_X", 0);
  set(out, plane, properties.plane, "CRTC_Y", 0);
  set(out, plane, properties.plane, "CRTC_W", width);
  set(out, plane, properties.plane, "CRTC_H", height);
  set(out, plane, properties.plane, "rotation", 1);  // DRM_MODE_ROTATE_0: the present pass turns
  return out;
}

std::vector<DrmSetting> flip_state(const Pipe& pipe, const PipeProperties& properties, DrmId framebuffer) {
  std::vector<DrmSetting> out;
  set(out, pipe.plane, properties.plane, "FB_ID", framebuffer);
  return out;
}

std::vector<DrmSetting> sleep_state(const Pipe& pipe, const PipeProperties& properties) {
  std::vector<DrmSetting> out;
  set(out, pipe.crtc, properties.crtc, "ACTIVE", 0);
  return out;
}

std::vector<DrmSetting> off_state(const Pipe& pipe, const PipeProperties& properties) {
  std::vector<DrmSetting> out;
  set(out, pipe.connector.id, properties.connector, "CRTC_ID", 0);
  set(out, pipe.crtc, properties.crtc, "ACTIVE", 0);
  set(out, pipe.crtc, properties.crtc, "MODE_ID", 0);
  set(out, pipe.plane, properties.plane, "FB_ID", 0);
  set(out, pipe.plane, properties.plane, "CRTC_ID", 0);
  return out;
}

}  // namespace lackwerk::kiosk

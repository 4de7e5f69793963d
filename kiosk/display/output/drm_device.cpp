#include "kiosk/display/output/drm_device.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace lackwerk::kiosk {
namespace {

/// Objects libdrm hands out, freed by its own functions.
template <class T, void (*free_it)(T*)>
struct DrmFree {
  void operator()(T* object) const { free_it(object); }
};
template <class T, void (*free_it)(T*)>
using DrmPtr = std::unique_ptr<T, DrmFree<T, free_it>>;
using ConnectorPtr = DrmPtr<drmModeConnector, drmModeFreeConnector>;
using EncoderPtr = DrmPtr<drmModeEncoder, drmModeFreeEncoder>;
using PropertiesPtr = DrmPtr<drmModeObjectProperties, drmModeFreeObjectProperties>;
using PropertyPtr = DrmPtr<drmModePropertyRes, drmModeFreeProperty>;

/// errno after a failed call; never 0, so that a failure stays one.
int last_error() { return errno == 0 ? EIO : errno; }

/// libdrm returns -errno, or -1 and errno.
DrmResult<void> outcome(int returned) {
  if (returned == 0) return {};
  return tl::unexpected<int>(returned < -1 ? -returned : last_error());
}

DrmMode mode_of(const drmModeModeInfo& info) {
  DrmMode mode;
  mode.clock_khz = info.clock;
  mode.horizontal = {info.hdisplay, info.hsync_start, info.hsync_end, info.htotal};
  mode.vertical = {info.vdisplay, info.vsync_start, info.vsync_end, info.vtotal};
  mode.hskew = info.hskew;
  mode.vscan = info.vscan;
  mode.flags = info.flags;
  mode.preferred = (info.type & DRM_MODE_TYPE_PREFERRED) != 0;
  mode.name.assign(info.name, strnlen(info.name, sizeof info.name));
  return mode;
}

drmModeModeInfo info_of(const DrmMode& mode) {
  drmModeModeInfo info{};
  info.clock = mode.clock_khz;
  info.hdisplay = mode.horizontal.display;
  info.hsync_start = mode.horizontal.sync_start;
  info.hsync_end = mode.horizontal.sync_end;
  info.htotal = mode.horizontal.total;
  info.hskew = mode.hskew;
  info.vdisplay = mode.vertical.display;
  info.vsync_start = mode.vertical.sync_start;
  info.vsync_end = mode.vertical.sync_end;
  info.vtotal = mode.vertical.total;
  info.vscan = mode.vscan;
  info.vrefresh = static_cast<std::uint32_t>(std::lround(mode.refresh_hz()));
  info.flags = mode.flags;
  info.type = mode.preferred ? DRM_MODE_TYPE_PREFERRED : 0u;
  mode.name.copy(info.name, sizeof info.name - 1);
  return info;
}

std::uint32_t kernel_kind(DrmObject kind) {
  if (kind == DrmObject::connector) return DRM_MODE_OBJECT_CONNECTOR;
  return kind == DrmObject::crtc ? DRM_MODE_OBJECT_CRTC : DRM_MODE_OBJECT_PLANE;
}

class LibdrmDevice final : public KmsDevice {
 public:
  LibdrmDevice(int fd, DrmCard card) : fd_(fd), card_(std::move(card)) {}

  [[nodiscard]] const DrmCard& card() const override { return card_; }
  [[nodiscard]] int fd() const override { return fd_; }

  DrmResult<DrmResources> resources() override {
    const DrmPtr<drmModeRes, drmModeFreeResources> found(drmModeGetResources(fd_));
    if (!found) return tl::unexpected<int>(last_error());
    DrmResources out;
    out.crtcs.assign(found->crtcs, found->crtcs + found->count_crtcs);
    out.connectors.assign(found->connectors, found->connectors + found->count_connectors);
    out.largest_px = {static_cast<int>(found->max_width), static_cast<int>(found->max_height)};
    return out;
  }

  DrmResult<DrmConnector> probe_connector(DrmId id) override {
    const ConnectorPtr found(drmModeGetConnector(fd_, id));
    if (!found) return tl::unexpected<int>(last_error());
    DrmConnector out;
    out.id = id;
    const char* type = drmModeGetConnectorTypeName(found->connector_type);
    out.name = std::string(type == nullptr ? "Unknown" : type) + "-" + std::to_string(found->connector_type_id);
    out.connected = found->connection == DRM_MODE_CONNECTED;
    constexpr std::uint32_t most_mm = 100'000;
    out.size_mm = {static_cast<int>(std::min(found->mmWidth, most_mm)),
                   static_cast<int>(std::min(found->mmHeight, most_mm))};
    out.modes.reserve(static_cast<std::size_t>(std::max(found->count_modes, 0)));
    for (int k = 0; k < found->count_modes; ++k) out.modes.push_back(mode_of(found->modes[k]));
    for (int k = 0; k < found->count_encoders; ++k) {
      const EncoderPtr encoder(drmModeGetEncoder(fd_, found->encoders[k]));
      if (encoder) out.possible_crtcs |= encoder->possible_crtcs;
    }
    if (const EncoderPtr encoder(drmModeGetEncoder(fd_, found->encoder_id)); encoder) out.crtc = encoder->crtc_id;
    if (const auto all = properties(id, DrmObject::connector))
      out.desktop = std::none_of(all->begin(), all->end(), [](const DrmProperty& property) {
        return property.name == "non-desktop" && property.value != 0;
      });
    return out;
  }

  DrmResult<std::vector<DrmPlane>> planes() override {
    const DrmPtr<drmModePlaneRes, drmModeFreePlaneResources> found(drmModeGetPlaneResources(fd_));
    if (!found) return tl::unexpected<int>(last_error());
    std::vector<DrmPlane> out;
    out.reserve(found->count_planes);
    for (std::uint32_t k = 0; k < found->count_planes; ++k) {
      const DrmPtr<drmModePlane, drmModeFreePlane> plane(drmModeGetPlane(fd_, found->planes[k]));
      if (!plane) continue;
      DrmPlane one{plane->plane_id, DrmPlaneType::overlay, plane->possible_crtcs, {}, plane->crtc_id};
      one.formats.assign(plane->formats, plane->formats + plane->count_formats);
      if (const auto all = properties(one.id, DrmObject::plane))
        for (const DrmProperty& property : *all)
          if (property.name == "type")
            one.type = property.value == DRM_PLANE_TYPE_PRIMARY  ? DrmPlaneType::primary
                       : property.value == DRM_PLANE_TYPE_CURSOR ? DrmPlaneType::cursor
                                                                 : DrmPlaneType::overlay;
      out.push_back(std::move(one));
    }
    return out;
  }

  DrmResult<std::vector<DrmProperty>> properties(DrmId object, DrmObject kind) override {
    const PropertiesPtr found(drmModeObjectGetProperties(fd_, object, kernel_kind(kind)));
    if (!found) return tl::unexpected<int>(last_error());
    std::vector<DrmProperty> out;
    out.reserve(found->count_props);
    for (std::uint32_t k = 0; k < found->count_props; ++k) {
      const PropertyPtr property(drmModeGetProperty(fd_, found->props[k]));
      if (!property) continue;
      out.push_back({property->prop_id, std::string(property->name, strnlen(property->name, sizeof property->name)),
                     found->prop_values[k]});
    }
    return out;
  }

  DrmResult<DrmPipeState> pipe_state(DrmId crtc) override {
    const DrmPtr<drmModeCrtc, drmModeFreeCrtc> found(drmModeGetCrtc(fd_, crtc));
    if (!found) return tl::unexpected<int>(last_error());
    DrmPipeState out;
    out.framebuffer = found->buffer_id;
    out.x = static_cast<int>(found->x);
    out.y = static_cast<int>(found->y);
    out.active = found->mode_valid != 0;
    if (out.active) out.mode = mode_of(found->mode);
    return out;
  }

  DrmResult<DrmId> create_mode_blob(const DrmMode& mode) override {
    const drmModeModeInfo info = info_of(mode);
    DrmId id = 0;
    if (auto made = outcome(drmModeCreatePropertyBlob(fd_, &info, sizeof info, &id)); !made)
      return tl::unexpected<int>(made.error());
    return id;
  }
  void destroy_blob(DrmId id) override { drmModeDestroyPropertyBlob(fd_, id); }

  DrmResult<DrmId> add_framebuffer(const DrmFramebuffer& framebuffer) override {
    const std::array<std::uint32_t, 4> handles = {framebuffer.handle}, pitches = {framebuffer.pitch},
                                       offsets = {framebuffer.offset};
    DrmId id = 0;
    if (auto made = outcome(drmModeAddFB2(fd_, static_cast<std::uint32_t>(framebuffer.size_px[0]),
                                          static_cast<std::uint32_t>(framebuffer.size_px[1]), framebuffer.format,
                                          handles.data(), pitches.data(), offsets.data(), &id, 0));
        !made)
      return tl::unexpected<int>(made.error());
    return id;
  }
  void remove_framebuffer(DrmId id) override { drmModeRmFB(fd_, id); }

  DrmResult<DrmDumb> create_dumb(std::array<int, 2> size_px) override {
    DrmDumb out;
    out.size_px = size_px;
    if (auto made = outcome(drmModeCreateDumbBuffer(fd_, static_cast<std::uint32_t>(size_px[0]),
                                                    static_cast<std::uint32_t>(size_px[1]), 32, 0, &out.handle,
                                                    &out.pitch, &out.bytes));
        !made)
      return tl::unexpected<int>(made.error());
    return out;
  }
  DrmResult<std::uint8_t*> map_dumb(const DrmDumb& buffer) override {
    std::uint64_t offset = 0;
    if (auto found = outcome(drmModeMapDumbBuffer(fd_, buffer.handle, &offset)); !found)
      return tl::unexpected<int>(found.error());
    void* mapped = mmap64(nullptr, buffer.bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, static_cast<off64_t>(offset));
    if (mapped == MAP_FAILED) return tl::unexpected<int>(last_error());
    return static_cast<std::uint8_t*>(mapped);
  }
  void unmap_dumb(const DrmDumb& buffer, std::uint8_t* mapped) override { munmap(mapped, buffer.bytes); }
  void destroy_dumb(const DrmDumb& buffer) override { drmModeDestroyDumbBuffer(fd_, buffer.handle); }

  DrmResult<void> commit(const std::vector<DrmSetting>& settings, const DrmCommit& how) override {
    const DrmPtr<drmModeAtomicReq, drmModeAtomicFree> request(drmModeAtomicAlloc());
    if (!request) return tl::unexpected<int>(ENOMEM);
    for (const DrmSetting& setting : settings)
      if (drmModeAtomicAddProperty(request.get(), setting.object, setting.property, setting.value) < 0)
        return tl::unexpected<int>(ENOMEM);
    std::uint32_t flags =
        how.test_only ? std::uint32_t{DRM_MODE_ATOMIC_TEST_ONLY} : std::uint32_t{DRM_MODE_ATOMIC_NONBLOCK};
    if (how.allow_modeset) flags |= DRM_MODE_ATOMIC_ALLOW_MODESET;
    if (how.event && !how.test_only) flags |= DRM_MODE_PAGE_FLIP_EVENT;
    return outcome(drmModeAtomicCommit(fd_, request.get(), flags, cookie_pointer(how.cookie)));
  }
  DrmResult<void> set_crtc(DrmId crtc, DrmId framebuffer, std::array<int, 2> from, DrmId connector,
                           const DrmMode* mode) override {
    if (mode == nullptr) return outcome(drmModeSetCrtc(fd_, crtc, 0, 0, 0, nullptr, 0, nullptr));
    drmModeModeInfo info = info_of(*mode);
    return outcome(drmModeSetCrtc(fd_, crtc, framebuffer, static_cast<std::uint32_t>(from[0]),
                                  static_cast<std::uint32_t>(from[1]), &connector, 1, &info));
  }
  DrmResult<void> page_flip(DrmId crtc, DrmId framebuffer, std::uint32_t cookie) override {
    return outcome(drmModePageFlip(fd_, crtc, framebuffer, DRM_MODE_PAGE_FLIP_EVENT, cookie_pointer(cookie)));
  }
  DrmResult<void> set_connector_property(DrmId connector, DrmId property, std::uint64_t value) override {
    return outcome(drmModeConnectorSetProperty(fd_, connector, property, value));
  }

  /// Read by hand instead of drmHandleEvent: its callbacks would need a global or a cast of this.
  DrmResult<std::vector<DrmFlip>> read_flips(int timeout_ms) override {
    std::vector<DrmFlip> out;
    pollfd waiting{fd_, POLLIN, 0};
    const int ready = poll(&waiting, 1, timeout_ms);
    if (ready < 0) return errno == EINTR ? DrmResult<std::vector<DrmFlip>>(out) : tl::unexpected<int>(last_error());
    if (ready == 0) return out;
    if ((waiting.revents & POLLIN) == 0) return tl::unexpected<int>(ENODEV);  // POLLERR, POLLHUP: the card has gone
    alignas(8) std::array<char, 1024> buffer;
    const ssize_t got = read(fd_, buffer.data(), buffer.size());
    if (got < 0)
      return errno == EINTR || errno == EAGAIN ? DrmResult<std::vector<DrmFlip>>(out)
                                               : tl::unexpected<int>(last_error());
    for (std::size_t at = 0; at + sizeof(drm_event) <= static_cast<std::size_t>(got);) {
      drm_event head{};
      std::memcpy(&head, &buffer[at], sizeof head);
      if (head.length < sizeof head || at + head.length > static_cast<std::size_t>(got)) break;
      if (head.type == DRM_EVENT_FLIP_COMPLETE && head.length >= sizeof(drm_event_vblank)) {
        drm_event_vblank flip{};
        std::memcpy(&flip, &buffer[at], sizeof flip);
        out.push_back({static_cast<std::uint32_t>(flip.user_data),
                       std::uint64_t{flip.tv_sec} * 1'000'000u + std::uint64_t{flip.tv_usec}});
      }
      at += head.length;
    }
    return out;
  }

  DrmResult<void> set_master() override {
    if (drmIsMaster(fd_) != 0) return {};
    return outcome(drmSetMaster(fd_));
  }
  void drop_master() override { drmDropMaster(fd_); }

 private:
  static void* cookie_pointer(std::uint32_t cookie) {
    return reinterpret_cast<void*>(std::uintptr_t{cookie});  // NOLINT(performance-no-int-to-ptr): libdrm's interface
  }
  int fd_;
  DrmCard card_;
};

}  // namespace

bool DrmMode::interlaced() const { return (flags & DRM_MODE_FLAG_INTERLACE) != 0; }

double DrmMode::refresh_hz() const {
  if (horizontal.total == 0 || vertical.total == 0) return 0.0;
  // drm_mode_vrefresh() of the kernel.
  double hz = 1000.0 * clock_khz / (static_cast<double>(horizontal.total) * vertical.total);
  if (interlaced()) hz *= 2.0;
  if ((flags & DRM_MODE_FLAG_DBLSCAN) != 0) hz /= 2.0;
  if (vscan > 1) hz /= vscan;
  return hz;
}

std::string DrmMode::text() const {
  char hz[32];
  std::snprintf(hz, sizeof hz, "%.2f", refresh_hz());
  return std::to_string(horizontal.display) + "x" + std::to_string(vertical.display) + (interlaced() ? "i" : "") +
         " at " + hz + " Hz";
}

bool DrmMode::same_signal(const DrmMode& other) const {
  return clock_khz == other.clock_khz && horizontal == other.horizontal && vertical == other.vertical &&
         hskew == other.hskew && vscan == other.vscan && flags == other.flags;
}

std::string errno_text(int code) {
  const char* name = strerrorname_np(code);
  const char* text = strerrordesc_np(code);
  return (name == nullptr ? "errno " + std::to_string(code) : std::string(name)) +
         (text == nullptr ? "" : " (" + std::string(text) + ")");
}

Result<std::unique_ptr<KmsDevice>> open_kms_device(int fd, const std::string& path) {
  DrmCard card;
  card.path = path;
  if (const DrmPtr<drmVersion, drmFreeVersion> version(drmGetVersion(fd)); version)
    card.driver.assign(version->name, static_cast<std::size_t>(std::max(version->name_len, 0)));
  if (card.driver.empty()) return fail(path, "", "not a DRM card", "give a /dev/dri/card* node");
  const DrmPtr<drmModeRes, drmModeFreeResources> found(drmModeGetResources(fd));
  if (!found || found->count_crtcs < 1 || found->count_connectors < 1)
    return fail(path, "", "driver " + card.driver + " drives no display", "choose the card the monitor is at");
  drmSetClientCap(fd, DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1);
  card.atomic = drmSetClientCap(fd, DRM_CLIENT_CAP_ATOMIC, 1) == 0;
  std::uint64_t dumb = 0;
  card.dumb = drmGetCap(fd, DRM_CAP_DUMB_BUFFER, &dumb) == 0 && dumb != 0;
  // poll() says when there is something; a read that found nothing must not hang the kiosk.
  const int flags = fcntl(fd, F_GETFL);
  if (flags >= 0) fcntl(fd, F_SETFL, flags | O_NONBLOCK);
  return std::make_unique<LibdrmDevice>(fd, std::move(card));
}

}  // namespace lackwerk::kiosk

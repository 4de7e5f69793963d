// A card that exists only in memory: the twin of the kernel's, with monitors to plug, faults to order, and a panel to
// look at.
//
// Why it exists: what a kiosk does when a driver is busy, refuses, forgets a flip or loses its monitor must be a test,
// not a hope. It checks commits as the kernel does (known objects, complete states, modesets only where allowed, one
// change at a time) and counts what is alive, so that leaks show. A value to play with; one thread.
#pragma once

#include <deque>
#include <functional>
#include <map>

#include "kiosk/display/output/drm_device.hpp"

namespace lackwerk::kiosk {

/// A mode of usual timings: `width` and `height` in pixels.
[[nodiscard]] DrmMode simple_mode(int width, int height, double refresh_hz = 60.0, bool preferred = false);

class FakeKmsDevice final : public KmsDevice {
 public:
  enum class Call {
    resources,
    probe,
    planes,
    properties,
    pipe_state,
    blob,
    framebuffer,
    dumb,
    test,
    commit,
    set_crtc,
    page_flip,
    read,
    master
  };

  /// `crtcs` pipes with a primary and a cursor plane each. Connectors can be fed by every pipe.
  explicit FakeKmsDevice(int crtcs = 2, bool atomic = true);

  // ---- the room
  DrmId add_connector(const std::string& name);
  void plug(const std::string& name, std::vector<DrmMode> modes);
  void unplug(const std::string& name);
  [[nodiscard]] DrmConnector& connector(const std::string& name);
  /// From now on there is no primary plane.
  void remove_primary_planes();
  /// From now on the driver has none.
  void remove_dumb_buffers() { card_.dumb = false; }
  /// Another program is master, or nobody.
  void take_master(bool by_another) {
    another_master_ = by_another;
    if (by_another) master_ = false;
  }
  /// The kernel's console shows this mode on the connector, as at boot.
  void show_console(const std::string& name, const DrmMode& mode);

  // ---- faults
  /// The next `times` calls of this kind fail, after `first` that do not.
  void fail_next(Call call, int code, int times = 1, int first = 0);
  /// Called before every call: to unplug between two of them.
  std::function<void(Call)> before;
  bool flips_come = true;  ///< false: flips are done but never reported
  /// Reports all flips that were held back.
  void report_held();

  // ---- what the panel shows
  struct Panel {
    bool active = false;  ///< lit: a mode is set and on
    DrmMode mode;
    DrmId framebuffer = 0, connector = 0;
    bool dpms_on = true;
  };
  [[nodiscard]] Panel panel(const std::string& connector) const;
  /// Bytes of a framebuffer on a dumb buffer, with its pitch; null: not one.
  [[nodiscard]] const std::uint8_t* pixels(DrmId framebuffer, std::uint32_t& pitch) const;
  /// Value of a property of the pipe of a connector ("GAMMA_LUT"), its plane ("FB_ID"), or the connector itself.
  [[nodiscard]] std::uint64_t value(DrmId object, const std::string& name) const;
  void set_value(DrmId object, const std::string& name, std::uint64_t value) { objects_[object][name] = value; }
  [[nodiscard]] DrmId plane_of(DrmId crtc, DrmPlaneType type) const;
  [[nodiscard]] const std::vector<DrmId>& crtcs() const { return crtcs_; }

  // ---- counts
  [[nodiscard]] int calls(Call call) const;
  [[nodiscard]] std::size_t framebuffers() const { return framebuffers_.size(); }
  [[nodiscard]] std::size_t dumb_buffers() const { return dumb_.size(); }
  [[nodiscard]] std::size_t blobs() const { return blobs_.size(); }
  [[nodiscard]] std::size_t mapped() const { return mapped_; }
  [[nodiscard]] bool master() const { return master_; }

  // ---- KmsDevice
  [[nodiscard]] const DrmCard& card() const override { return card_; }
  [[nodiscard]] int fd() const override { return -1; }
  [[nodiscard]] DrmResult<DrmResources> resources() override;
  [[nodiscard]] DrmResult<DrmConnector> probe_connector(DrmId id) override;
  [[nodiscard]] DrmResult<std::vector<DrmPlane>> planes() override;
  [[nodiscard]] DrmResult<std::vector<DrmProperty>> properties(DrmId object, DrmObject kind) override;
  [[nodiscard]] DrmResult<DrmPipeState> pipe_state(DrmId crtc) override;
  [[nodiscard]] DrmResult<DrmId> create_mode_blob(const DrmMode& mode) override;
  void destroy_blob(DrmId id) override { blobs_.erase(id); }
  [[nodiscard]] DrmResult<DrmId> add_framebuffer(const DrmFramebuffer& framebuffer) override;
  void remove_framebuffer(DrmId id) override;
  [[nodiscard]] DrmResult<DrmDumb> create_dumb(std::array<int, 2> size_px) override;
  [[nodiscard]] DrmResult<std::uint8_t*> map_dumb(const DrmDumb& buffer) override;
  void unmap_dumb(const DrmDumb& buffer, std::uint8_t* mapped) override;
  void destroy_dumb(const DrmDumb& buffer) override { dumb_.erase(buffer.handle); }
  [[nodiscard]] DrmResult<void> commit(const std::vector<DrmSetting>& settings, const DrmCommit& how) override;
  [[nodiscard]] DrmResult<void> set_crtc(DrmId crtc, DrmId framebuffer, std::array<int, 2> from, DrmId connector,
                                         const DrmMode* mode) override;
  [[nodiscard]] DrmResult<void> page_flip(DrmId crtc, DrmId framebuffer, std::uint32_t cookie) override;
  [[nodiscard]] DrmResult<void> set_connector_property(DrmId connector, DrmId property, std::uint64_t value) override;
  [[nodiscard]] DrmResult<std::vector<DrmFlip>> read_flips(int timeout_ms) override;
  [[nodiscard]] DrmResult<void> set_master() override;
  void drop_master() override { master_ = false; }

 private:
  using Values = std::map<std::string, std::uint64_t>;
  using Objects = std::map<DrmId, Values>;

  [[nodiscard]] int fault(Call call);
  [[nodiscard]] DrmId property_id(DrmId object, const std::string& name);
  [[nodiscard]] int apply(const std::vector<DrmSetting>& settings, Objects& objects) const;
  [[nodiscard]] int check(const Objects& objects, bool allow_modeset) const;
  void flip_done(DrmId crtc, std::uint32_t cookie);

  DrmCard card_;
  std::vector<DrmId> crtcs_;
  std::vector<DrmConnector> connectors_;
  std::vector<DrmPlane> planes_;
  Objects objects_;
  std::map<DrmId, std::pair<DrmId, std::string>> property_names_;
  std::map<std::pair<DrmId, std::string>, DrmId> property_ids_;
  std::map<DrmId, DrmMode> blobs_;
  std::map<DrmId, DrmMode> modes_;  ///< of blobs that were ever set: the kernel keeps its own hold
  std::map<DrmId, DrmFramebuffer> framebuffers_;
  std::map<std::uint32_t, std::vector<std::uint8_t>> dumb_;
  std::size_t mapped_ = 0;
  std::map<DrmId, std::uint32_t> pending_;  ///< cookie by pipe
  std::deque<DrmFlip> events_, held_;
  std::map<Call, std::deque<int>> faults_;
  std::map<Call, int> calls_;
  bool master_ = true, another_master_ = false;
  DrmId next_ = 1000;
  std::uint64_t clock_us_ = 1'000'000;
};

}  // namespace lackwerk::kiosk

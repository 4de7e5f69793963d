// Adds up frames into one still picture.
//
// Why it exists: the mean of many frames is smoother than any of them, but a running sum in half floats stalls: after
// some hundred frames a new one is smaller than the last bit. Sums of 16 frames are kept apart and added up in turn, so
// that no sum has more than 16 terms of like size (up to 16 * 16 = 256 frames). Where a driver has no half-float
// targets, the frames are 8-bit pictures whose display transform is undone on the CPU and summed there in floats:
// slower, the same picture but for highlights beyond 70 times white. Owns GL objects; destroy it while its context is
// current; one GL thread.
#pragma once

#include <optional>
#include <vector>

#include "render_gles/framebuffer.hpp"
#include "render_gles/screen_pass.hpp"

namespace lackwerk::gles {

class Accumulator {
 public:
  static constexpr int group_size = 16;
  static constexpr int max_frames = group_size * group_size;

  /// For pictures of this size. Error: no framebuffer of that size. `allow_half` false takes the CPU's way.
  [[nodiscard]] static Result<Accumulator> create(const Context& context, int width, int height,
                                                  bool allow_half = true);

  /// Forgets all frames.
  void reset();
  /// Where the next frame is drawn: scene-linear (times exposure) if linear(), else as displayed and dithered.
  [[nodiscard]] const Framebuffer& frame() const { return frame_; }
  [[nodiscard]] bool linear() const { return total_.has_value(); }
  /// Adds what was drawn into frame(). At most max_frames times.
  void add(const ScreenPass& screen);
  /// Adds what was drawn into frame() to the frame before: one picture drawn in several passes of light.
  void add_to_last(const ScreenPass& screen);
  [[nodiscard]] int count() const { return count_; }
  /// Shows the mean in `target`, weighed by `alpha` in (0, 1] against what is there. Needs count() > 0.
  void show(const ScreenPass& screen, const Framebuffer& target, bool dither, float alpha);
  [[nodiscard]] std::size_t bytes() const;

 private:
  explicit Accumulator(const GlApi& gl, Framebuffer frame) : gl_(&gl), frame_(std::move(frame)) {}
  void show_bytes(const ScreenPass& screen, const Framebuffer& target, float alpha);

  const GlApi* gl_;
  Framebuffer frame_;
  std::optional<Framebuffer> group_, total_;
  int count_ = 0, in_group_ = 0;
  std::vector<float> sum_;  ///< of the CPU's way, rows from top to bottom
  GlObject upload_;         ///< its picture, to be shown
};

}  // namespace lackwerk::gles

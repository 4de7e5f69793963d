// The picture on the kiosk's framebuffer: moving at a held frame time, then still, then left alone.
//
// Why it exists: "nothing changes, nothing is drawn" and "the switch between moving and still is invisible" are decided
// here and nowhere else, for the live kiosk and for recordings alike. Refers to a stage and draws with its renderer;
// one GL thread, the stage's context current.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "kiosk/display/framing.hpp"
#include "kiosk/display/scan_picture.hpp"
#include "kiosk/display/stage.hpp"
#include "kiosk/display/state.hpp"
#include "render_gles/governor.hpp"

namespace lackwerk::kiosk {

struct PictureSettings {
  std::string quality = "auto";           ///< a rung of gles::quality_ladder, or auto
  int frame_ms = 62;                      ///< what auto holds
  int still_frames = gles::still_frames;  ///< 0: a picture that does not change is left as it moved
  KeepFree keep_free = KeepFree::nothing;
  std::string quality_table = {};  ///< file that `costs` are from (quality_table.hpp); empty: built in
  gles::RungCosts costs = gles::RungCosts::built_in();  ///< what auto goes by
};

class Picture {
 public:
  Picture(Stage& stage, const PictureSettings& settings);

  /// Realises the weights and compiles what the first frame needs. Error: weights refused.
  [[nodiscard]] Result<void> prepare(const State& state);

  enum class Step {
    nothing,  ///< the framebuffer has not changed
    drawn,    ///< it holds a new moving frame
    refined,  ///< it holds a better still frame
  };
  /// Draws what `state` shows if it differs from what is on the framebuffer, else improves that. `weights_changed`:
  /// since the last call. Error: weights refused, no memory for a still picture.
  [[nodiscard]] Result<Step> step(const State& state, bool weights_changed);

  /// Whether step() would draw a moving frame although the weights are the same: the view has changed, or the
  /// framebuffer is another one.
  [[nodiscard]] bool differs(const State& state) const;
  /// Nothing changes and nothing can be improved.
  [[nodiscard]] bool resting() const { return resting_; }
  /// Draw again although nothing has changed: the framebuffer is a new one.
  void lost() { resting_ = false; }
  /// A still picture at once, `samples` a pixel.
  [[nodiscard]] gles::Image still(const State& state, int samples);

  [[nodiscard]] std::string quality() const;
  /// What a moving frame takes now: the governor's median, or the median of all frames of a fixed rung; 0 before any.
  [[nodiscard]] double frame_period_ms() const;
  [[nodiscard]] std::uint64_t drawn() const { return drawn_; }
  [[nodiscard]] std::uint64_t refined() const { return refined_; }
  [[nodiscard]] double drawn_ms_median() const;
  [[nodiscard]] double realise_ms_median() const;

 private:
  [[nodiscard]] gles::View view(const State& state) const;
  [[nodiscard]] gles::Lighting lighting(const State& state) const;
  [[nodiscard]] Result<Step> rest(const State& state);
  [[nodiscard]] Step step_scans(const State& state);

  /// The last times of something: a kiosk runs for months.
  class Times {
   public:
    void add(double ms);
    [[nodiscard]] double last() const { return last_; }
    [[nodiscard]] double median() const;

   private:
    static constexpr std::size_t kept = 512;
    std::vector<double> ms_;
    std::size_t next_ = 0;
    double last_ = 0.0;
  };

  Stage& stage_;
  PictureSettings settings_;
  gles::Governor governor_;
  ScanPicture scans_;
  const gles::Rung* fixed_ = nullptr;
  gles::Quality quality_;  ///< of the frame on the framebuffer
  bool resting_ = false;
  /// Of a still picture's frame. The first one is drawn as if it took as long as the least machines take.
  int strips_ = gles::Renderer::max_strips / 2;
  double still_frame_ms_ = 0.0;  ///< that the frame under way has taken so far
  std::uint64_t drawn_ = 0, refined_ = 0;
  Times drawn_ms_, realise_ms_;
};

}  // namespace lackwerk::kiosk

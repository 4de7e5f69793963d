// The picture of scans on the kiosk's framebuffer: as many points as the frame time allows while anything moves, all of
// them once it rests.
//
// Why it exists: Picture decides when something is drawn; how a moving picture of scans keeps its frame time is another
// question than for paints, which have a ladder of qualities. Values but for the stage it is called with; one GL
// thread.
#pragma once

#include <array>
#include <cstddef>

#include "kiosk/display/stage.hpp"
#include "kiosk/display/state.hpp"

namespace lackwerk::kiosk {

/// How many points a moving frame may have, from what frames took.
///
/// A frame costs about as much as its points. Three frames in a row that are too slow make the next ones cheaper by
/// what they are too slow; when frames are quick enough for half as many points again, they get them, but after a
/// setback not before twice as many frames as the last time: no swinging to and fro.
class PointBudget {
 public:
  /// `frame_ms`: what moving frames are to take, > 0; `most`: all points there may be, > 0.
  PointBudget(double frame_ms, std::size_t most);
  [[nodiscard]] std::size_t points() const { return points_; }
  /// A moving frame of `drawn` points took `ms`.
  void measured(double ms, std::size_t drawn);
  [[nodiscard]] int changes() const { return changes_; }

 private:
  void set(double points);
  double frame_ms_;
  std::size_t most_, points_;
  int slow_ = 0, quick_ = 0, changes_ = 0;
  int patience_;
};

class ScanPicture {
 public:
  explicit ScanPicture(double frame_ms);

  /// Whether what `state` shows is not on the framebuffer, with few points or all.
  [[nodiscard]] bool differs(Stage& stage, const State& state, const gles::View& view) const;
  /// Draws a moving frame and waits for it.
  void draw(Stage& stage, const State& state, const gles::View& view);
  /// Draws all points where the last frame had fewer. True: it has been drawn.
  [[nodiscard]] bool complete(Stage& stage, const State& state, const gles::View& view);
  [[nodiscard]] const PointBudget& budget() const { return budget_; }

 private:
  [[nodiscard]] static double time_of(Stage& stage, const State& state);
  PointBudget budget_;
  gles::ScanLook look_;  ///< of the frame on the framebuffer
};

}  // namespace lackwerk::kiosk

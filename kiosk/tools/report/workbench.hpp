// What the parts of a report measure on, and with how much patience: captures, a pack and a car, each made when first
// asked for.
//
// Why it exists: every knob is to be judged on the same paints, made on the user's own machine from the recipes that
// come with the program, with no file to fetch; and making them takes longer than most measurements. Owns what it
// makes; one thread.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "packs/scene.hpp"
#include "packs/tools/capture.hpp"
#include "packs/tools/pack_builder.hpp"

namespace lackwerk::report {

class Workbench {
 public:
  /// `quick`: the whole report in at most 60 s instead of 15 minutes on two cores.
  explicit Workbench(bool quick) : quick_(quick) {}

  [[nodiscard]] bool quick() const { return quick_; }
  /// Texels an edge of the captures' slices: 480, quick 240.
  [[nodiscard]] std::uint32_t edge_texels() const { return quick_ ? 240 : 480; }
  /// `full` or `quick`, as the patience is: for counts.
  template <class T>
  [[nodiscard]] T choose(T full, T quick) const {
    return quick_ ? quick : full;
  }

  /// The demo's three paints from the virtual goniometer: Polaris Silber, Ford F8, the green-violet pearl. Error: a
  /// recipe cannot be found.
  [[nodiscard]] Result<const std::vector<packs::Capture>*> captures();
  /// The pack of these, with the default settings.
  [[nodiscard]] Result<const packs::BuiltPack*> pack();
  /// The built-in car in its studio, baked.
  [[nodiscard]] Result<const packs::Scene*> car();

  /// The same thing again and again until `budget_ms` is used up, at least `least` times (after one run that does not
  /// count) and at most `most`. The budget is for full reports; quick ones take a quarter of it.
  [[nodiscard]] Timing time(const std::function<void()>& run, double budget_ms = 400.0, int least = 3,
                            int most = 1000) const;

  /// Called by long parts with the fraction of themselves that is done.
  void progress(double fraction) const {
    if (on_progress) on_progress(fraction);
  }
  std::function<void(double fraction)> on_progress;

 private:
  bool quick_;
  std::optional<std::vector<packs::Capture>> captures_;
  std::optional<packs::BuiltPack> pack_;
  std::optional<packs::Scene> car_;
};

/// Median and quartiles of times in ms.
[[nodiscard]] Timing timing_of(std::vector<double> ms);

/// Mean, 95th percentile (nearest rank: of few errors the largest) and worst of `errors` into a setting. Empty: nothing
/// is set.
void set_errors(Setting& setting, std::vector<double> errors);

/// "0.0123", "4.56", "123": three digits that say something.
[[nodiscard]] std::string digits(double value);

}  // namespace lackwerk::report

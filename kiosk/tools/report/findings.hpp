// What `lackwerk report` finds: error against run time for every knob, stiff cases, speeds. Values only.
//
// Why it exists: the parts that measure, the page that shows and the tests that judge share these words. Plain values;
// any thread.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace lackwerk::report {

/// Not measured, or not a number that makes sense here; written as null.
inline constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Wall time of one thing done `count` times.
struct Timing {
  double median_ms = none;
  double low_ms = none, high_ms = none;  ///< quartiles
  int count = 0;
};

/// One way to set a knob.
struct Setting {
  std::string label;     ///< "50"; unique within its knob
  double value = none;   ///< the same as a number, where the knob has a scale
  std::string line;      ///< curve it lies on: "misfit rule"; settings of one line are joined as they come
  Timing time;           ///< of what Knob::time_of says
  double error = none;   ///< mean, in Knob::error_unit
  double p95 = none;     ///< of the same error
  double worst = none;   ///< of the same error
  double bytes = none;   ///< that it costs, of what Knob::bytes_of says
  bool eligible = true;  ///< false: measured for the record; it cannot be chosen and is no part of the front
  std::string note;      ///< what is to be said of this one alone
};

/// One approximation, all ways it can be set, and which is the default.
struct Knob {
  std::string id;          ///< "clusters": stable, for machines
  std::string title;       ///< "Clusters a slice"
  std::string what;        ///< one or two sentences: what is turned, on which input
  std::string error_unit;  ///< "1-Wasserstein distance, Lab"
  std::string time_of;     ///< "clustering one slice of 480 x 480 texels"
  std::string bytes_of;    ///< empty where no setting has bytes
  std::string chosen;      ///< label of the default; one of the settings
  std::string why;         ///< why that is the default, in the figures measured here
  std::vector<Setting> settings;
};

/// One stiff case of one kernel against its reference.
struct StiffCase {
  std::string kernel;   ///< "transport"
  std::string name;     ///< "one mass of 0.99"
  std::string measure;  ///< of worst and bound: "relative objective gap"
  double worst = none;  ///< NaN fails
  double bound = 0.0;   ///< the fixed bound that tests hold it to
  std::string where;    ///< where the worst was, and what is to be said
  [[nodiscard]] bool passed() const { return worst <= bound; }
};

/// One speed against its aim.
struct Speed {
  std::string id;         ///< "octree"
  std::string what;       ///< "clustering 480 x 480 texels, one core"
  double value = none;    ///< median, in `unit`
  std::string unit;       ///< "million texels/s", "ms", "ratio"
  double aim = none;      ///< none: for the record
  bool at_least = false;  ///< the aim is a floor, else a ceiling
  int count = 0;          ///< of measurements behind the median
  std::string bound_by;   ///< what bounds it
  [[nodiscard]] bool reached() const { return !(aim == aim) || (at_least ? value >= aim : value <= aim); }
};

struct Findings {
  std::vector<Knob> knobs;
  std::vector<StiffCase> stiff;
  std::vector<Speed> speeds;
};

}  // namespace lackwerk::report

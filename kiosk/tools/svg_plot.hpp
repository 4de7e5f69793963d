// Line plots as SVG text.
//
// Why it exists: measurements are judged as curves, in any browser, without a plotting program. A pure function over
// values; any thread.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lackwerk::tools {

struct PlotLine {
  std::string label;
  std::vector<std::pair<double, double>> points;
  const char* colour = "#000000";
  bool marks = false;  ///< dots at the points, for few of them
};

/// One panel: both axes from 0 to their end with five grid lines; points outside are drawn at the border.
struct Plot {
  std::string title, x_label, y_label;
  double x_end = 1.0, y_end = 1.0;  ///< above 0
  std::vector<PlotLine> lines;
};

/// Panels side by side, each 480 by 400 units, with a legend below; labels in any text (escaped
/// here).
[[nodiscard]] std::string svg_text(const std::vector<Plot>& panels);

}  // namespace lackwerk::tools

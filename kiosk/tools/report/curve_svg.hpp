// A knob's error-against-time curve as SVG text.
//
// Why it exists: a default is judged by where it lies between its neighbours, and that is seen, not read. Axes are
// logarithmic where figures span more than a decade, with zeros on a shelf of their own at the lower end; quartiles of
// the time are whiskers, the Pareto front a stepped line, the default a ring. Pure function; any thread.
#pragma once

#include <string>

#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

enum class Price { time, bytes };

/// Empty if fewer than two settings have both an error and that price.
[[nodiscard]] std::string curve_svg(const Knob& knob, Price price);

/// `text` for HTML and SVG: the five characters that mean something there are escaped, control characters are spaces.
[[nodiscard]] std::string markup_escaped(const std::string& text);

}  // namespace lackwerk::report

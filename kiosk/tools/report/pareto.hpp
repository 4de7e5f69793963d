// Which settings of a knob nothing beats: the Pareto front over time and error.
//
// Why it exists: "better" means faster at no more error, or less error in no more time; what is neither is off the
// table. The page, the JSON and the tests ask the same function. Pure; any thread.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

/// Indices of the eligible settings with a time and an error that no other such setting equals or betters in both (of
/// two equal ones the first stays), from the fastest to the slowest.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const Setting> settings);

/// The same over bytes and error, for knobs whose price is memory.
[[nodiscard]] std::vector<std::size_t> pareto_front_of_bytes(std::span<const Setting> settings);

}  // namespace lackwerk::report

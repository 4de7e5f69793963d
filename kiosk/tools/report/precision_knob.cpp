#include "kiosk/tools/report/precision_knob.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "kiosk/tools/report/stiff_model.hpp"

namespace lackwerk::report {

namespace {

struct Named {
  ModelPrecision precision;
  const char* label;
  double bits;
};

constexpr std::array<Named, 4> precisions = {{{ModelPrecision::long_double, "long double", 64.0},
                                              {ModelPrecision::double_float, "double", 53.0},
                                              {ModelPrecision::single_float, "float", 24.0},
                                              {ModelPrecision::half, "16 bits, emulated", 11.0}}};
/// Where 16 bits are judged: see stiff_model.cpp.
constexpr double judged_deg = 89.79;
constexpr int evaluations = 1000;

}  // namespace

Result<void> add_precision(Workbench& bench, Findings& findings) {
  const auto paints = published_paints();
  if (!paints) return tl::unexpected(paints.error());
  const std::vector<DirectionPair> pairs = direction_pairs(judged_deg, bench.quick());
  Knob knob;
  knob.id = "precision";
  knob.title = "Precision of the paint model";
  knob.what = "The model's one text over " + std::to_string(paints->size()) +
              " published paints, as printed and below a coat, at " + std::to_string(pairs.size()) +
              " pairs of directions up to 89.79 degrees, against itself in long double.";
  knob.error_unit = "CIEDE2000, mean";
  knob.time_of = std::to_string(evaluations) + " evaluations on one core";
  knob.chosen = "float";
  for (const Named& named : precisions) {
    Setting setting;
    setting.label = named.label;
    setting.value = named.bits;
    setting.line = "bits of the mantissa";
    std::vector<double> errors;
    errors.reserve(paints->size() * pairs.size());
    for (const auto& [name, paint] : *paints)
      for (const DirectionPair& at : pairs)
        errors.push_back(shown_difference(model_factor(paint, at, named.precision),
                                          model_factor(paint, at, ModelPrecision::long_double), at.light.z));
    set_errors(setting, std::move(errors));
    glm::dvec3 sum(0.0);
    setting.time = bench.time(
        [&] {
          for (std::size_t k = 0; k < evaluations; ++k)
            sum += model_factor((*paints)[k % paints->size()].second, pairs[k % pairs.size()], named.precision);
        },
        100.0, 3, 200);
    setting.eligible = named.precision != ModelPrecision::half && std::isfinite(sum.x);
    if (named.precision == ModelPrecision::half)
      setting.note = "the time is the emulation's; GPUs without highp compute so, faster than in 32 bits";
    knob.settings.push_back(std::move(setting));
  }
  knob.why = "Fragment shaders take highp where the GPU has it: float is " + digits(knob.settings[2].error) +
             " off in the mean, " + digits(knob.settings[2].worst) + " at worst. With 16 bits alone the mean is " +
             digits(knob.settings[3].error) + " and p95 " + digits(knob.settings[3].p95) +
             ", for the text keeps what leaves their range in logarithms.";
  findings.knobs.push_back(std::move(knob));
  return {};
}

}  // namespace lackwerk::report

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "core/analysis/interpolation.hpp"
#include "core/rank_table.hpp"
#include "kiosk/tools/report/flake_knobs.hpp"
#include "kiosk/tools/report/flake_knobs_slices.hpp"

namespace lackwerk::report {

namespace {

using Probabilities = std::vector<double>;
using Row = std::span<const std::uint32_t>;

constexpr std::size_t draws = 1'000'000;

/// One way from a random number to a tuple, for one row: how likely each tuple then is, and a drawer.
struct Way {
  Probabilities drawn;
  std::function<int(double u)> draw;
};

/// Golla & Klein (2018), 3.2: the inverse CDF at even steps, the nearest one read. Step k stands for u = (k + 1/2) / n,
/// the middle of what reads it, which is the most favourable reading of the paper.
Way even_steps(Row mass, std::uint32_t row_mass, std::size_t steps) {
  std::vector<std::uint8_t> table(steps);
  Way out;
  out.drawn.assign(mass.size(), 0.0);
  std::size_t tuple = 0;
  std::uint64_t below = mass.empty() ? 0 : mass[0];  // mass up to and with `tuple`
  for (std::size_t k = 0; k < steps; ++k) {
    const double u = (static_cast<double>(k) + 0.5) / static_cast<double>(steps);
    while (tuple + 1 < mass.size() && u * row_mass >= static_cast<double>(below)) below += mass[++tuple];
    table[k] = static_cast<std::uint8_t>(tuple);
    out.drawn[tuple] += 1.0 / static_cast<double>(steps);
  }
  out.draw = [table = std::move(table)](double u) {
    return static_cast<int>(table[static_cast<std::size_t>(u * static_cast<double>(table.size()))]);
  };
  return out;
}

/// The shipped table: mass between thresholds on the warped axis, u = 1 - (1 - v)^2.
Way warped(std::span<const core::RankStep> table, std::size_t tuples) {
  Way out;
  out.drawn.assign(tuples, 0.0);
  for (std::size_t step = 0; step < table.size(); ++step) {
    const core::RankStep& entry = table[step];
    std::array<double, 5> cuts = {0.0, entry.t1 / 255.0, entry.t2 / 255.0, entry.t3 / 255.0, 1.0};
    for (std::size_t part = 0; part + 1 < cuts.size(); ++part) {
      const double from = 1.0 - (static_cast<double>(step) + cuts[part]) / core::rank_table_steps;
      const double to = 1.0 - (static_cast<double>(step) + cuts[part + 1]) / core::rank_table_steps;
      if (from > to) out.drawn[entry.first + part] += (from - to) * (from + to);
    }
  }
  out.draw = [row = table.data()](double u) { return core::tuple_of_rank(row, 1.0 - std::sqrt(1.0 - u)); };
  return out;
}

/// Walker (1977) with Vose's construction (1991): column k gives itself with `keep`, else its alias.
Way alias_table(Row mass, std::uint32_t row_mass) {
  struct Column {
    float keep = 1.0f;
    std::uint8_t alias = 0;
  };
  const std::size_t n = mass.size();
  std::vector<Column> table(n);
  std::vector<double> share(n);
  std::vector<std::size_t> small, large;
  small.reserve(n);
  large.reserve(n);
  for (std::size_t k = 0; k < n; ++k) {
    share[k] = static_cast<double>(mass[k]) * static_cast<double>(n) / row_mass;
    table[k].alias = static_cast<std::uint8_t>(k);
    (share[k] < 1.0 ? small : large).push_back(k);
  }
  while (!small.empty() && !large.empty()) {
    const std::size_t less = small.back(), more = large.back();
    small.pop_back();
    table[less] = {static_cast<float>(share[less]), static_cast<std::uint8_t>(more)};
    share[more] -= 1.0 - share[less];
    if (share[more] < 1.0) {
      large.pop_back();
      small.push_back(more);
    }
  }
  Way out;
  out.drawn.assign(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    out.drawn[k] += double{table[k].keep} / static_cast<double>(n);
    out.drawn[table[k].alias] += (1.0 - double{table[k].keep}) / static_cast<double>(n);
  }
  out.draw = [table = std::move(table)](double u) {
    const double scaled = u * static_cast<double>(table.size());
    const auto column = static_cast<std::size_t>(scaled);
    const bool stays = scaled - static_cast<double>(column) < double{table[column].keep};
    return stays ? static_cast<int>(column) : int{table[column].alias};
  };
  return out;
}

/// What is asked of every row of the pack, for one way.
class Judgement {
 public:
  void add(Row mass, std::uint32_t row_mass, const Probabilities& drawn) {
    double apart = 0.0;
    for (std::size_t t = 0; t < mass.size(); ++t) {
      apart += 0.5 * std::abs(drawn[t] - static_cast<double>(mass[t]) / row_mass);
      ++tuples_;
      if (mass[t] > 0 && drawn[t] < 1e-12) ++never_;  // rounding of differences of squares is 1e-16
    }
    errors_.push_back(apart);
  }
  void give(Setting& setting) {
    never_share_ = tuples_ > 0 ? static_cast<double>(never_) / static_cast<double>(tuples_) : 0.0;
    set_errors(setting, std::move(errors_));
    setting.note = digits(100.0 * never_share_) + " % of all tuples never come";
  }
  [[nodiscard]] double never_percent() const { return 100.0 * never_share_; }

 private:
  std::vector<double> errors_;
  std::size_t tuples_ = 0, never_ = 0;
  double never_share_ = 0.0;
};

/// Time of a million draws from the row with most tuples.
Timing draw_time(const Workbench& bench, const Way& way) {
  std::vector<double> numbers(4096);
  for (std::size_t k = 0; k < numbers.size(); ++k) {  // a golden-ratio walk: even, and no row is read in order
    const double walk = static_cast<double>(k) * 0.6180339887498949;
    numbers[k] = walk - std::floor(walk);
  }
  std::uint64_t sum = 0;
  const Timing time = bench.time(
      [&] {
        for (std::size_t k = 0; k < draws; ++k) sum += static_cast<std::uint64_t>(way.draw(numbers[k & 4095]));
      },
      100.0, 3, 20);
  return sum > 0 ? time : Timing{};
}

using MakeWay = std::function<Way(std::size_t row, Row mass)>;

Setting measure(const Workbench& bench, const core::InterpolatablePaint& paint, const MakeWay& make, Judgement& judge) {
  Setting out;
  std::size_t widest = 0;
  const auto mass_of = [&](std::size_t row) {
    return paint.mass.subspan(paint.tuple_begin[row], paint.tuple_begin[row + 1] - paint.tuple_begin[row]);
  };
  const auto rows = static_cast<std::size_t>(paint.row_count());
  for (std::size_t row = 0; row < rows; ++row) {
    const Row mass = mass_of(row);
    if (mass.size() > mass_of(widest).size()) widest = row;
    judge.add(mass, paint.row_mass, make(row, mass).drawn);
  }
  judge.give(out);
  out.time = draw_time(bench, make(widest, mass_of(widest)));
  return out;
}

}  // namespace

Result<void> add_flake_ranks(Workbench& bench, Findings& findings) {
  const auto pack = bench.pack();
  if (!pack) return tl::unexpected(pack.error());
  const core::InterpolatablePaint paint = (*pack)->data.view();
  const std::vector<core::RankStep> table = core::build_rank_table(paint);
  std::size_t widest = 0;
  for (std::size_t row = 0; row + 1 < paint.tuple_begin.size(); ++row)
    widest = std::max<std::size_t>(widest, paint.tuple_begin[row + 1] - paint.tuple_begin[row]);

  Knob knob;
  knob.id = "ranks";
  knob.title = "From a random number to a tuple";
  knob.what = "Tables that draw a tuple by its probability, over all " + std::to_string(paint.row_count()) +
              " rows (slices and mip levels) of the three paints' pack, up to " + std::to_string(widest) +
              " tuples a row.";
  knob.error_unit = "total variation distance of tuples drawn from their masses";
  knob.time_of = "drawing 1 million tuples on the CPU";
  knob.bytes_of = "one row";
  knob.chosen = "warped 256";
  double even_500 = none, never_500 = none;
  for (const std::size_t steps : {32u, 64u, 128u, 256u, 500u, 512u, 1024u}) {
    Judgement judge;
    Setting one = measure(
        bench, paint, [&](std::size_t, Row mass) { return even_steps(mass, paint.row_mass, steps); }, judge);
    one.value = static_cast<double>(steps);
    one.label = std::to_string(steps) + " even";
    one.line = "even steps (Golla & Klein 2018)";
    one.bytes = static_cast<double>(steps);
    if (steps == 500) {
      even_500 = one.error;
      never_500 = judge.never_percent();
    }
    knob.settings.push_back(std::move(one));
  }
  Judgement ours;
  Setting shipped = measure(
      bench, paint,
      [&](std::size_t row, Row mass) {
        return warped(std::span(table).subspan(row * core::rank_table_steps, core::rank_table_steps), mass.size());
      },
      ours);
  shipped.value = core::rank_table_steps;
  shipped.label = knob.chosen;
  shipped.line = "warped, with thresholds";
  shipped.bytes = sizeof(core::RankStep) * core::rank_table_steps;
  const double error = shipped.error;
  knob.settings.push_back(std::move(shipped));

  Judgement walker;
  Setting alias = measure(
      bench, paint, [&](std::size_t, Row mass) { return alias_table(mass, paint.row_mass); }, walker);
  alias.value = static_cast<double>(widest);
  alias.label = "alias";
  alias.line = "alias table (Walker 1977)";
  alias.bytes = static_cast<double>(widest) * (sizeof(float) + sizeof(std::uint8_t));
  alias.eligible = false;
  alias.note += "; it loses the order of ranks, by which neighbouring angle bins and paints are blended";
  knob.settings.push_back(std::move(alias));

  knob.why = "One fetch of 256 steps draws with an error of " + digits(error) + " (" + digits(ours.never_percent()) +
             " % of tuples never come); 500 even steps err by " + digits(even_500) + " and lose " + digits(never_500) +
             " %. An alias table is exact but forgets which tuple is the brighter one.";
  findings.knobs.push_back(std::move(knob));
  return {};
}

}  // namespace lackwerk::report

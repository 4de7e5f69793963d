#include "core/rank_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/check.hpp"

namespace lackwerk::core {

namespace {

constexpr int cells_per_step = 255;
constexpr int cells = rank_table_steps * cells_per_step;
constexpr int most_advance = 3;  ///< tuples that may begin inside one step
/// Near a step in which more tuples begin than fit, the path may leave the ideal one by this many tuples, and so many
/// steps early.
constexpr int detour = 3;
constexpr int detour_steps = 3;

/// Fits the rank table of one row: a staircase v -> tuple on a grid of 255 cells a step, rising by at most 3 inside a
/// step and by any amount between steps. The ideal staircase has tuple t over [edge_[t], edge_[t + 1]). Minimised is
/// the mass whose tuple is wrong (at least the total variation distance) plus `lost` for each tuple that never comes,
/// by dynamic programming over steps; where nothing is crowded only the ideal path is looked at.
class RowFit {
 public:
  void fit(std::span<const std::uint32_t> mass, std::uint32_t row_mass, RankStep* out);

 private:
  struct Choice {
    double begin = 0.0;        ///< cost of beginning the step with this tuple
    double end = 0.0;          ///< cost of ending the step with this tuple
    std::int16_t before = -1;  ///< tuple that ended the previous step
    std::uint8_t advance = 0;  ///< tuples begun inside the step on the way to this end
  };
  using Cuts = std::array<int, most_advance>;

  void place_edges(std::span<const std::uint32_t> mass, std::uint32_t row_mass);
  void choose_ranges();
  void begin_step(int step);
  void end_step(int step);
  void write_path(RankStep* out) const;
  double step_cost(int step, int first, int advance, Cuts& cuts) const;
  [[nodiscard]] Choice& at(int step, int tuple) {
    const auto s = static_cast<std::size_t>(step);
    return choices_[start_[s] + static_cast<std::size_t>(tuple - low_[s])];
  }
  [[nodiscard]] const Choice& at(int step, int tuple) const { return const_cast<RowFit*>(this)->at(step, tuple); }

  int tuples_ = 0;
  std::vector<double> edge_;                          ///< tuples + 1, in cells
  std::vector<double> lost_;                          ///< tuples + 1: cost of losing all tuples before this one
  std::array<int, rank_table_steps> low_{}, high_{};  ///< tuples a step may begin or end with
  std::array<std::size_t, rank_table_steps> start_{};
  std::vector<Choice> choices_;
};

/// Mass of the warped interval [from, to) in cells: u = 1 - (1 - v)^2.
double mass_between(double from, double to) {
  const double a = 1.0 - from / cells;
  const double b = 1.0 - to / cells;
  return (a - b) * (a + b);
}

void RowFit::place_edges(std::span<const std::uint32_t> mass, std::uint32_t row_mass) {
  tuples_ = static_cast<int>(mass.size());
  edge_.assign(mass.size() + 1, 0.0);
  lost_.assign(mass.size() + 1, 0.0);
  std::uint64_t rest = row_mass;
  for (std::size_t t = 0; t < mass.size(); ++t) {
    edge_[t] = cells * (1.0 - std::sqrt(static_cast<double>(rest) / row_mass));
    // A tuple is worth five times its own mass and one grid cell at the coarse end (3e-5). More, and a crowd of rare
    // bright tuples would grow into a glitter that the paint does not have.
    const double probability = static_cast<double>(mass[t]) / row_mass;
    lost_[t + 1] = lost_[t] + (mass[t] > 0 ? 4.0 * probability + 3e-5 : 0.0);
    rest -= mass[t];
  }
  check_equal(rest, std::uint64_t{0}, "masses of a row must sum to row_mass");
  edge_[mass.size()] = cells;
}

void RowFit::choose_ranges() {
  std::array<bool, rank_table_steps> crowded{};
  int tuple = 0;
  for (int step = 0; step < rank_table_steps; ++step) {
    const auto s = static_cast<std::size_t>(step);
    while (tuple + 1 < tuples_ && edge_[static_cast<std::size_t>(tuple) + 1] <= step * cells_per_step) ++tuple;
    low_[s] = tuple;
    while (tuple + 1 < tuples_ && edge_[static_cast<std::size_t>(tuple) + 1] < (step + 1) * cells_per_step) ++tuple;
    high_[s] = tuple;
    if (high_[s] - low_[s] <= most_advance) continue;
    for (int near = std::max(0, step - detour_steps); near <= std::min(rank_table_steps - 1, step + detour_steps);
         ++near)
      crowded[static_cast<std::size_t>(near)] = true;
  }
  std::size_t states = 0;
  for (std::size_t s = 0; s < rank_table_steps; ++s) {
    if (crowded[s]) {
      low_[s] = std::max(0, low_[s] - detour);
      high_[s] = std::min(tuples_ - 1, high_[s] + detour);
    }
    start_[s] = states;
    states += static_cast<std::size_t>(high_[s] - low_[s] + 1);
  }
  choices_.assign(states, Choice{});
}

/// Mass with the wrong tuple when `step` runs from tuple `first` through `advance` more, each at least a cell wide and
/// begun as near its ideal edge as that allows. `cuts` gets where they begin, in cells from the step's start.
double RowFit::step_cost(int step, int first, int advance, Cuts& cuts) const {
  const double origin = static_cast<double>(step) * cells_per_step;
  double right = 0.0;
  int from = 0;
  for (int n = 0; n <= advance; ++n) {
    const auto tuple = static_cast<std::size_t>(first) + static_cast<std::size_t>(n);
    int to = cells_per_step;
    if (n < advance) {
      const double ideal = std::clamp(edge_[tuple + 1] - origin, 0.0, double{cells_per_step});
      to = std::clamp(static_cast<int>(std::lround(ideal)), from + 1, cells_per_step - (advance - n));
      cuts[static_cast<std::size_t>(n)] = to;
    }
    const double overlap_from = std::max(origin + from, edge_[tuple]);
    const double overlap_to = std::min(origin + to, edge_[tuple + 1]);
    if (overlap_from < overlap_to) right += mass_between(overlap_from, overlap_to);
    from = to;
  }
  return mass_between(origin, origin + cells_per_step) - right;
}

/// Between steps the staircase may rise by any amount; tuples jumped over are lost.
void RowFit::begin_step(int step) {
  const auto s = static_cast<std::size_t>(step);
  double best = step == 0 ? 0.0 : std::numeric_limits<double>::infinity();  // min of end(e) - lost_[e + 1]
  int best_before = -1;
  int before = step == 0 ? 0 : low_[s - 1];
  for (int tuple = low_[s]; tuple <= high_[s]; ++tuple) {
    Choice& choice = at(step, tuple);
    const auto t = static_cast<std::size_t>(tuple);
    if (step > 0) {
      for (; before < tuple && before <= high_[s - 1]; ++before) {
        const double cost = at(step - 1, before).end - lost_[static_cast<std::size_t>(before) + 1];
        if (cost < best) {
          best = cost;
          best_before = before;
        }
      }
    }
    choice.begin = best + lost_[t];
    choice.before = static_cast<std::int16_t>(best_before);
    if (step > 0 && tuple >= low_[s - 1] && tuple <= high_[s - 1] && at(step - 1, tuple).end <= choice.begin) {
      choice.begin = at(step - 1, tuple).end;
      choice.before = static_cast<std::int16_t>(tuple);
    }
  }
}

void RowFit::end_step(int step) {
  const auto s = static_cast<std::size_t>(step);
  Cuts cuts;
  for (int tuple = low_[s]; tuple <= high_[s]; ++tuple) {
    Choice& choice = at(step, tuple);
    choice.end = std::numeric_limits<double>::infinity();
    for (int advance = 0; advance <= std::min(most_advance, tuple - low_[s]); ++advance) {
      const double begin = at(step, tuple - advance).begin;
      if (!(begin < choice.end)) continue;
      const double cost = begin + step_cost(step, tuple - advance, advance, cuts);
      if (cost < choice.end) {
        choice.end = cost;
        choice.advance = static_cast<std::uint8_t>(advance);
      }
    }
  }
}

void RowFit::write_path(RankStep* out) const {
  constexpr std::size_t last_step = rank_table_steps - 1;
  int tuple = low_[last_step];
  double best = std::numeric_limits<double>::infinity();
  for (int end = low_[last_step]; end <= high_[last_step]; ++end) {
    const double cost = at(last_step, end).end - lost_[static_cast<std::size_t>(end) + 1];
    if (cost < best) {
      best = cost;
      tuple = end;
    }
  }
  for (int step = rank_table_steps - 1; step >= 0; --step) {
    const int advance = at(step, tuple).advance;
    const int first = tuple - advance;
    Cuts cuts;
    cuts.fill(cells_per_step);
    step_cost(step, first, advance, cuts);
    out[step] = {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(cuts[0]),
                 static_cast<std::uint8_t>(cuts[1]), static_cast<std::uint8_t>(cuts[2])};
    tuple = at(step, first).before;
  }
}

void RowFit::fit(std::span<const std::uint32_t> mass, std::uint32_t row_mass, RankStep* out) {
  check_at_most(mass.size(), static_cast<std::size_t>(max_tuples_per_row), "tuples of a row");
  if (mass.empty()) {
    std::fill(out, out + rank_table_steps, RankStep{});
    return;
  }
  place_edges(mass, row_mass);
  choose_ranges();
  for (int step = 0; step < rank_table_steps; ++step) {
    begin_step(step);
    end_step(step);
  }
  write_path(out);
}

}  // namespace

std::vector<RankStep> build_rank_table(const InterpolatablePaint& paint) {
  const auto rows = static_cast<std::size_t>(paint.row_count());
  std::vector<RankStep> table(rows * rank_table_steps);
  RowFit fit;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t begin = paint.tuple_begin[row];
    fit.fit(paint.mass.subspan(begin, paint.tuple_begin[row + 1] - begin), paint.row_mass,
            table.data() + row * rank_table_steps);
  }
  return table;
}

}  // namespace lackwerk::core

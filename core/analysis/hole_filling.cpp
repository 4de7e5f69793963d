// Fills the holes of a BRDF table from their neighbours, ring by ring from the edge of what is known.
//
// A ring's cells see only what was known before it, so the order within it changes nothing. Weights fall with the
// square of the distance in the grid; means are taken of logarithms, since a highlight falls by factors, not by
// differences (Guenther et al. 2005, section 4: "weighted sum of the neighbour BRDF samples").
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "core/analysis/brdf_table.hpp"

namespace lackwerk::core {
namespace {

/// A step along theta_h counts as this many along theta_d or phi_d: a lobe falls along theta_h, while along the others
/// it changes little, so a neighbour at the same theta_h says more. With half of a metallic paint's table missing at
/// random the median error falls from 0.26 % (1) over 0.14 % (4) to 0.08 % (8) and 0.05 % (16); past 8 the worst
/// percent gets worse than 10 %.
constexpr double theta_h_step = 8.0;
/// Logarithms of nothing: values are held above this, 1/sr. A black paint reflects some 1e-2.
constexpr float darkest = 1e-7f;

enum class Cell : std::uint8_t { known, wanted, unused };

struct Neighbour {
  int h, d, p;
  double weight;
};

std::array<Neighbour, 26> neighbours() {
  std::array<Neighbour, 26> out{};
  std::size_t count = 0;
  for (int h = -1; h <= 1; ++h) {
    for (int d = -1; d <= 1; ++d) {
      for (int p = -1; p <= 1; ++p) {
        if (h == 0 && d == 0 && p == 0) continue;
        out[count++] = {h, d, p, 1.0 / (theta_h_step * theta_h_step * h * h + d * d + p * p)};
      }
    }
  }
  return out;
}

class Filler {
 public:
  explicit Filler(BrdfTable& table) : table_(table), size_(table.size()), state_(size_.cells(), Cell::unused) {
    for (std::size_t cell = 0; cell < state_.size(); ++cell) {
      if (table.value(cell)) {
        state_[cell] = Cell::known;
      } else if (is_above(directions(table.middle(cell)))) {
        state_[cell] = Cell::wanted;
      }
    }
    want_rim();
  }

  std::size_t run(std::vector<std::uint8_t>* filled) {
    if (filled != nullptr) filled->assign(state_.size(), 0);
    std::vector<std::size_t> ring;
    for (std::size_t cell = 0; cell < state_.size(); ++cell) {
      if (state_[cell] == Cell::wanted && touches_known(cell)) ring.push_back(cell);
    }
    std::size_t count = 0;
    std::vector<glm::vec3> values;
    std::vector<std::size_t> next;
    while (!ring.empty()) {
      values.clear();
      for (const std::size_t cell : ring) values.push_back(guess(cell));
      for (std::size_t k = 0; k < ring.size(); ++k) {
        table_.set(ring[k], values[k]);
        state_[ring[k]] = Cell::known;
        if (filled != nullptr) (*filled)[ring[k]] = 1;
      }
      count += ring.size();
      next.clear();
      for (const std::size_t cell : ring) {
        for_each_neighbour(cell, [&](std::size_t other, double) {
          if (state_[other] == Cell::wanted) next.push_back(other);
        });
      }
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
      ring.swap(next);
    }
    return count;
  }

 private:
  [[nodiscard]] std::size_t index(std::size_t h, std::size_t d, std::size_t p) const {
    return (h * size_.theta_d + d) * size_.phi_d + p;
  }

  template <class Visit>
  void for_each_neighbour(std::size_t cell, const Visit& visit) const {
    const auto p = static_cast<int>(cell % size_.phi_d), d = static_cast<int>(cell / size_.phi_d % size_.theta_d),
               h = static_cast<int>(cell / size_.phi_d / size_.theta_d);
    const auto count_h = static_cast<int>(size_.theta_h), count_d = static_cast<int>(size_.theta_d),
               count_p = static_cast<int>(size_.phi_d);
    for (const Neighbour& step : neighbours_) {
      const int other_h = h + step.h, other_d = d + step.d, other_p = (p + step.p + count_p) % count_p;
      if (other_h < 0 || other_h >= count_h || other_d < 0 || other_d >= count_d) continue;
      visit(index(static_cast<std::size_t>(other_h), static_cast<std::size_t>(other_d),
                  static_cast<std::size_t>(other_p)),
            step.weight);
    }
  }

  [[nodiscard]] bool touches_known(std::size_t cell) const {
    bool found = false;
    for_each_neighbour(cell, [&](std::size_t other, double) { found = found || state_[other] == Cell::known; });
    return found;
  }

  [[nodiscard]] glm::vec3 guess(std::size_t cell) const {
    glm::dvec3 sum(0.0);
    double total = 0.0;
    for_each_neighbour(cell, [&](std::size_t other, double weight) {
      if (state_[other] != Cell::known) return;
      sum += weight * glm::log(glm::dvec3(glm::max(table_.value(other).value_or(glm::vec3(0.0f)), darkest)));
      total += weight;
    });
    return glm::vec3(glm::exp(sum / total));
  }

  /// Near grazing there are directions above the horizon between eight middles that all lie below it. Both directions
  /// are above it where cos h cos d > sin h sin d |cos p|: within a block of eight that holds best at its least theta_h
  /// and theta_d, and at the phi_d nearest to 90 degrees.
  void want_rim() {
    for (std::size_t h = 0; h < size_.theta_h; ++h) {
      for (std::size_t d = 0; d < size_.theta_d; ++d) {
        for (std::size_t p = 0; p < size_.phi_d; ++p) want_block(h, d, p);
      }
    }
    for (const std::size_t cell : rim_) state_[cell] = Cell::wanted;
  }

  void want_block(std::size_t h, std::size_t d, std::size_t p) {
    const std::size_t upper_h = std::min<std::size_t>(h + 1, size_.theta_h - 1),
                      upper_d = std::min<std::size_t>(d + 1, size_.theta_d - 1), upper_p = (p + 1) % size_.phi_d;
    std::array<std::size_t, 8> block{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      block[corner] =
          index((corner & 1u) != 0 ? upper_h : h, (corner & 2u) != 0 ? upper_d : d, (corner & 4u) != 0 ? upper_p : p);
      if (state_[block[corner]] != Cell::unused) return;
    }
    const HalfAngles least = table_.middle(block[0]), other = table_.middle(block[4]);
    const bool straddles = (std::cos(least.phi_d) > 0.0) != (std::cos(other.phi_d) > 0.0) && upper_p > p;
    const double cos_p = straddles ? 0.0 : std::min(std::abs(std::cos(least.phi_d)), std::abs(std::cos(other.phi_d)));
    if (std::cos(least.theta_h) * std::cos(least.theta_d) <= std::sin(least.theta_h) * std::sin(least.theta_d) * cos_p)
      return;
    for (const std::size_t cell : block) rim_.push_back(cell);
  }

  BrdfTable& table_;
  const BrdfTableSize size_;
  std::vector<Cell> state_;
  std::vector<std::size_t> rim_;
  const std::array<Neighbour, 26> neighbours_ = neighbours();
};

}  // namespace

std::size_t fill_holes(BrdfTable& table, std::vector<std::uint8_t>* filled) { return Filler(table).run(filled); }

}  // namespace lackwerk::core

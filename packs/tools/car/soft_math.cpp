#include "packs/tools/car/soft_math.hpp"

#include <cstddef>
#include <stdexcept>

namespace lackwerk::packs::car {

SoftProfile::SoftProfile(const std::vector<ProfileKnot>& knots) {
  if (knots.size() < 2) throw std::invalid_argument("SoftProfile: a profile needs at least two knots");
  double previous_slope = 0.0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    if (!(knots[i + 1].at > knots[i].at)) throw std::invalid_argument("SoftProfile: knots must rise");
    const double slope = (knots[i + 1].value - knots[i].value) / (knots[i + 1].at - knots[i].at);
    if (i == 0) {
      slope_ = slope;
      offset_ = knots[0].value - slope * knots[0].at;
    } else {
      corners_.push_back({knots[i].at, slope - previous_slope, knots[i].rounding});
    }
    previous_slope = slope;
  }
}

}  // namespace lackwerk::packs::car

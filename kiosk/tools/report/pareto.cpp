#include "kiosk/tools/report/pareto.hpp"

#include <algorithm>
#include <cmath>

namespace lackwerk::report {
namespace {

template <class PriceOf>
std::vector<std::size_t> front_by(std::span<const Setting> settings, PriceOf price_of) {
  std::vector<std::size_t> order;
  order.reserve(settings.size());
  for (std::size_t k = 0; k < settings.size(); ++k)
    if (settings[k].eligible && std::isfinite(price_of(settings[k])) && std::isfinite(settings[k].error))
      order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t one, std::size_t two) {
    const double a = price_of(settings[one]), b = price_of(settings[two]);
    return a != b ? a < b : settings[one].error < settings[two].error;
  });
  std::vector<std::size_t> front;
  for (const std::size_t k : order)
    if (front.empty() || settings[k].error < settings[front.back()].error) front.push_back(k);
  return front;
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const Setting> settings) {
  return front_by(settings, [](const Setting& setting) { return setting.time.median_ms; });
}

std::vector<std::size_t> pareto_front_of_bytes(std::span<const Setting> settings) {
  return front_by(settings, [](const Setting& setting) { return setting.bytes; });
}

}  // namespace lackwerk::report

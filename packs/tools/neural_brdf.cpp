#include "packs/tools/neural_brdf.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "core/analysis/brdf_table.hpp"
#include "packs/tools/whole_file.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::uintmax_t max_bytes = 4u << 20;  ///< the published twelve paints have 0.2 MB

/// y = x W + b.
template <std::size_t In, std::size_t Out>
std::array<double, Out> layer(const std::array<double, In>& x, const std::array<double, In * Out>& w,
                              const std::array<double, Out>& b) {
  std::array<double, Out> y = b;
  for (std::size_t i = 0; i < In; ++i) {
    for (std::size_t o = 0; o < Out; ++o) y[o] += x[i] * w[i * Out + o];
  }
  return y;
}

template <std::size_t N>
std::array<double, N> relu(std::array<double, N> x) {
  for (double& value : x) value = std::max(value, 0.0);
  return x;
}

/// Numbers of a list, or of a list of lists of `columns`, into `out`. False: another shape, or no finite numbers.
bool read_numbers(const nlohmann::json& json, std::size_t columns, std::span<double> out) {
  if (!json.is_array() || json.size() * columns != out.size()) return false;
  std::size_t at = 0;
  const auto take = [&](const nlohmann::json& number) {
    if (!number.is_number()) return false;
    out[at] = number.get<double>();
    return std::isfinite(out[at++]);
  };
  for (const nlohmann::json& row : json) {
    if (!row.is_array()) {
      if (columns != 1 || !take(row)) return false;
      continue;
    }
    if (row.size() != columns || !std::all_of(row.begin(), row.end(), take)) return false;
  }
  return at == out.size();
}

}  // namespace

glm::dvec3 NeuralBrdf::operator()(const glm::dvec3& in, const glm::dvec3& out) const {
  const core::HalfAngles angles = core::half_angles(in, out);
  const double sin_d = std::sin(angles.theta_d);
  const std::array<double, inputs_> x{std::sin(angles.theta_h),       0.0,
                                      std::cos(angles.theta_h),       sin_d * std::cos(angles.phi_d),
                                      sin_d * std::sin(angles.phi_d), std::cos(angles.theta_d)};
  const auto y = layer(relu(layer(relu(layer(x, w1_, b1_)), w2_, b2_)), w3_, b3_);
  return {std::exp(y[0]) - 1.0, std::exp(y[1]) - 1.0, std::exp(y[2]) - 1.0};
}

Result<NeuralBrdf> read_neural_brdf(const std::filesystem::path& file, const std::string& name) {
  const auto bytes = read_whole_file(file, max_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto json = nlohmann::json::parse(bytes->begin(), bytes->end(), nullptr, false);
  if (!json.is_object()) return fail(file.string(), "", "is no JSON object", "copy it again");
  const auto material = json.find(name);
  if (material == json.end() || !material->is_object()) {
    std::string known;
    for (const auto& [key, value] : json.items()) known += (known.empty() ? "" : ", ") + key;
    return fail(file.string(), name, "is not there", "it has " + known);
  }
  NeuralBrdf out;
  struct Part {
    const char* key;
    std::size_t columns;
    std::span<double> numbers;
  };
  for (const Part& part :
       {Part{"W1", NeuralBrdf::hidden_, out.w1_}, Part{"b1", 1, out.b1_}, Part{"W2", NeuralBrdf::hidden_, out.w2_},
        Part{"b2", 1, out.b2_}, Part{"W3", NeuralBrdf::outputs_, out.w3_}, Part{"b3", 1, out.b3_}}) {
    const auto found = material->find(part.key);
    if (found != material->end() && read_numbers(*found, part.columns, part.numbers)) continue;
    return fail(file.string(), name + "." + part.key, "is missing or has another shape than 6-21-21-3",
                "copy the file again");
  }
  return out;
}

}  // namespace lackwerk::packs

// Published neural fits of MERL's paints (Sztrajman et al. 2021, "Neural BRDF Representation and Importance Sampling").
//
// Why it exists: MERL's own binaries may not be handed on; these fits may, and files made from them try the MERL
// importer with real paints' shapes. They are fits: whatever is made of them has the provenance `published-fit`.
// Values; any thread. Files are only read.
#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

/// 6-21-21-3 with relu; x = half and difference vector, f = exp(y) - 1.
class NeuralBrdf {
 public:
  /// 1/sr, linear sRGB, without the cosine. As fitted: a channel may be slightly negative where there was no data.
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& in, const glm::dvec3& out) const;

 private:
  friend Result<NeuralBrdf> read_neural_brdf(const std::filesystem::path& file, const std::string& name);
  static constexpr std::size_t inputs_ = 6, hidden_ = 21, outputs_ = 3;
  std::array<double, inputs_ * hidden_> w1_{};  ///< [in][out]
  std::array<double, hidden_> b1_{};
  std::array<double, hidden_ * hidden_> w2_{};
  std::array<double, hidden_> b2_{};
  std::array<double, hidden_ * outputs_> w3_{};
  std::array<double, outputs_> b3_{};
};

/// One material of a JSON file {"name": {"W1": [[..]], "b1": [..], ..}}. Errors: missing, not JSON, no such material
/// (names those that are there), a matrix of the wrong size, a number that is none.
[[nodiscard]] Result<NeuralBrdf> read_neural_brdf(const std::filesystem::path& file, const std::string& name);

}  // namespace lackwerk::packs

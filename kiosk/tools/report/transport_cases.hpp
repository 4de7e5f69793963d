// Pairs of weighted clouds that are hard on transport solvers.
//
// Why it exists: the exact solver and Sinkhorn's are tried on the same ones. Plain values; any thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace lackwerk::report {

/// Centres in Lab with one mass each.
struct MassCloud {
  std::vector<glm::dvec3> centres;
  std::vector<std::int64_t> mass;
};

struct TransportCase {
  std::string name;
  MassCloud from, to;
};

/// 50 centres as a metallic paint's slice has them: most dark, few bright, near the grey axis; masses sum to 230400.
[[nodiscard]] MassCloud flake_like_cloud(unsigned seed, std::size_t count = 50);

/// Identical, permuted, one mass of 0.99, tiny masses, equal costs, lattice, duplicates, offsets, 1 x 50, empty.
[[nodiscard]] std::vector<TransportCase> transport_cases();

/// Euclidean distances, row by row.
[[nodiscard]] std::vector<double> distances(const MassCloud& from, const MassCloud& to);

[[nodiscard]] double total_mass(const MassCloud& cloud);

}  // namespace lackwerk::report

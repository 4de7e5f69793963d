#include "packs/tools/scene_bake.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "core/check.hpp"
#include "core/paint_model.hpp"
#include "packs/tools/parallel.hpp"
#include "packs/tools/scene_blockers.hpp"
#include "packs/tools/visibility_fit.hpp"

namespace lackwerk::packs {
namespace {

using Model = core::PaintModel<double>;

constexpr double pi = 3.14159265358979323846;
constexpr float lift_mm = 1.5f;  // off the surface, so that a coarse facet does not shadow its own vertices
constexpr std::size_t vertices_a_turn = 256;

/// What all vertices share.
struct Surroundings {
  const core::Environment& environment;
  VisibilityFit fit;
  Blockers blockers;
  std::optional<FloorOpenness> floor;  ///< where the scene has one
  double level;                        ///< of the environment: as blurred as the rays are apart
};

/// What one vertex gets; irradiance as it is, for the range is only known at the end.
struct Lit {
  Visibility visibility = open_visibility;
  glm::vec3 irradiance{0.0f};
  float fit_error = 0.0f;
};

/// Bakes one vertex after the other; each thread has its own.
class VertexBaker {
 public:
  explicit VertexBaker(const Surroundings& around) : around_(around), seen_(around.fit.rays().size()) {
    const core::Environment& e = around.environment;
    model_.environment = &e;
    model_.u_room = {glm::dvec3(e.centre_mm), static_cast<double>(e.room_radius_mm)};
    model_.u_environment_scale = static_cast<double>(e.range);
  }

  Lit bake(const glm::vec3& position, const glm::vec3& normal) {
    const NormalFrame frame = frame_around(glm::dvec3(normal));
    Lit out;
    look_around(position + normal * lift_mm, frame);
    out.visibility = around_.fit.fit(seen_, frame);
    gather(glm::dvec3(position), frame, out);
    return out;
  }

 private:
  glm::dvec3 in_scene(const glm::dvec3& d, const NormalFrame& frame) const {
    return frame.tangent * d.x + frame.bitangent * d.y + frame.normal * d.z;
  }

  /// Fills `seen_`.
  void look_around(const glm::vec3& from, const NormalFrame& frame) {
    const auto& rays = around_.fit.rays();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const glm::vec3 d(in_scene(rays[i].direction, frame));
      seen_[i] = around_.blockers.blocked(from, d) ? 0.0f : 1.0f;
      if (seen_[i] > 0.0f && around_.floor && d.z < -1e-4f) {
        const float t = std::max(from.z, 0.0f) / -d.z;
        seen_[i] = around_.floor->at(from.x + t * d.x, from.y + t * d.y);
      }
    }
  }

  /// What arrives through the fit, and how far that is from what was traced.
  void gather(const glm::dvec3& position, const NormalFrame& frame, Lit& out) {
    const auto& rays = around_.fit.rays();
    const std::array<double, 9> c = visibility_coefficients(out.visibility);
    const glm::dvec3 v0(c[0], c[1], c[2]), v1(c[3], c[4], c[5]), v2(c[6], c[7], c[8]);
    glm::dvec3 sum(0.0);
    double error = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const glm::dvec3 d = in_scene(rays[i].direction, frame);
      const double part = model_.visible_part(v0, v1, v2, d);
      error += std::abs(part - static_cast<double>(seen_[i]));
      if (part > 0.0)
        sum += model_.environment_at(model_.room_direction(position, d), around_.level) * (part * rays[i].share);
    }
    out.irradiance = glm::vec3(sum);
    out.fit_error = static_cast<float>(error / static_cast<double>(rays.size()));
  }

  const Surroundings& around_;
  Model model_;
  std::vector<float> seen_;
};

/// A Beckmann lobe of roughness m spreads a mirrored direction by about 1.4 m; two rays are sqrt(2 pi / rays) apart.
/// Half of that as m leaves no gaps between the rays and little of the light's shape is lost.
double level_for(int rays) { return core::environment_level_of(0.5 * std::sqrt(2.0 * pi / rays)); }

std::uint16_t encode_irradiance(float value, float range) {
  const double root = std::sqrt(std::clamp(static_cast<double>(value) / static_cast<double>(range), 0.0, 1.0));
  return static_cast<std::uint16_t>(std::lround(root * 65535.0));
}

/// Vertices first to last of a part.
struct Turn {
  std::size_t part, first, last;
};

std::vector<Turn> turns_of(const Scene& scene) {
  std::vector<Turn> turns;
  for (std::size_t k = 0; k < scene.parts.size(); ++k) {
    const std::size_t count = scene.parts[k].positions_mm.size();
    for (std::size_t first = 0; first < count; first += vertices_a_turn)
      turns.push_back({k, first, std::min(first + vertices_a_turn, count)});
  }
  return turns;
}

BakeReport report_of(std::vector<float>& errors) {
  BakeReport report{errors.size()};
  if (errors.empty()) return report;
  report.fit_error_mean = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  const auto p95 = errors.begin() + static_cast<std::ptrdiff_t>((errors.size() - 1) * 95 / 100);
  std::nth_element(errors.begin(), p95, errors.end());
  report.fit_error_p95 = static_cast<double>(*p95);
  return report;
}

}  // namespace

BakeReport bake_scene(Scene& scene, const BakeSettings& settings, const BakeProgress& progress) {
  const int threads = thread_count(settings.threads);
  const bool has_floor = std::any_of(scene.parts.begin(), scene.parts.end(),
                                     [](const MeshPart& part) { return part.kind == SurfaceKind::floor; });
  Surroundings around{scene.environment, VisibilityFit(settings.rays_per_vertex), Blockers(scene), std::nullopt,
                      level_for(settings.rays_per_vertex)};
  if (has_floor) around.floor.emplace(around.blockers, threads);
  std::vector<std::vector<glm::vec3>> irradiance(scene.parts.size());
  std::vector<std::vector<float>> errors(scene.parts.size());
  std::size_t vertices = 0;
  for (std::size_t k = 0; k < scene.parts.size(); ++k) {
    MeshPart& part = scene.parts[k];
    const std::size_t count = part.positions_mm.size();
    check_equal(part.normals.size(), count, "one normal per vertex");
    part.visibility.resize(count);
    irradiance[k].resize(count);
    errors[k].resize(count);
    vertices += count;
  }
  const std::vector<Turn> turns = turns_of(scene);
  std::atomic<std::size_t> done{0};
  for_each_index(turns.size(), threads, [&](std::size_t k) {
    const Turn& turn = turns[k];
    MeshPart& part = scene.parts[turn.part];
    VertexBaker baker(around);
    for (std::size_t v = turn.first; v < turn.last; ++v) {
      const Lit lit = baker.bake(part.positions_mm[v], part.normals[v]);
      part.visibility[v] = lit.visibility;
      irradiance[turn.part][v] = lit.irradiance;
      errors[turn.part][v] = lit.fit_error;
    }
    done += turn.last - turn.first;
    if (progress) progress(static_cast<double>(done.load()) / static_cast<double>(vertices));
  });
  float range = 0.0f;
  for (const auto& part : irradiance)
    for (const glm::vec3& value : part) range = std::max({range, value.x, value.y, value.z});
  scene.irradiance_range = range > 0.0f ? range : 1.0f;
  std::vector<float> all_errors;
  for (std::size_t k = 0; k < scene.parts.size(); ++k) {
    scene.parts[k].irradiance.clear();
    for (const glm::vec3& value : irradiance[k]) {
      scene.parts[k].irradiance.push_back({encode_irradiance(value.x, scene.irradiance_range),
                                           encode_irradiance(value.y, scene.irradiance_range),
                                           encode_irradiance(value.z, scene.irradiance_range)});
    }
    all_errors.insert(all_errors.end(), errors[k].begin(), errors[k].end());
  }
  return report_of(all_errors);
}

}  // namespace lackwerk::packs

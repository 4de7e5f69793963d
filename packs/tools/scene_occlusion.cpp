#include "packs/tools/scene_occlusion.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lackwerk::packs {

namespace {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DevicePtr = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using ScenePtr = std::unique_ptr<RTCSceneTy, ReleaseScene>;

void attach(RTCDevice device, RTCScene target, const MeshPart& part) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), part.positions_mm.size()));
  std::copy(part.positions_mm.begin(), part.positions_mm.end(), vertices);
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), part.indices.size() / 3));
  std::copy(part.indices.begin(), part.indices.end(), indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(target, geometry);
  rtcReleaseGeometry(geometry);
}

/// Cosine-weighted directions around +z, the same for every vertex: neighbours then differ smoothly, not noisily.
std::vector<glm::vec3> hemisphere(int count) {
  std::vector<glm::vec3> directions;
  constexpr double golden_angle = 2.39996322972865332;
  for (int i = 0; i < count; ++i) {
    const double squared = (i + 0.5) / count;
    const double radius = std::sqrt(squared);
    directions.emplace_back(radius * std::cos(golden_angle * i), radius * std::sin(golden_angle * i),
                            std::sqrt(1.0 - squared));
  }
  return directions;
}

std::uint8_t openness(RTCScene target, const glm::vec3& position, const glm::vec3& normal,
                      const std::vector<glm::vec3>& directions) {
  // A frame that varies continuously with the normal almost everywhere (Duff et al. 2017).
  const float sign = std::copysign(1.0f, normal.z);
  const float a = -1.0f / (sign + normal.z);
  const float b = normal.x * normal.y * a;
  const glm::vec3 tangent{1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
  const glm::vec3 bitangent{b, sign + normal.y * normal.y * a, -normal.y};
  constexpr float lift_mm = 1.5f;  // off the surface, so that a coarse facet does not shadow its own vertices
  constexpr float reach_mm = 6000.0f;
  const glm::vec3 from = position + normal * lift_mm;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  int open = 0;
  for (const glm::vec3& d : directions) {
    const glm::vec3 w = tangent * d.x + bitangent * d.y + normal * d.z;
    RTCRay ray{from.x, from.y, from.z, 0.0f, w.x, w.y, w.z, 0.0f, reach_mm, 0xffffffffU, 0U, 0U};
    rtcOccluded1(target, &context, &ray);
    open += ray.tfar > 0.0f ? 1 : 0;
  }
  return static_cast<std::uint8_t>(std::lround(255.0 * open / static_cast<double>(directions.size())));
}

}  // namespace

void bake_ambient_occlusion(Scene& scene, int rays_per_vertex) {
  const DevicePtr device(rtcNewDevice("threads=1"));
  if (!device) throw std::runtime_error("occlusion: no ray tracing device");
  const ScenePtr target(rtcNewScene(device.get()));
  for (const MeshPart& part : scene.parts) {
    if (part.kind != SurfaceKind::glass && !part.indices.empty()) attach(device.get(), target.get(), part);
  }
  rtcCommitScene(target.get());
  const std::vector<glm::vec3> directions = hemisphere(std::max(1, rays_per_vertex));
  const unsigned workers = std::clamp(std::thread::hardware_concurrency(), 1U, 8U);
  for (MeshPart& part : scene.parts) {
    part.ambient_occlusion.resize(part.positions_mm.size());
    const auto work = [&](std::size_t first) {
      for (std::size_t i = first; i < part.positions_mm.size(); i += workers) {
        part.ambient_occlusion[i] = openness(target.get(), part.positions_mm[i], part.normals[i], directions);
      }
    };
    std::vector<std::jthread> threads;  // joined at the end of this round
    for (unsigned t = 1; t < workers; ++t) threads.emplace_back(work, t);
    work(0);
  }
}

}  // namespace lackwerk::packs

#include "packs/tools/scene_blockers.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <new>

#include "packs/tools/parallel.hpp"
#include "packs/tools/visibility_fit.hpp"

namespace lackwerk::packs {
namespace {

constexpr int grid_columns = 128, grid_rows = 96;
constexpr int grid_rays = 96;
constexpr float grid_margin_mm = 1500.0f;
constexpr float grid_lift_mm = 0.5f;
constexpr float endless_mm = 1e7f;

void attach(RTCDevice device, RTCScene target, const MeshPart& part) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), part.positions_mm.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), part.indices.size() / 3));
  if (vertices == nullptr || indices == nullptr) throw std::bad_alloc();
  std::copy(part.positions_mm.begin(), part.positions_mm.end(), vertices);
  std::copy(part.indices.begin(), part.indices.end(), indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(target, geometry);
  rtcReleaseGeometry(geometry);
}

bool blocks(const MeshPart& part) {
  return part.kind != SurfaceKind::glass && part.kind != SurfaceKind::floor && (part.detail & detail_full) != 0 &&
         !part.indices.empty();
}

}  // namespace

struct Blockers::Tree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Tree() : device(rtcNewDevice("threads=1")), scene(device == nullptr ? nullptr : rtcNewScene(device)) {}
  ~Tree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
};

Blockers::Blockers(const Scene& scene) : tree_(std::make_unique<Tree>()) {
  if (tree_->scene == nullptr) throw std::bad_alloc();
  bool any = false;
  for (const MeshPart& part : scene.parts) {
    if (!blocks(part)) continue;
    attach(tree_->device, tree_->scene, part);
    for (const glm::vec3& p : part.positions_mm) {
      low_ = any ? glm::min(low_, p) : p;
      high_ = any ? glm::max(high_, p) : p;
      any = true;
    }
  }
  rtcCommitScene(tree_->scene);
}

Blockers::~Blockers() = default;

bool Blockers::blocked(const glm::vec3& from, const glm::vec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{from.x,      from.y, from.z,     0.0f,        direction.x, direction.y,
             direction.z, 0.0f,   endless_mm, 0xffffffffU, 0U,          0U};
  rtcOccluded1(tree_->scene, &context, &ray);
  return ray.tfar < 0.0f;
}

FloorOpenness::FloorOpenness(const Blockers& blockers, int threads)
    : low_(blockers.low_mm() - grid_margin_mm),
      high_(blockers.high_mm() + grid_margin_mm),
      share_(std::size_t{grid_columns} * grid_rows) {
  const VisibilityFit directions(grid_rays);
  for_each_index(grid_rows, threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < grid_columns; ++column) {
      const float u = static_cast<float>(column) / (grid_columns - 1), v = static_cast<float>(row) / (grid_rows - 1);
      const glm::vec3 from{low_.x + (high_.x - low_.x) * u, low_.y + (high_.y - low_.y) * v, grid_lift_mm};
      double open = 0.0;
      for (const VisibilityFit::Ray& ray : directions.rays())
        if (!blockers.blocked(from, glm::vec3(ray.direction))) open += ray.share;
      share_[row * grid_columns + column] = static_cast<float>(std::min(open, 1.0));
    }
  });
}

float FloorOpenness::at(float x_mm, float y_mm) const {
  const float x = (x_mm - low_.x) / (high_.x - low_.x) * (grid_columns - 1);
  const float y = (y_mm - low_.y) / (high_.y - low_.y) * (grid_rows - 1);
  if (!(x >= 0.0f && x < grid_columns - 1 && y >= 0.0f && y < grid_rows - 1)) return 1.0f;
  const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
  const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(row);
  const float* at = &share_[row * grid_columns + column];
  return (at[0] * (1.0f - fx) + at[1] * fx) * (1.0f - fy) +
         (at[grid_columns] * (1.0f - fx) + at[grid_columns + 1] * fx) * fy;
}

}  // namespace lackwerk::packs

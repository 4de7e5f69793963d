#include "core/analysis/reference_geometry.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

namespace lackwerk::core {
namespace {

/// Embree asks about each triangle it meets: the renderer culls back faces, so they are not there.
void drop_back_faces(const RTCFilterFunctionNArguments* args) {
  for (unsigned k = 0; k < args->N; ++k) {
    if (args->valid[k] == 0) continue;
    const float along = RTCHitN_Ng_x(args->hit, args->N, k) * RTCRayN_dir_x(args->ray, args->N, k) +
                        RTCHitN_Ng_y(args->hit, args->N, k) * RTCRayN_dir_y(args->ray, args->N, k) +
                        RTCHitN_Ng_z(args->hit, args->N, k) * RTCRayN_dir_z(args->ray, args->N, k);
    if (along >= 0.0f) args->valid[k] = 0;
  }
}

RTCRay make_ray(const glm::dvec3& origin, const glm::dvec3& direction, double from, double to) {
  const glm::vec3 o(origin), d(direction);
  return {o.x, o.y, o.z, static_cast<float>(from), d.x, d.y, d.z, 0.0f, static_cast<float>(to), 0xFFFFFFFFu, 0u, 0u};
}

std::string name_of(std::size_t mesh) { return "mesh " + std::to_string(mesh); }

Result<void> check(const ReferenceScene& scene) {
  for (std::size_t k = 0; k < scene.meshes.size(); ++k) {
    const ReferenceMesh& mesh = scene.meshes[k];
    const std::size_t count = mesh.positions_mm.size();
    if (mesh.normals.size() != count || (!mesh.visibility.empty() && mesh.visibility.size() != 9 * count))
      return fail("", name_of(k), "its arrays differ in length", "build the scene pack anew");
    if (mesh.indices.size() % 3 != 0 ||
        std::any_of(mesh.indices.begin(), mesh.indices.end(), [&](std::uint32_t i) { return i >= count; }))
      return fail("", name_of(k), "an index points beyond its vertices", "build the scene pack anew");
    if (mesh.material >= scene.materials.size())
      return fail("", name_of(k), "it has no material", "give the scene one material per kind");
  }
  return {};
}

}  // namespace

void ReferenceGeometry::ReleaseDevice::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void ReferenceGeometry::ReleaseScene::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

void ReferenceGeometry::attach(RTCSceneTy* target, std::uint32_t number) {
  const ReferenceMesh& mesh = scene_->meshes[number];
  const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions_mm.size()));
  std::copy(mesh.positions_mm.begin(), mesh.positions_mm.end(), vertices);
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
  std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
  rtcSetGeometryIntersectFilterFunction(geometry, drop_back_faces);
  rtcSetGeometryOccludedFilterFunction(geometry, drop_back_faces);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(target, geometry, number);
  rtcReleaseGeometry(geometry);
}

Result<ReferenceGeometry> ReferenceGeometry::create(const ReferenceScene& scene) {
  if (auto checked = check(scene); !checked) return tl::unexpected(checked.error());
  ReferenceGeometry out;
  out.scene_ = &scene;
  out.device_.reset(rtcNewDevice("threads=1"));
  if (!out.device_) return fail("", "reference", "no ray tracing device", "reinstall libembree3");
  out.opaque_.reset(rtcNewScene(out.device_.get()));
  out.glass_.reset(rtcNewScene(out.device_.get()));
  for (std::uint32_t k = 0; k < scene.meshes.size(); ++k) {
    if (scene.meshes[k].indices.empty()) continue;
    const bool glass = scene.materials[scene.meshes[k].material].coverage < 1.0;
    out.has_glass_ = out.has_glass_ || glass;
    out.attach(glass ? out.glass_.get() : out.opaque_.get(), k);
  }
  for (RTCSceneTy* built : {out.opaque_.get(), out.glass_.get()}) {
    // Robust: no ray slips through between two triangles.
    rtcSetSceneFlags(built, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(built, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(built);
  }
  if (rtcGetDeviceError(out.device_.get()) != RTC_ERROR_NONE)
    return fail("", "reference", "the scene was refused by the ray tracing library", "use a smaller scene");
  return out;
}

std::optional<ReferenceHit> ReferenceGeometry::first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                                                         double from_mm, double to_mm, bool glass) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, from_mm, to_mm);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(glass ? glass_.get() : opaque_.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return ReferenceHit{query.hit.geomID, query.hit.primID, static_cast<double>(query.hit.u),
                      static_cast<double>(query.hit.v), static_cast<double>(query.ray.tfar)};
}

bool ReferenceGeometry::blocked(const glm::dvec3& origin, const glm::dvec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = make_ray(origin, direction, 0.0, std::numeric_limits<double>::infinity());
  rtcOccluded1(opaque_.get(), &context, &ray);
  return ray.tfar < 0.0f;
}

glm::dvec3 ReferenceGeometry::position(const ReferenceHit& hit) const {
  const ReferenceMesh& mesh = scene_->meshes[hit.mesh];
  const std::uint32_t* i = &mesh.indices[std::size_t{3} * hit.triangle];
  return glm::dvec3(mesh.positions_mm[i[0]]) * (1.0 - hit.u - hit.v) + glm::dvec3(mesh.positions_mm[i[1]]) * hit.u +
         glm::dvec3(mesh.positions_mm[i[2]]) * hit.v;
}

glm::dvec3 ReferenceGeometry::normal(const ReferenceHit& hit) const {
  const ReferenceMesh& mesh = scene_->meshes[hit.mesh];
  const std::uint32_t* i = &mesh.indices[std::size_t{3} * hit.triangle];
  return glm::normalize(glm::dvec3(mesh.normals[i[0]]) * (1.0 - hit.u - hit.v) +
                        glm::dvec3(mesh.normals[i[1]]) * hit.u + glm::dvec3(mesh.normals[i[2]]) * hit.v);
}

VisibilityQuadratic ReferenceGeometry::visibility(const ReferenceHit& hit) const {
  const ReferenceMesh& mesh = scene_->meshes[hit.mesh];
  if (mesh.visibility.empty()) return {};
  const std::uint32_t* i = &mesh.indices[std::size_t{3} * hit.triangle];
  const double weights[3] = {1.0 - hit.u - hit.v, hit.u, hit.v};
  double c[9] = {};
  for (std::size_t corner = 0; corner < 3; ++corner)
    for (std::size_t k = 0; k < 9; ++k) c[k] += weights[corner] * mesh.visibility[std::size_t{9} * i[corner] + k];
  for (double& v : c) v = (v - 128.0) / 64.0;
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
}

}  // namespace lackwerk::core

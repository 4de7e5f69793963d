// A scene's triangles on the GPU.
//
// Why it exists: core ES 2.0 has 16-bit indices, so parts of more than 65,536 vertices must be cut; everything else is
// one upload per part. Owns GL buffers; destroy it while its context is current; one GL thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "packs/scene.hpp"
#include "render_gles/gl_object.hpp"

namespace lackwerk::gles {

/// Axis-aligned box, millimetres. Empty while lo > hi.
struct Box {
  glm::vec3 lo{1e30f};
  glm::vec3 hi{-1e30f};
  void include(const glm::vec3& p);
  void include(const Box& other);
  [[nodiscard]] bool empty() const { return lo.x > hi.x; }
  [[nodiscard]] glm::vec3 centre() const { return 0.5f * (lo + hi); }
};

/// One vertex as uploaded.
struct MeshVertex {
  glm::vec3 position_mm;
  glm::vec3 normal;
  packs::Irradiance irradiance{};
  std::uint16_t unused = 0;  ///< keeps what follows on four bytes
  packs::Visibility visibility = packs::open_visibility;
  std::array<std::uint8_t, 3> unused_too{};
};
static_assert(sizeof(MeshVertex) == 44);

/// At most 65,536 vertices of one part.
struct MeshChunk {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint16_t> indices;
};

/// Cuts a part into chunks that 16-bit indices can address. Triangles keep their order. Aborts on indices or arrays
/// that do not fit each other: the scene pack's reader has checked them.
[[nodiscard]] std::vector<MeshChunk> split_part(const packs::MeshPart& part, std::size_t max_vertices = 65536);

class MeshBuffers {
 public:
  struct Draw {
    packs::SurfaceKind surface = packs::SurfaceKind::paint;
    std::uint8_t detail = packs::detail_full | packs::detail_coarse;
    bool visibility = false;  ///< whether they were baked
    bool irradiance = false;
    Box box;
    GlObject vertices, indices;
    GLsizei index_count = 0;
  };

  MeshBuffers() = default;
  /// Uploads all parts of a scene.
  MeshBuffers(const GlApi& gl, const packs::Scene& scene);

  [[nodiscard]] std::span<const Draw> draws() const { return draws_; }
  /// Draws one of them with the program in use. Leaves the attribute arrays enabled.
  void draw(const GlApi& gl, const Draw& what) const;
  [[nodiscard]] std::size_t triangles(std::uint8_t detail) const;
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] bool has(packs::SurfaceKind kind) const;

 private:
  std::vector<Draw> draws_;
  std::size_t bytes_ = 0;
};

}  // namespace lackwerk::gles

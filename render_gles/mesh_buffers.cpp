#include "render_gles/mesh_buffers.hpp"

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>

#include "core/check.hpp"
#include "render_gles/program.hpp"

namespace lackwerk::gles {

void Box::include(const glm::vec3& p) {
  lo = glm::min(lo, p);
  hi = glm::max(hi, p);
}

void Box::include(const Box& other) {
  lo = glm::min(lo, other.lo);
  hi = glm::max(hi, other.hi);
}

std::vector<MeshChunk> split_part(const packs::MeshPart& part, std::size_t max_vertices) {
  const std::size_t count = part.positions_mm.size();
  check_equal(part.normals.size(), count, "normals of " + part.name);
  check_equal(part.indices.size() % 3, std::size_t{0}, "indices of " + part.name);
  if (!part.visibility.empty()) check_equal(part.visibility.size(), count, "visibility of " + part.name);
  if (!part.irradiance.empty()) check_equal(part.irradiance.size(), count, "irradiance of " + part.name);

  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(count, none);  // of each vertex within the current chunk
  std::vector<std::uint32_t> placed;              // vertices of the current chunk
  std::vector<MeshChunk> chunks;
  for (std::size_t k = 0; k < part.indices.size(); k += 3) {
    const std::span<const std::uint32_t> triangle(&part.indices[k], 3);
    for (const std::uint32_t index : triangle) check_at_most(index + std::size_t{1}, count, "index of " + part.name);
    if (chunks.empty() || placed.size() + 3 > max_vertices) {
      for (const std::uint32_t index : placed) place[index] = none;
      placed.clear();
      chunks.emplace_back();
    }
    MeshChunk& chunk = chunks.back();
    for (const std::uint32_t index : triangle) {
      if (place[index] == none) {
        place[index] = static_cast<std::uint32_t>(placed.size());
        placed.push_back(index);
        MeshVertex vertex{part.positions_mm[index], part.normals[index]};
        if (!part.visibility.empty()) vertex.visibility = part.visibility[index];
        if (!part.irradiance.empty()) vertex.irradiance = part.irradiance[index];
        chunk.vertices.push_back(vertex);
      }
      chunk.indices.push_back(static_cast<std::uint16_t>(place[index]));
    }
  }
  return chunks;
}

MeshBuffers::MeshBuffers(const GlApi& gl, const packs::Scene& scene) {
  for (const packs::MeshPart& part : scene.parts)
    for (const MeshChunk& chunk : split_part(part)) {
      Draw draw;
      draw.surface = part.kind;
      draw.detail = part.detail;
      draw.visibility = !part.visibility.empty();
      draw.irradiance = !part.irradiance.empty();
      for (const MeshVertex& vertex : chunk.vertices) draw.box.include(vertex.position_mm);
      draw.index_count = static_cast<GLsizei>(chunk.indices.size());
      const auto upload = [&](GLenum target, const auto& data) {
        GlObject buffer = make_buffer(gl);
        const std::size_t size = data.size() * sizeof(data[0]);
        gl.BindBuffer(target, buffer.id());
        gl.BufferData(target, static_cast<GLsizeiptr>(size), data.data(), GL_STATIC_DRAW);
        bytes_ += size;
        return buffer;
      };
      draw.vertices = upload(GL_ARRAY_BUFFER, chunk.vertices);
      draw.indices = upload(GL_ELEMENT_ARRAY_BUFFER, chunk.indices);
      draws_.push_back(std::move(draw));
    }
}

void MeshBuffers::draw(const GlApi& gl, const Draw& what) const {
  // GL takes an offset into the bound buffer in the guise of a pointer.
  const auto at = [](std::size_t offset) {
    return reinterpret_cast<const void*>(offset);  // NOLINT(performance-no-int-to-ptr)
  };
  constexpr GLsizei stride = sizeof(MeshVertex);
  gl.BindBuffer(GL_ARRAY_BUFFER, what.vertices.id());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, what.indices.id());
  const auto attribute = [&](GLuint slot, GLenum type, GLboolean normalised, std::size_t offset) {
    gl.EnableVertexAttribArray(slot);
    gl.VertexAttribPointer(slot, 3, type, normalised, stride, at(offset));
  };
  attribute(attribute_position, GL_FLOAT, GL_FALSE, offsetof(MeshVertex, position_mm));
  attribute(attribute_normal, GL_FLOAT, GL_FALSE, offsetof(MeshVertex, normal));
  attribute(attribute_irradiance, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(MeshVertex, irradiance));
  for (GLuint k = 0; k < 3; ++k)
    attribute(attribute_visible + k, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(MeshVertex, visibility) + 3 * k);
  gl.DrawElements(GL_TRIANGLES, what.index_count, GL_UNSIGNED_SHORT, nullptr);
}

bool MeshBuffers::has(packs::SurfaceKind kind) const {
  return std::any_of(draws_.begin(), draws_.end(), [kind](const Draw& draw) { return draw.surface == kind; });
}

std::size_t MeshBuffers::triangles(std::uint8_t detail) const {
  std::size_t count = 0;
  for (const Draw& draw : draws_)
    if ((draw.detail & detail) != 0) count += static_cast<std::size_t>(draw.index_count) / 3;
  return count;
}

}  // namespace lackwerk::gles

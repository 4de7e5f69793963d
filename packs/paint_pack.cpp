#include "packs/paint_pack.hpp"

#include <utility>

#include "packs/paint_pack_checks.hpp"
#include "packs/paint_pack_codec.hpp"

namespace lackwerk::packs {

Result<PaintPack> PaintPack::from_file(Result<SealedFile> file, const std::string& name) {
  if (!file) return tl::unexpected(file.error());
  auto contents = decode_paint_pack(file->payload(), name);
  if (!contents) return tl::unexpected(contents.error());
  if (auto checked = check_contents(*contents, name); !checked) return tl::unexpected(checked.error());
  return PaintPack(std::move(*file), std::move(*contents));
}

Result<PaintPack> PaintPack::open(const std::filesystem::path& path, Backing backing) {
  return from_file(SealedFile::open(path, SealedKind::paint, backing), path.string());
}

Result<PaintPack> PaintPack::from_bytes(std::vector<std::uint8_t> bytes, const std::string& file) {
  return from_file(SealedFile::from_bytes(std::move(bytes), SealedKind::paint, file), file);
}

Result<void> write_paint_pack(const std::filesystem::path& path, const PackContents& contents) {
  if (auto checked = check_contents(contents, path.string()); !checked) return checked;
  return write_sealed_file(path, SealedKind::paint, encode_paint_pack(contents));
}

std::uint64_t paint_bytes(const core::InterpolatablePaint& paint, std::size_t index) {
  const auto& part = paint.paints[index];
  const std::size_t table = part.analytic.table ? part.analytic.table->linear.size() * sizeof(glm::vec3) : 0;
  return part.clusters.size_bytes() + part.cluster_begin.size_bytes() + part.tuple_cluster.size_bytes() + table;
}

}  // namespace lackwerk::packs

#include "packs/paint_pack_codec.hpp"

#include <bit>
#include <type_traits>

#include "packs/paint_pack_generated.h"

namespace lackwerk::packs {
namespace {

static_assert(std::endian::native == std::endian::little, "spans point straight into little-endian FlatBuffers");
static_assert(sizeof(fb::Cuboid) == sizeof(core::QuantisedCuboid) &&
              std::alignment_of_v<fb::Cuboid> == std::alignment_of_v<core::QuantisedCuboid>);
static_assert(sizeof(fb::Rgb32) == sizeof(glm::vec3) &&
              std::alignment_of_v<fb::Rgb32> == std::alignment_of_v<glm::vec3>);

// A pack has a root, and a paint, a colour table and an error table per paint; strings and vectors are no tables.
constexpr flatbuffers::uoffset_t max_depth = 8, max_tables = 64;
constexpr std::size_t max_text_bytes = 1024;
constexpr unsigned max_table_edge = 256, max_layout_entries = 65536;

fb::Rgb64 to_fb(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
fb::Lab32 to_fb(const glm::vec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 from_fb(const fb::Rgb64& v) { return {v.r(), v.g(), v.b()}; }
glm::vec3 from_fb(const fb::Lab32& v) { return {v.l(), v.a(), v.b()}; }

template <class T>
auto vector_of(flatbuffers::FlatBufferBuilder& out, std::span<const T> values) {
  return out.CreateVector(values.data(), values.size());
}

template <class T>
std::span<const T> span_of(const flatbuffers::Vector<T>& values) {
  return {values.data(), values.size()};
}

flatbuffers::Offset<fb::Paint> encode_paint(flatbuffers::FlatBufferBuilder& out,
                                            const core::InterpolatablePaint::PaintPart& part, const PaintError& error) {
  const core::AnalyticPaint& analytic = part.analytic;
  const auto name = out.CreateString(part.identity.name);
  const auto source = out.CreateString(part.identity.source);
  std::vector<fb::LobeData> lobe_data;
  for (const core::Lobe& lobe : analytic.lobes) lobe_data.emplace_back(to_fb(lobe.s), lobe.m, lobe.f0);
  const auto lobes = out.CreateVectorOfStructs(lobe_data);
  flatbuffers::Offset<fb::ChiTable> chi;
  if (analytic.table) {
    const auto* rgb = reinterpret_cast<const fb::Rgb32*>(analytic.table->linear.data());
    const auto linear = out.CreateVectorOfStructs(rgb, analytic.table->linear.size());
    chi = fb::CreateChiTable(out, analytic.table->num_theta, linear);
  }
  const auto cluster_begin = vector_of(out, part.cluster_begin);
  const auto* cuboids = reinterpret_cast<const fb::Cuboid*>(part.clusters.data());
  const auto clusters = out.CreateVectorOfStructs(cuboids, part.clusters.size());
  const auto tuple_cluster = vector_of(out, part.tuple_cluster);
  const auto slice_errors = vector_of(out, std::span<const float>(error.flake_w1_slice));
  const FormError& judged = error.form;
  const fb::FormError form(static_cast<fb::Form>(judged.form), static_cast<fb::Judge>(judged.judged_by), judged.count,
                           judged.e2000_mean, judged.e2000_p95, judged.e2000_max);
  const auto errors = fb::CreatePaintError(out, error.flake_w1_mean, error.flake_w1_max, slice_errors, &form);
  const fb::Rgb64 diffuse = to_fb(analytic.diffuse);
  const auto origin = [](core::Provenance p) { return static_cast<fb::Origin>(p); };
  const fb::FlakeLife life(part.life.cell_h_deg, part.life.cell_i_deg, static_cast<fb::LifeOrigin>(part.life.origin));
  return fb::CreatePaint(out, name, source, origin(part.identity.lobes), origin(part.identity.flakes),
                         origin(part.identity.coat), &diffuse, lobes, analytic.coat_ior, analytic.refraction_ior, chi,
                         cluster_begin, clusters, tuple_cluster, errors, &life);
}

Result<core::AnalyticPaint> decode_analytic(const fb::Paint& paint, const std::string& file, const std::string& at) {
  core::AnalyticPaint out;
  out.diffuse = from_fb(*paint.diffuse());
  if (paint.lobes()->size() != core::max_lobes)
    return fail(file, at + ".lobes",
                std::to_string(paint.lobes()->size()) + " lobes, expected " + std::to_string(core::max_lobes),
                "make the pack again");
  for (unsigned k = 0; k < core::max_lobes; ++k) {
    const fb::LobeData& lobe = *paint.lobes()->Get(k);
    out.lobes[k] = {from_fb(lobe.s()), lobe.m(), lobe.f0()};
  }
  out.coat_ior = paint.coat_ior();
  out.refraction_ior = paint.refraction_ior();
  if (const fb::ChiTable* chi = paint.chi()) {
    const unsigned edge = chi->num_theta();
    if (edge < 2 || edge > max_table_edge || chi->linear()->size() != edge * edge)
      return fail(file, at + ".chi",
                  std::to_string(chi->linear()->size()) + " entries for an edge of " + std::to_string(edge),
                  "the edge must be 2 to 256 and the table square: make the pack again");
    out.table.emplace();
    out.table->num_theta = chi->num_theta();
    out.table->linear.reserve(chi->linear()->size());
    for (const fb::Rgb32* c : *chi->linear()) out.table->linear.emplace_back(c->r(), c->g(), c->b());
  }
  return out;
}

Result<void> decode_paint(const fb::Paint& paint, const std::string& file, const std::string& at, unsigned slices,
                          PackContents& out) {
  if (paint.name()->size() > max_text_bytes || paint.source()->size() > max_text_bytes)
    return fail(file, at + ".name", "name or source is longer than 1024 bytes", "shorten it");
  auto analytic = decode_analytic(paint, file, at);
  if (!analytic) return tl::unexpected(analytic.error());
  core::InterpolatablePaint::PaintPart part;
  const auto origin = [](fb::Origin o) { return static_cast<core::Provenance>(o); };
  part.identity = {paint.name()->str(), paint.source()->str(), origin(paint.lobes_origin()),
                   origin(paint.flakes_origin()), origin(paint.coat_origin())};
  part.analytic = std::move(*analytic);
  part.cluster_begin = span_of(*paint.cluster_begin());
  part.clusters = {reinterpret_cast<const core::QuantisedCuboid*>(paint.clusters()->Data()), paint.clusters()->size()};
  part.tuple_cluster = span_of(*paint.tuple_cluster());
  if (const fb::FlakeLife* life = paint.life())
    part.life = {life->cell_h_deg(), life->cell_i_deg(), static_cast<core::LifeOrigin>(life->origin())};
  const auto& slice_errors = *paint.error()->flake_w1_slice();
  if (slice_errors.size() != slices)
    return fail(file, at + ".error.flake_w1_slice",
                std::to_string(slice_errors.size()) + " entries for " + std::to_string(slices) + " slices",
                "make the pack again");
  PaintError error{paint.error()->flake_w1_mean(), paint.error()->flake_w1_max(), {}, {}};
  error.flake_w1_slice.assign(slice_errors.begin(), slice_errors.end());
  if (const fb::FormError* form = paint.error()->form())
    error.form = {static_cast<PaintForm>(form->form()),
                  static_cast<JudgedBy>(form->judge()),
                  form->count(),
                  form->e2000_mean(),
                  form->e2000_p95(),
                  form->e2000_max()};
  out.paint.paints.push_back(std::move(part));
  out.info.errors.push_back(std::move(error));
  return {};
}

}  // namespace

std::vector<std::uint8_t> encode_paint_pack(const PackContents& contents) {
  const core::InterpolatablePaint& paint = contents.paint;
  flatbuffers::FlatBufferBuilder out(1 << 16);
  const auto id = out.CreateString(contents.info.id);
  const auto tool = out.CreateString(contents.info.tool_version);
  std::vector<flatbuffers::Offset<fb::Paint>> parts;
  for (std::size_t k = 0; k < paint.paints.size(); ++k)
    parts.push_back(
        encode_paint(out, paint.paints[k], k < contents.info.errors.size() ? contents.info.errors[k] : PaintError{}));
  const auto paints = out.CreateVector(parts);
  const auto layout = out.CreateVector(paint.layout.lut);
  const auto tuple_begin = vector_of(out, paint.tuple_begin);
  const auto mass = vector_of(out, paint.mass);
  const fb::Lab32 lo = to_fb(paint.range.lo), hi = to_fb(paint.range.hi);
  fb::FinishPaintPackBuffer(
      out, fb::CreatePaintPack(out, contents.info.schema_version, contents.info.minimum_reader, id,
                               contents.info.serial, tool, paints, paint.layout.num_theta, layout, paint.level_count,
                               paint.texel_mm, paint.level0_texels, &lo, &hi, tuple_begin, mass, paint.row_mass,
                               paint.random_seed, contents.info.transport_cost, contents.info.beyond_limit));
  return {out.GetBufferPointer(), out.GetBufferPointer() + out.GetSize()};
}

Result<PackContents> decode_paint_pack(std::span<const std::uint8_t> payload, const std::string& file) {
  flatbuffers::Verifier verifier(payload.data(), payload.size(), max_depth, max_tables);
  if (!fb::VerifyPaintPackBuffer(verifier))
    return fail(file, "payload", "not a well-formed paint pack", "make the pack again");
  const fb::PaintPack& root = *fb::GetPaintPack(payload.data());
  PackContents out;
  out.info.schema_version = root.schema_version();
  out.info.minimum_reader = root.minimum_reader();
  // First, because a newer pack may give all that follows another meaning.
  if (out.info.minimum_reader > paint_schema_version)
    return fail(file, "minimum_reader",
                "needs schema version " + std::to_string(out.info.minimum_reader) + ", this program reads up to " +
                    std::to_string(paint_schema_version),
                "update this program");
  if (root.id()->size() > max_text_bytes || root.tool_version()->size() > max_text_bytes)
    return fail(file, "id", "id or tool version is longer than 1024 bytes", "make the pack again");
  out.info.id = root.id()->str();
  out.info.serial = root.serial();
  out.info.tool_version = root.tool_version()->str();
  out.info.transport_cost = root.transport_cost();
  out.info.beyond_limit = root.beyond_limit();
  if (root.paints()->size() == 0 || root.paints()->size() > core::max_paints)
    return fail(file, "paints", std::to_string(root.paints()->size()) + " paints; a pack has 1 to 5",
                "build the pack from 1 to 5 captures");
  if (root.layout()->size() > max_layout_entries) return fail(file, "layout", "too many rows", "make the pack again");

  core::InterpolatablePaint& paint = out.paint;
  paint.layout = {root.num_theta(), {root.layout()->begin(), root.layout()->end()}};
  paint.level_count = root.level_count();
  paint.texel_mm = root.texel_mm();
  paint.level0_texels = root.level0_texels();
  paint.range = {from_fb(*root.range_lo()), from_fb(*root.range_hi())};
  paint.tuple_begin = span_of(*root.tuple_begin());
  paint.mass = span_of(*root.mass());
  paint.row_mass = root.row_mass();
  paint.random_seed = root.random_seed();
  const auto slices = static_cast<unsigned>(paint.layout.slice_count());
  for (unsigned k = 0; k < root.paints()->size(); ++k) {
    auto decoded = decode_paint(*root.paints()->Get(k), file, "paints[" + std::to_string(k) + "]", slices, out);
    if (!decoded) return tl::unexpected(decoded.error());
  }
  return out;
}

}  // namespace lackwerk::packs

#include "packs/paint_pack_checks.hpp"

#include <bit>
#include <cmath>
#include <numeric>
#include <string_view>

#include "core/beyond.hpp"
#include "packs/pack_id.hpp"
#include "packs/utf8.hpp"

namespace lackwerk::packs {
namespace {

// The renderer's slice map is 16 x 16 nodes and names a slice with one byte.
constexpr int max_angle_nodes = 16, max_slices = 256;
constexpr unsigned max_level0_texels = 4096;
constexpr std::uint32_t max_row_mass = 1u << 30;
// Generous bounds of quantities that have no natural one: they keep a later float computation finite.
constexpr double max_reflectance = 1e4, max_lobe_weight = 1e6, max_lab = 1e5, max_ior = 4.0;

/// Carries the file's name, and turns a violated condition into an Error.
struct Judge {
  const std::string& file;

  [[nodiscard]] Result<void> refuse(std::string field, std::string what) const {
    return fail(file, std::move(field), std::move(what), "make the pack again from its captures");
  }
  /// `value` must be a number in [low, high].
  [[nodiscard]] Result<void> within(double value, double low, double high, const std::string& field) const {
    if (value >= low && value <= high) return {};  // false for NaN
    return refuse(field,
                  std::to_string(value) + " is outside [" + std::to_string(low) + ", " + std::to_string(high) + "]");
  }
  template <class Vector>
  [[nodiscard]] Result<void> within3(const Vector& v, double low, double high, const std::string& field) const {
    for (int c = 0; c < 3; ++c)
      if (auto ok = within(static_cast<double>(v[c]), low, high, field); !ok) return ok;
    return {};
  }
};

std::string at(std::string_view name, std::size_t index) {
  return std::string(name) + "[" + std::to_string(index) + "]";
}

Result<void> check_info(const PackInfo& info, std::size_t paints, const Judge& judge) {
  if (!is_pack_id(info.id))
    return fail(judge.file, "id", "must be 1 to 64 letters, digits, dots, dashes or underscores, not a mark first",
                "choose another id");
  if (info.minimum_reader < 1 || info.minimum_reader > paint_schema_version)
    return judge.refuse("minimum_reader", std::to_string(info.minimum_reader) + " is not known here");
  if (info.schema_version < info.minimum_reader)
    return judge.refuse("schema_version", std::to_string(info.schema_version) + " is below minimum_reader");
  if (!is_printable(info.tool_version) || info.tool_version.size() > 256)
    return judge.refuse("tool_version", "must be at most 256 bytes of UTF-8 without control characters");
  if (auto ok = judge.within(info.transport_cost, 0.0, max_lab, "transport_cost"); !ok) return ok;
  if (auto ok = judge.within(info.beyond_limit, 0.0, core::most_beyond, "beyond_limit"); !ok) return ok;
  if (info.errors.size() != paints) return judge.refuse("error", "must be there for every paint");
  return {};
}

Result<void> check_error(const PaintError& error, std::size_t slices, const std::string& name, const Judge& judge) {
  if (auto ok = judge.within(error.flake_w1_mean, 0.0, max_lab, name + ".flake_w1_mean"); !ok) return ok;
  if (auto ok = judge.within(error.flake_w1_max, 0.0, max_lab, name + ".flake_w1_max"); !ok) return ok;
  if (error.flake_w1_slice.size() != slices) return judge.refuse(name + ".flake_w1_slice", "must have one per slice");
  for (const float w1 : error.flake_w1_slice)
    if (auto ok = judge.within(w1, 0.0, max_lab, name + ".flake_w1_slice"); !ok) return ok;
  const FormError& form = error.form;
  if (form.form > PaintForm::mapped) return judge.refuse(name + ".form", "is none of given, fitted, mapped");
  if (form.judged_by > JudgedBy::readings)
    return judge.refuse(name + ".form.judge", "is none of nothing, sphere, readings");
  if ((form.judged_by == JudgedBy::nothing) != (form.count == 0))
    return judge.refuse(name + ".form.count", "must be 0 where nothing judges, and only there");
  for (const float difference : {form.e2000_mean, form.e2000_p95, form.e2000_max})
    if (auto ok = judge.within(difference, 0.0, max_lab, name + ".form.e2000"); !ok) return ok;
  return {};
}

Result<void> check_identity(const core::PaintIdentity& identity, const std::string& name, const Judge& judge) {
  if (identity.name.empty() || identity.name.size() > 200 || !is_printable(identity.name))
    return judge.refuse(name + ".name", "must be 1 to 200 bytes of UTF-8 without control characters");
  if (identity.source.size() > 1000 || !is_printable(identity.source))
    return judge.refuse(name + ".source", "must be at most 1000 bytes of UTF-8 without control characters");
  for (const core::Provenance origin : {identity.lobes, identity.flakes, identity.coat})
    if (origin > core::Provenance::simulated)
      return judge.refuse(name + ".origin", "is none of measured, published-fit, simulated");
  return {};
}

Result<void> check_analytic(const core::AnalyticPaint& analytic, const std::string& name, const Judge& judge) {
  if (auto ok = judge.within3(analytic.diffuse, 0.0, max_reflectance, name + ".diffuse"); !ok) return ok;
  for (std::size_t k = 0; k < core::max_lobes; ++k) {
    const core::Lobe& lobe = analytic.lobes[k];
    const std::string lobe_name = name + "." + at("lobes", k);
    if (auto ok = judge.within3(lobe.s, 0.0, max_lobe_weight, lobe_name + ".s"); !ok) return ok;
    if (auto ok = judge.within(lobe.m, core::min_roughness, 1.0, lobe_name + ".m"); !ok) return ok;
    if (auto ok = judge.within(lobe.f0, 0.0, 1.0, lobe_name + ".f0"); !ok) return ok;
  }
  if (auto ok = judge.within(analytic.coat_ior, 1.0, max_ior, name + ".coat_ior"); !ok) return ok;
  if (auto ok = judge.within(analytic.refraction_ior, 1.0, max_ior, name + ".refraction_ior"); !ok) return ok;
  if (!analytic.table) return {};
  const std::size_t edge = analytic.table->num_theta;
  if (edge < 2 || edge > 256 || analytic.table->linear.size() != edge * edge)
    return judge.refuse(name + ".chi", "must be square with an edge of 2 to 256");
  for (std::size_t k = 0; k < analytic.table->linear.size(); ++k)
    if (auto ok = judge.within3(analytic.table->linear[k], 0.0, max_reflectance, name + "." + at("chi", k)); !ok)
      return ok;
  return {};
}

Result<void> check_life(const core::FlakeLife& life, const std::string& name, const Judge& judge) {
  for (const float width : {life.cell_h_deg, life.cell_i_deg})
    if (auto ok = judge.within(width, 1.0, core::widest_cell_deg, name); !ok) return ok;
  if (life.origin > core::LifeOrigin::fine) return judge.refuse(name + ".origin", "is none of assumed, slices, fine");
  return {};
}

/// `begin` must start at 0, grow by 1 to `most` per row, and end at `size`.
Result<void> check_begin(std::span<const std::uint32_t> begin, std::size_t rows, std::uint32_t most, std::size_t size,
                         const std::string& name, const Judge& judge) {
  if (begin.size() != rows + 1)
    return judge.refuse(name, std::to_string(begin.size()) + " entries for " + std::to_string(rows) + " rows");
  if (begin.front() != 0) return judge.refuse(name, "must start at 0");
  for (std::size_t row = 0; row < rows; ++row)
    if (begin[row + 1] <= begin[row] || begin[row + 1] - begin[row] > most)
      return judge.refuse(at(name, row + 1), "a row must have 1 to " + std::to_string(most) + " entries");
  if (begin.back() != size)
    return judge.refuse(name, "ends at " + std::to_string(begin.back()) + " of " + std::to_string(size));
  return {};
}

Result<void> check_layout(const core::InterpolatablePaint& paint, const Judge& judge) {
  const auto& lut = paint.layout.lut;
  if (paint.layout.slice_count() == 0) {
    if (paint.level_count != 0 || lut.size() > 1) return judge.refuse("layout", "has rows or levels but no slices");
    return {};
  }
  const int nodes = paint.layout.num_theta + 1;
  if (nodes < 2 || nodes > max_angle_nodes) return judge.refuse("num_theta", "must be 1 to 15");
  if (lut.front() != 0 || paint.layout.rows() > nodes || paint.layout.slice_count() > max_slices)
    return judge.refuse("layout", "must start at 0 and have at most num_theta + 1 rows and 256 slices");
  for (std::size_t row = 0; row + 1 < lut.size(); ++row)
    if (lut[row + 1] < lut[row] || lut[row + 1] - lut[row] > nodes)
      return judge.refuse(at("layout", row + 1), "a row must have 0 to num_theta + 1 slices");
  if (paint.level0_texels < 1 || paint.level0_texels > max_level0_texels)
    return judge.refuse("level0_texels", "must be 1 to 4096");
  if (paint.level_count != std::bit_width(paint.level0_texels))
    return judge.refuse("level_count", std::to_string(paint.level_count) + " does not lead from " +
                                           std::to_string(paint.level0_texels) + " texels to 1");
  if (auto ok = judge.within(paint.texel_mm, 1e-6, 1e3, "texel_mm"); !ok) return ok;
  if (auto ok = judge.within3(paint.range.lo, -max_lab, max_lab, "range_lo"); !ok) return ok;
  if (auto ok = judge.within3(paint.range.hi, -max_lab, max_lab, "range_hi"); !ok) return ok;
  for (int c = 0; c < 3; ++c)
    if (paint.range.lo[c] > paint.range.hi[c]) return judge.refuse("range_lo", "is above range_hi");
  if (paint.row_mass < 1 || paint.row_mass > max_row_mass) return judge.refuse("row_mass", "must be 1 to 2^30");
  return {};
}

Result<void> check_tuples(const core::InterpolatablePaint& paint, std::size_t rows, const Judge& judge) {
  if (auto ok = check_begin(paint.tuple_begin, rows, core::max_tuples_per_row, paint.mass.size(), "tuple_begin", judge);
      !ok)
    return ok;
  for (std::size_t row = 0; row < rows; ++row) {
    std::uint64_t sum = 0;
    for (std::size_t t = paint.tuple_begin[row]; t < paint.tuple_begin[row + 1]; ++t) {
      if (paint.mass[t] == 0) return judge.refuse(at("mass", t), "must be above 0");
      sum += paint.mass[t];
    }
    if (sum != paint.row_mass)
      return judge.refuse("mass", "row " + std::to_string(row) + " sums to " + std::to_string(sum) + ", not " +
                                      std::to_string(paint.row_mass));
  }
  return {};
}

Result<void> check_clusters(const core::InterpolatablePaint& paint, const core::InterpolatablePaint::PaintPart& part,
                            std::size_t rows, const std::string& name, const Judge& judge) {
  if (auto ok = check_begin(part.cluster_begin, rows, core::max_clusters_per_row, part.clusters.size(),
                            name + ".cluster_begin", judge);
      !ok)
    return ok;
  if (part.tuple_cluster.size() != paint.mass.size())
    return judge.refuse(name + ".tuple_cluster", std::to_string(part.tuple_cluster.size()) + " entries for " +
                                                     std::to_string(paint.mass.size()) + " tuples");
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint32_t clusters = part.cluster_begin[row + 1] - part.cluster_begin[row];
    for (std::size_t t = paint.tuple_begin[row]; t < paint.tuple_begin[row + 1]; ++t)
      if (part.tuple_cluster[t] >= clusters)
        return judge.refuse(name + "." + at("tuple_cluster", t),
                            std::to_string(part.tuple_cluster[t]) + " of " + std::to_string(clusters) + " clusters");
  }
  for (std::size_t k = 0; k < part.clusters.size(); ++k)
    for (std::size_t axis = 0; axis < 6; axis += 2)
      if (part.clusters[k].q[axis] > part.clusters[k].q[axis + 1])
        return judge.refuse(name + "." + at("clusters", k), "lower corner is above the upper one");
  return {};
}

Result<void> check_flakeless(const core::InterpolatablePaint& paint, const Judge& judge) {
  bool empty = paint.mass.empty() && paint.tuple_begin.size() <= 1;
  for (const auto& part : paint.paints)
    empty = empty && part.clusters.empty() && part.tuple_cluster.empty() && part.cluster_begin.size() <= 1;
  return empty ? Result<void>{} : judge.refuse("layout", "is empty, but there are clusters or tuples");
}

}  // namespace

Result<void> check_contents(const PackContents& contents, const std::string& file) {
  const Judge judge{file};
  const core::InterpolatablePaint& paint = contents.paint;
  if (paint.paints.empty() || paint.paints.size() > core::max_paints)
    return judge.refuse("paints", std::to_string(paint.paints.size()) + " paints; a pack has 1 to 5");
  if (auto ok = check_info(contents.info, paint.paints.size(), judge); !ok) return ok;
  if (auto ok = check_layout(paint, judge); !ok) return ok;
  const auto slices = static_cast<std::size_t>(paint.layout.slice_count());
  for (std::size_t k = 0; k < paint.paints.size(); ++k) {
    const std::string name = at("paints", k);
    if (auto ok = check_identity(paint.paints[k].identity, name, judge); !ok) return ok;
    if (auto ok = check_analytic(paint.paints[k].analytic, name, judge); !ok) return ok;
    if (auto ok = check_error(contents.info.errors[k], slices, name + ".error", judge); !ok) return ok;
    if (auto ok = check_life(paint.paints[k].life, name + ".life", judge); !ok) return ok;
  }
  if (slices == 0) return check_flakeless(paint, judge);
  const auto rows = static_cast<std::size_t>(paint.row_count());
  if (auto ok = check_tuples(paint, rows, judge); !ok) return ok;
  for (std::size_t k = 0; k < paint.paints.size(); ++k)
    if (auto ok = check_clusters(paint, paint.paints[k], rows, at("paints", k), judge); !ok) return ok;
  return {};
}

}  // namespace lackwerk::packs

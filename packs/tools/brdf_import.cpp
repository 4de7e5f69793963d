#include "packs/tools/brdf_import.hpp"

#include <algorithm>
#include <functional>
#include <glm/common.hpp>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "core/colour.hpp"
#include "packs/tools/merl_file.hpp"
#include "packs/tools/rgl_file.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::size_t compared_directions = 4096;
constexpr std::uint32_t albedo_samples = 16384;  ///< within 0.5 % of four times as many, for the sharpest film
constexpr std::size_t longest_name = 60;

core::Brdf as_brdf(const core::BrdfTable& table) {
  return [&table](const glm::dvec3& in, const glm::dvec3& out) { return table.at(in, out).value_or(glm::dvec3(0.0)); };
}

/// What every source has in common.
Capture start(const std::string& name, std::string source, const BrdfImportSettings& settings) {
  Capture out;
  if (!settings.note.empty()) source += "; " + settings.note;
  out.identity = {settings.name.empty() ? name : settings.name, std::move(source), settings.provenance,
                  settings.provenance, settings.provenance};
  out.is_fitted = false;
  return out;
}

void judge(const core::Brdf& brdf, const core::BrdfTable& table, BrdfImportReport& report) {
  report.health = core::health(brdf, albedo_samples);
  for (const glm::dvec3& albedo : report.health.albedo)
    report.highest_albedo = std::max({report.highest_albedo, albedo.x, albedo.y, albedo.z});
  report.holes = table.holes();
  for (std::size_t cell = 0; cell < table.size().cells(); ++cell)
    report.cells += core::is_above(core::directions(table.middle(cell))) ? 1u : 0u;
}

/// The text between two others, or nothing.
std::string between(const std::string& text, std::string_view from, std::string_view to) {
  const auto start = text.find(from);
  if (start == std::string::npos) return "";
  const auto end = text.find(to, start + from.size());
  return end == std::string::npos ? "" : text.substr(start + from.size(), end - start - from.size());
}

}  // namespace

std::string rgl_name(const std::string& description, const std::string& stem) {
  const bool is_film = description.find("wrapping film") != std::string::npos;
  const std::string product = is_film ? between(description, "(", ")") : between(description, "(\"", "\")");
  if (!product.empty() && product.size() <= longest_name) return is_film ? product + ", vinyl film" : product;
  if (!description.empty() && description.size() <= longest_name) return description;
  return stem.ends_with("_rgb") ? stem.substr(0, stem.size() - 4) : stem;
}

BrdfDifference difference(const core::Brdf& a, const core::Brdf& b, std::size_t count) {
  const auto lab = [](const core::Brdf& brdf, const core::DirectionPair& pair) {
    // A radiance factor: white's BRDF is 1/pi.
    return core::lab_from_linear(glm::max(brdf(pair.in, pair.out), glm::dvec3(0.0)) * std::numbers::pi);
  };
  std::vector<double> errors;
  for (const core::DirectionPair& pair : core::grid_pairs(count))
    errors.push_back(core::ciede2000(lab(a, pair), lab(b, pair)));
  std::sort(errors.begin(), errors.end());
  BrdfDifference out;
  out.directions = errors.size();
  if (errors.empty()) return out;
  for (const double error : errors) out.mean += error / static_cast<double>(errors.size());
  out.p95 = errors[errors.size() * 95 / 100];
  out.max = errors.back();
  return out;
}

Result<Capture> import_rgl(const std::filesystem::path& file, const BrdfImportSettings& settings,
                           BrdfImportReport& report) {
  const auto material = read_rgl(file);
  if (!material) return tl::unexpected(material.error());
  const std::string stem = file.stem().string();
  const std::string& description = material->description();
  Capture capture = start(rgl_name(description, stem),
                          (description.empty() ? stem : description) +
                              "; RGL material database (Dupuy & Jakob 2018), file " + file.filename().string(),
                          settings);
  const core::Brdf direct = std::cref(*material);
  const core::Brdf mean = core::reciprocal(direct);
  core::BrdfTable table = core::tabulate(mean);
  report.negative_share = material->negative_share();
  judge(direct, table, report);
  report.resampling = difference(as_brdf(table), mean, compared_directions);
  report.from_file = difference(as_brdf(table), direct, compared_directions);
  capture.measured = std::move(table);
  return capture;
}

Result<Capture> import_merl(const std::filesystem::path& file, const BrdfImportSettings& settings,
                            BrdfImportReport& report) {
  auto material = read_merl(file);
  if (!material) return tl::unexpected(material.error());
  const bool is_fit = settings.provenance == core::Provenance::published_fit;
  Capture capture = start(file.stem().string(),
                          std::string(is_fit ? "a published fit in the form of " : "") +
                              "MERL's BRDF database (Matusik et al. 2003), file " + file.filename().string(),
                          settings);
  judge(as_brdf(material->table), material->table, report);
  capture.measured = std::move(material->table);
  return capture;
}

}  // namespace lackwerk::packs

#include "kiosk/display/quality_table.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/check.hpp"
#include "kiosk/display/json_fields.hpp"
#include "packs/small_file.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr const char* remedy = "make it again with 'lackwerk report' on this machine, or leave quality_table empty";
/// CIEDE2000 of black and white is 100; saturated colours lie a little further apart.
constexpr double most_error = 1e3;

constexpr const char* renderer_key = "renderer";
constexpr const char* rungs_key = "rungs";
constexpr const char* name_key = "name";
constexpr const char* cost_key = "cost";
constexpr const char* mean_key = "error_mean";
constexpr const char* p95_key = "error_p95";

std::string field_of(std::size_t rung, const char* key) {
  return std::string(rungs_key) + "[" + std::to_string(rung) + "]." + key;
}

/// A number that must be there; `wrong` names the key otherwise.
double required(const nlohmann::json& object, const char* key, double least, double most, std::string& wrong) {
  const JsonFields fields(object, wrong);
  double value = 0.0;
  if (fields.find(key) == nullptr) fields.refuse(key);
  fields.take(key, value, least, most);
  return value;
}

Result<RungFigure> figure_of(const nlohmann::json& json, std::size_t place, const std::string& file) {
  if (!json.is_object()) return fail(file, field_of(place, name_key), "is no rung", remedy);
  RungFigure figure;
  std::string wrong;
  const JsonFields fields(json, wrong);
  const std::string* name = fields.text(name_key);
  if (name == nullptr || gles::find_rung(*name) == nullptr)
    return fail(file, field_of(place, name_key), "is not the name of a quality of this program", remedy);
  figure.name = *name;
  figure.cost = required(json, cost_key, least_rung_cost, most_rung_cost, wrong);
  figure.error_mean = required(json, mean_key, 0.0, most_error, wrong);
  figure.error_p95 = required(json, p95_key, 0.0, most_error, wrong);
  if (!wrong.empty()) return fail(file, field_of(place, wrong.c_str()), "is missing or no number it can be", remedy);
  return figure;
}

bool in_range(double value, double least, double most) { return value >= least && value <= most; }

}  // namespace

gles::RungCosts QualityTable::costs() const {
  check_equal(rungs.size(), gles::rung_count, "rungs of a quality table");
  gles::RungCosts out;
  for (std::size_t k = 0; k < gles::rung_count; ++k) {
    out.cost[k] = rungs[k].cost;
    out.error[k] = rungs[k].error_mean;
  }
  return out;
}

Result<void> check_quality_table(const QualityTable& table, const std::string& file) {
  const auto ladder = gles::quality_ladder();
  for (std::size_t k = 0; k < ladder.size(); ++k) {
    if (k >= table.rungs.size() || table.rungs[k].name != ladder[k].name)
      return fail(file, rungs_key, "has not every quality once: '" + std::string(ladder[k].name) + "'", remedy);
    const RungFigure& figure = table.rungs[k];
    if (!in_range(figure.cost, least_rung_cost, most_rung_cost))
      return fail(file, field_of(k, cost_key), "is no share of a frame time", remedy);
    if (!in_range(figure.error_mean, 0.0, most_error) || !in_range(figure.error_p95, 0.0, most_error))
      return fail(file, field_of(k, mean_key), "is no colour difference", remedy);
  }
  if (table.rungs.size() > ladder.size()) return fail(file, rungs_key, "has a quality twice", remedy);
  if (table.rungs.front().cost != 1.0)
    return fail(file, field_of(0, cost_key), "is not 1: costs are shares of the first quality's frame time", remedy);
  return {};
}

Result<void> write_quality_table(const std::filesystem::path& path, const QualityTable& table) {
  if (auto good = check_quality_table(table, path.string()); !good) return good;
  nlohmann::ordered_json out{{renderer_key, table.renderer}, {rungs_key, nlohmann::ordered_json::array()}};
  for (const RungFigure& figure : table.rungs)
    out[rungs_key].push_back(
        {{name_key, figure.name}, {cost_key, figure.cost}, {mean_key, figure.error_mean}, {p95_key, figure.error_p95}});
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  // A driver's name need not be UTF-8.
  file << out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  file.close();
  if (!file) return fail(path.string(), "", "cannot be written", "check the folder and the space on the disk");
  return {};
}

Result<QualityTable> read_quality_table(const std::filesystem::path& path) {
  const auto text = packs::read_small_file(path, max_quality_table_bytes);
  if (!text) return tl::unexpected(text.error());
  const std::string file = path.string();
  const auto json = parse_object(*text, file, remedy);
  if (!json) return tl::unexpected(json.error());
  QualityTable table;
  std::string wrong;
  const JsonFields fields(*json, wrong);
  if (const std::string* renderer = fields.text(renderer_key)) table.renderer = *renderer;
  const nlohmann::json* rungs = fields.find(rungs_key);
  if (!wrong.empty()) return fail(file, wrong, "is no text", remedy);
  if (rungs == nullptr || !rungs->is_array()) return fail(file, rungs_key, "is no list of qualities", remedy);
  if (rungs->size() > gles::rung_count) return fail(file, rungs_key, "has more than every quality once", remedy);
  for (std::size_t k = 0; k < rungs->size(); ++k) {
    auto figure = figure_of((*rungs)[k], k, file);
    if (!figure) return tl::unexpected(figure.error());
    table.rungs.push_back(std::move(*figure));
  }
  const auto ladder = gles::quality_ladder();
  const auto place = [&](const RungFigure& figure) {
    return std::find_if(ladder.begin(), ladder.end(), [&](const gles::Rung& rung) { return rung.name == figure.name; });
  };
  std::stable_sort(table.rungs.begin(), table.rungs.end(),
                   [&](const RungFigure& a, const RungFigure& b) { return place(a) < place(b); });
  if (auto good = check_quality_table(table, file); !good) return tl::unexpected(good.error());
  return table;
}

}  // namespace lackwerk::kiosk

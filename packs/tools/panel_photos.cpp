#include "packs/tools/panel_photos.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "core/paint_model.hpp"
#include "packs/tools/camera_picture.hpp"
#include "packs/tools/panel_grid.hpp"
#include "packs/tools/photo_list.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;

/// Photographs this near to each other in both angles are exposures of one geometry.
constexpr double same_angles_deg = 0.05;
constexpr double max_half = 65504.0;

template <class... Numbers>
std::string text_of(const char* format, Numbers... numbers) {
  char text[256];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

/// All exposures of one geometry as one picture of radiance factors below the coat.
struct Shot {
  double theta_h_deg = 0.0, theta_i_deg = 0.0;
  std::vector<std::size_t> photos;  ///< longest exposure first
  std::vector<glm::vec3> texels;
  double clipped = 0.0;  ///< share of the texels that were clipped in every exposure
  double coarsest_mm = 0.0;
};

/// Pictures of whites and darks are used again and again.
class PictureShelf {
 public:
  PictureShelf(fs::path folder, const PhotoList& list) : folder_(std::move(folder)), list_(list) {}

  /// A photograph with its dark taken off.
  Result<CameraPicture> read(const std::string& file, const std::string& own_dark) {
    auto picture = read_camera_picture(folder_ / file, list_.response);
    if (!picture) return picture;
    const std::string& dark = own_dark.empty() ? list_.dark : own_dark;
    if (dark.empty()) return picture;
    const auto offset = shelved(dark, "");
    if (!offset) return tl::unexpected(offset.error());
    if (auto ok = subtract_dark(*picture, **offset, (folder_ / dark).string()); !ok) return tl::unexpected(ok.error());
    return picture;
  }
  Result<const CameraPicture*> white(const WhitePhoto& white) { return shelved(white.file, white.dark, true); }

 private:
  Result<const CameraPicture*> shelved(const std::string& file, const std::string& dark, bool corrected = false) {
    const auto key = std::make_pair(file, dark);
    if (const auto known = shelf_.find(key); known != shelf_.end()) return &known->second;
    // One white and its darks at a time: sixty whites of 24 million pixels would not fit.
    if (shelf_.size() >= most_pictures) shelf_.clear();
    auto picture = corrected ? read(file, dark) : read_camera_picture(folder_ / file, list_.response);
    if (!picture) return tl::unexpected(picture.error());
    return &shelf_.insert_or_assign(key, std::move(*picture)).first->second;
  }

  static constexpr std::size_t most_pictures = 3;
  fs::path folder_;
  const PhotoList& list_;
  std::map<std::pair<std::string, std::string>, CameraPicture> shelf_;
};

/// Light that passes into the coat and out again.
double through_coat(const PanelPhoto& photo, double coat_ior) {
  core::PaintModel<double> model;
  return (1.0 - model.fresnel_dielectric(photo.cos_light, coat_ior)) *
         (1.0 - model.fresnel_dielectric(photo.cos_camera, coat_ior));
}

/// One photograph on the panel's grid: radiance factors outside the coat.
Result<GridPicture> develop(const PhotoList& list, const PanelPhoto& photo, const fs::path& folder,
                            PictureShelf& shelf) {
  const std::string file = (folder / photo.file).string();
  const auto view = PanelView::of(photo.corners_px, list.panel_mm);
  if (!view)
    return fail(file, "corners_px", "are no rectangle seen from above",
                "list top left, top right, bottom right, bottom left as they lie in the picture");
  auto picture = shelf.read(photo.file, photo.dark);
  if (!picture) return tl::unexpected(picture.error());
  const WhitePhoto& white = list.whites[photo.white];
  const auto white_picture = shelf.white(white);
  if (!white_picture) return tl::unexpected(white_picture.error());
  // pi L / E of the panel over that of the white, whose L is reflectance E / pi. E goes with the light's cosine where
  // the white lay otherwise.
  const double lit = white.cos_light > 0.0 ? white.cos_light / photo.cos_light : 1.0;
  const double scale = white.reflectance * lit * white.exposure_s / photo.exposure_s;
  if (auto ok = divide_by_white(*picture, **white_picture, scale, (folder / white.file).string()); !ok)
    return tl::unexpected(ok.error());
  const double size = static_cast<double>(list.capture.texel_mm) * list.capture.edge_texels;
  const PanelGrid grid{0.5 * (list.panel_mm - glm::dvec2(size)), static_cast<double>(list.capture.texel_mm),
                       list.capture.edge_texels};
  auto texels = resample(*picture, *view, grid);
  if (!texels) return fail(file, "corners_px", "the panel's rectangle leaves the picture", "check the corners");
  return std::move(*texels);
}

/// The longest exposure that is not clipped, texel by texel; the shortest where all are.
Result<void> take(const PhotoList& list, const fs::path& folder, PictureShelf& shelf, Shot& shot) {
  std::vector<std::uint8_t> settled;
  for (std::size_t n = 0; n < shot.photos.size(); ++n) {
    const PanelPhoto& photo = list.photos[shot.photos[n]];
    const auto grid = develop(list, photo, folder, shelf);
    if (!grid) return tl::unexpected(grid.error());
    const double inside = 1.0 / through_coat(photo, list.capture.analytic.coat_ior);
    shot.coarsest_mm = std::max(shot.coarsest_mm, grid->coarsest_mm);
    shot.texels.resize(grid->texels.size());
    settled.resize(grid->texels.size());
    for (std::size_t k = 0; k < grid->texels.size(); ++k) {
      if (settled[k] != 0) continue;
      const glm::dvec3 camera(grid->texels[k]);
      for (int c = 0; c < 3; ++c) {
        const glm::dvec3& row = list.to_srgb[static_cast<std::size_t>(c)];
        shot.texels[k][c] = static_cast<float>(inside * (row.x * camera.x + row.y * camera.y + row.z * camera.z));
      }
      settled[k] = grid->clipped[k] == 0 ? 1 : 0;
    }
  }
  const auto open = std::count(settled.begin(), settled.end(), std::uint8_t{0});
  shot.clipped = static_cast<double>(open) / static_cast<double>(settled.size());
  return {};
}

std::vector<Shot> shots_of(const PhotoList& list) {
  std::vector<Shot> out;
  for (std::size_t k = 0; k < list.photos.size(); ++k) {
    const PanelPhoto& photo = list.photos[k];
    auto shot = std::find_if(out.begin(), out.end(), [&](const Shot& s) {
      return std::abs(s.theta_h_deg - photo.theta_h_deg) <= same_angles_deg &&
             std::abs(s.theta_i_deg - photo.theta_i_deg) <= same_angles_deg;
    });
    if (shot == out.end()) {
      out.push_back({photo.theta_h_deg, photo.theta_i_deg, {}, {}, 0.0, 0.0});
      shot = out.end() - 1;
    }
    shot->photos.push_back(k);
  }
  for (Shot& shot : out)
    std::stable_sort(shot.photos.begin(), shot.photos.end(), [&](std::size_t a, std::size_t b) {
      return list.photos[a].exposure_s > list.photos[b].exposure_s;
    });
  return out;
}

/// Which shot a node shows, and how far from it that was taken.
struct NodeShot {
  std::size_t shot = 0;
  double away_deg = 0.0;
  bool photographed = false;  ///< the shot lies within half a bin
};
NodeShot nearest(const std::vector<Shot>& shots, double theta_h_deg, double theta_i_deg, double width_deg) {
  NodeShot out{0, std::numeric_limits<double>::max(), false};
  for (std::size_t k = 0; k < shots.size(); ++k) {
    const double dh = std::abs(shots[k].theta_h_deg - theta_h_deg), di = std::abs(shots[k].theta_i_deg - theta_i_deg);
    const double away = std::hypot(dh, di);
    if (away >= out.away_deg) continue;
    out = {k, away, dh <= 0.5 * width_deg && di <= 0.5 * width_deg};
  }
  return out;
}

/// What a shot is made of: base + mean(flakes) = mean.
struct Split {
  glm::vec3 base{0.0f}, mean{0.0f};
  FlakeSlice flakes;
};
/// Under all flakes lies what the darkest texels show: a low quantile, per channel. Flakes are what exceeds it. The
/// base is what that leaves of the mean, so that noise below the quantile takes nothing away.
Split split(const std::vector<glm::vec3>& texels, double quantile) {
  Split out;
  out.flakes.texels.resize(texels.size());
  std::vector<float> sorted(texels.size());
  const auto rank = static_cast<std::size_t>(quantile * static_cast<double>(texels.size() - 1));
  for (int c = 0; c < 3; ++c) {
    std::transform(texels.begin(), texels.end(), sorted.begin(), [c](const glm::vec3& t) { return t[c]; });
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank), sorted.end());
    const float low = std::max(sorted[rank], 0.0f);
    double all = 0.0, above = 0.0;
    for (std::size_t k = 0; k < texels.size(); ++k) {
      const float flake = std::clamp(texels[k][c] - low, 0.0f, static_cast<float>(max_half));
      out.flakes.texels[k][c] = flake;
      all += static_cast<double>(texels[k][c]);
      above += static_cast<double>(flake);
    }
    const auto count = static_cast<double>(texels.size());
    out.mean[c] = static_cast<float>(std::max(all / count, 0.0));
    out.base[c] = static_cast<float>(std::max((all - above) / count, 0.0));
  }
  return out;
}

/// Rows end after their last photographed slice; rows after the last one that has any are left out.
core::SliceLayout photographed_layout(const core::SliceLayout& layout, const std::vector<NodeShot>& nodes) {
  core::SliceLayout out{layout.num_theta, {0}};
  for (int bin_i = 0; bin_i < layout.rows(); ++bin_i) {
    int count = 0;
    for (int bin_h = 0; layout.slice_at(bin_h, bin_i); ++bin_h)
      if (nodes[static_cast<std::size_t>(*layout.slice_at(bin_h, bin_i))].photographed) count = bin_h + 1;
    out.lut.push_back(static_cast<std::uint16_t>(out.lut.back() + count));
  }
  while (out.rows() > 1 && out.lut[out.lut.size() - 2] == out.lut.back()) out.lut.pop_back();
  return out;
}

void note(ImportNotes* notes, std::string text) {
  if (notes != nullptr) notes->push_back(std::move(text));
}

void tell(const PhotoList& list, const std::vector<Shot>& shots, const std::vector<NodeShot>& nodes,
          const core::SliceLayout& kept, ImportNotes* notes) {
  std::vector<bool> used(shots.size(), false);
  double snapped = 0.0, filled = 0.0;
  int photographed = 0, guessed = 0;
  for (int slice = 0; slice < list.capture.layout.slice_count(); ++slice) {
    const auto node = list.capture.layout.node_of(slice);
    const NodeShot& at = nodes[static_cast<std::size_t>(slice)];
    if (!kept.slice_at(node.bin_h, node.bin_i)) continue;
    used[at.shot] = true;
    photographed += at.photographed ? 1 : 0;
    guessed += at.photographed ? 0 : 1;
    (at.photographed ? snapped : filled) = std::max(at.photographed ? snapped : filled, at.away_deg);
  }
  note(notes, text_of("%d of %d slices were photographed, from up to %.1f degrees beside their angles", photographed,
                      photographed + guessed, snapped));
  if (guessed > 0)
    note(notes, text_of("%d slices show the photograph nearest in angle, up to %.1f degrees away: not measured",
                        guessed, filled));
  const auto unused = std::count(used.begin(), used.end(), false);
  if (unused > 0)
    note(notes, text_of("%d photographs are nearest to no slice and were not used", static_cast<int>(unused)));
  double clipped = 0.0, coarsest = 0.0;
  for (const Shot& shot : shots) {
    clipped = std::max(clipped, shot.clipped);
    coarsest = std::max(coarsest, shot.coarsest_mm);
  }
  if (clipped > 0.0)
    note(notes,
         text_of("up to %.2f %% of the texels of a slice are overexposed: add shorter exposures", 100.0 * clipped));
  if (coarsest > static_cast<double>(list.capture.texel_mm))
    note(notes, text_of("pixels are up to %.3f mm of paint, coarser than texel_mm: flakes are blurred", coarsest));
}

}  // namespace

Result<Capture> import_panel_photos(const fs::path& folder, ImportNotes* notes) {
  const fs::path list_file = folder / "photos.toml";
  const auto list = read_photo_list(list_file);
  if (!list) return tl::unexpected(list.error());
  std::vector<Shot> shots = shots_of(*list);
  PictureShelf shelf(folder, *list);
  std::vector<Split> splits;
  for (Shot& shot : shots) {
    if (auto ok = take(*list, folder, shelf, shot); !ok) return tl::unexpected(ok.error());
    splits.push_back(split(shot.texels, list->base_quantile));
    shot.texels = {};  // the split holds all of it
  }

  const core::SliceLayout& layout = list->capture.layout;
  const double width_deg = layout.bin_width_rad() * 180.0 / std::numbers::pi;
  std::vector<NodeShot> nodes;
  for (int slice = 0; slice < layout.slice_count(); ++slice) {
    const auto node = layout.node_of(slice);
    nodes.push_back(nearest(shots, node.bin_h * width_deg, node.bin_i * width_deg, width_deg));
  }
  Capture capture = list->capture;
  if (!list->fill_missing) capture.layout = photographed_layout(layout, nodes);
  if (capture.layout.slice_count() == 0)
    return fail(list_file.string(), "photo", "no photograph lies within half a bin of a slice", "check the angles");
  for (int slice = 0; slice < capture.layout.slice_count(); ++slice) {
    const auto node = capture.layout.node_of(slice);
    const NodeShot& at = nodes[static_cast<std::size_t>(*layout.slice_at(node.bin_h, node.bin_i))];
    capture.slices.push_back(splits[at.shot].flakes);
  }
  // chi's nodes are those of the slices, and one more at 90 degrees. Where there is no slice there are no flakes, so
  // the table takes the whole mean.
  const auto edge = static_cast<std::size_t>(layout.num_theta) + 1;
  core::ColourTable table{static_cast<std::uint16_t>(edge), std::vector<glm::vec3>(edge * edge)};
  for (int bin_i = 0; bin_i <= layout.num_theta; ++bin_i) {
    for (int bin_h = 0; bin_h <= layout.num_theta; ++bin_h) {
      const NodeShot at = nearest(shots, bin_h * width_deg, bin_i * width_deg, width_deg);
      const Split& there = splits[at.shot];
      table.linear[static_cast<std::size_t>(bin_i) * edge + static_cast<std::size_t>(bin_h)] =
          capture.layout.slice_at(bin_h, bin_i) ? there.base : there.mean;
    }
  }
  capture.analytic.diffuse = glm::dvec3(1.0);
  capture.analytic.table = std::move(table);
  tell(*list, shots, nodes, capture.layout, notes);
  return capture;
}

}  // namespace lackwerk::packs

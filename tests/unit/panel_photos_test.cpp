// Photographs of a panel: a simulated camera before a virtual panel, and the capture comes back.
#include "packs/tools/panel_photos.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/analysis/distribution_error.hpp"
#include "core/colour.hpp"
#include "core/paint_model.hpp"
#include "packs/tools/camera_picture.hpp"
#include "packs/tools/node_geometry.hpp"
#include "packs/tools/panel_grid.hpp"
#include "packs/tools/virtual_goniometer.hpp"
#include "tests/unit/virtual_camera.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;
using test::VirtualCamera;

constexpr double radians = std::numbers::pi / 180.0;
constexpr double bin_deg = 7.5;
constexpr std::uint32_t edge = 128;
constexpr float texel_mm = 0.05f;

/// One geometry of the virtual panel, and its truth: what lies under the flakes, and the flakes, below the coat.
struct PanelNode {
  int bin_h = 0, bin_i = 0;
  glm::dvec3 base{0.0};
  FlakeSlice flakes;
};

Recipe silver() {
  auto recipe = read_recipe(fs::path(LACKWERK_SOURCE_DIR) / "packs" / "recipes" / "gu_polaris_silber_coated.toml");
  EXPECT_TRUE(recipe) << (recipe ? "" : recipe.error().line());
  return recipe ? *recipe : Recipe{};
}

std::vector<PanelNode> virtual_panel(const Recipe& recipe, const std::vector<std::pair<int, int>>& nodes) {
  GoniometerSettings settings;
  settings.edge_texels = edge;
  settings.texel_mm = texel_mm;
  std::vector<PictureAngles> angles;
  angles.reserve(nodes.size());
  for (const auto& [h, i] : nodes) angles.push_back({h * bin_deg * radians, i * bin_deg * radians});
  auto pictures = photographs(recipe, settings, angles);
  EXPECT_TRUE(pictures) << (pictures ? "" : pictures.error().line());
  core::AnalyticPaint lowered = recipe.analytic;
  lowered.lobes[0].s *= 1.0 - recipe.flakes->share;
  std::vector<PanelNode> out;
  for (std::size_t k = 0; pictures && k < nodes.size(); ++k)
    out.push_back({nodes[k].first, nodes[k].second,
                   table_colour(lowered, angles[k].theta_h, angles[k].theta_i) *
                       node_factor(lowered, angles[k].theta_h, angles[k].theta_i),
                   std::move((*pictures)[k])});
  return out;
}

glm::dvec3 mean_of(const std::vector<glm::vec3>& texels) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& texel : texels) sum += glm::dvec3(texel);
  return sum / static_cast<double>(texels.size());
}

/// A direction outside a coat from the one inside.
glm::dvec3 outside(const glm::dvec3& inside, double index) {
  const glm::dvec3 flat = index * glm::dvec3(inside.x, inside.y, 0.0);
  return flat + glm::dvec3(0.0, 0.0, std::sqrt(1.0 - glm::dot(flat, flat)));
}

/// Bounds of the 1-Wasserstein distance between two sets of as many Lab colours. Any pairing bounds from above: of the
/// same places, and by lightness. Projections bound from below (exact on the line).
core::WassersteinBounds distance(std::vector<glm::vec3> a, std::vector<glm::vec3> b) {
  const auto paired = [&] {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += static_cast<double>(glm::distance(a[k], b[k]));
    return sum / static_cast<double>(a.size());
  };
  core::WassersteinBounds out{0.0, paired()};
  for (int axis = 2; axis >= 0; --axis) {
    const auto by_axis = [axis](const glm::vec3& x, const glm::vec3& y) { return x[axis] < y[axis]; };
    std::sort(a.begin(), a.end(), by_axis);
    std::sort(b.begin(), b.end(), by_axis);
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k)
      sum += std::abs(static_cast<double>(a[k][axis]) - static_cast<double>(b[k][axis]));
    out.lower = std::max(out.lower, sum / static_cast<double>(a.size()));
    if (axis == 0) out.upper = std::min(out.upper, paired());
  }
  return out;
}

std::vector<glm::vec3> lab_of(const std::vector<glm::vec3>& texels, const glm::dvec3& more) {
  std::vector<glm::vec3> out;
  out.reserve(texels.size());
  for (const glm::vec3& texel : texels) out.emplace_back(core::lab_from_linear(glm::dvec3(texel) + more));
  return out;
}

class PanelPhotos : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / (std::string("lackwerk_photos_") + info->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  static std::string corner_text(const VirtualCamera& camera) {
    std::ostringstream out;
    out.precision(12);
    const char* comma = "";
    for (const glm::dvec2& c : camera.corners()) {
      out << comma << c.x << ", " << c.y;
      comma = ", ";
    }
    return "[" + out.str() + "]";
  }
  static std::string head(const Recipe& recipe, const std::string& more = "") {
    std::ostringstream out;
    out << "format = 1\nname = \"Virtual panel\"\nsource = \"simulated camera\"\nIOR = " << recipe.analytic.coat_ior
        << "\nrefraction_IOR = " << recipe.analytic.refraction_ior << "\ntexel_mm = 0.05\npanel_mm = [6.4, 6.4]\n"
        << more << "[provenance]\nlobes = \"simulated\"\nflakes = \"simulated\"\ncoat = \"simulated\"\n";
    return out.str();
  }
  /// Photographs each node in `exposures`, with its own white.
  std::string photograph(const Recipe& recipe, const std::vector<PanelNode>& nodes, VirtualCamera camera,
                         const std::vector<double>& exposures) const {
    const double index = recipe.analytic.refraction_ior;
    core::PaintModel<double> model;
    std::ostringstream list;
    std::ostringstream whites;
    std::uint64_t seed = 1;
    const double white_factor = 0.95;
    for (const PanelNode& node : nodes) {
      const NodeGeometry g = node_geometry(node.bin_h * bin_deg * radians, node.bin_i * bin_deg * radians);
      const glm::dvec3 eye = outside(g.eye, index), light = outside(g.light, index);
      const double through = (1.0 - model.fresnel_dielectric(eye.z, recipe.analytic.coat_ior)) *
                             (1.0 - model.fresnel_dielectric(light.z, recipe.analytic.coat_ior));
      camera.to_camera = eye;
      const std::string name = std::to_string(node.bin_h) + "_" + std::to_string(node.bin_i);
      const auto seen = camera.see([&](const glm::dvec2& mm) -> glm::dvec3 {
        // The panel goes on beyond the rectangle: the goniometer's pictures repeat.
        const auto texel = [](double at) {
          const auto k = static_cast<std::int64_t>(std::floor(at / static_cast<double>(texel_mm)));
          return static_cast<std::size_t>((k % std::int64_t{edge} + edge) % edge);
        };
        const std::size_t k = texel(mm.y) * edge + texel(mm.x);
        return through * (node.base + glm::dvec3(node.flakes.texels[k]));
      });
      const auto tile = camera.see([&](const glm::dvec2&) { return glm::dvec3(white_factor); });
      const double white_exposure = 0.6;
      EXPECT_TRUE(camera.write(folder / ("white_" + name + ".png"), camera.expose(tile, white_exposure, ++seed)));
      whites << "[[white]]\nid = \"" << name << "\"\nfile = \"white_" << name
             << ".png\"\nexposure_s = " << white_exposure << "\nreflectance = " << white_factor << "\n";
      for (std::size_t e = 0; e < exposures.size(); ++e) {
        const std::string file = "photo_" + name + "_" + std::to_string(e) + ".png";
        EXPECT_TRUE(camera.write(folder / file, camera.expose(seen, exposures[e], ++seed)));
        list << "[[photo]]\nfile = \"" << file << "\"\nexposure_s = " << exposures[e]
             << "\ntheta_h_deg = " << node.bin_h * bin_deg << "\ntheta_i_deg = " << node.bin_i * bin_deg
             << "\nwhite = \"" << name << "\"\ncorners_px = " << corner_text(camera) << "\n";
      }
    }
    const std::vector<glm::dvec3> nothing(static_cast<std::size_t>(camera.width * camera.height), glm::dvec3(0.0));
    EXPECT_TRUE(camera.write(folder / "dark.png", camera.expose(nothing, 1.0, 99)));
    return "[camera]\nresponse = \"gamma\"\ngamma = 2.2\ndark = \"dark.png\"\n" + whites.str() + list.str();
  }
  void write_list(const std::string& text) const { std::ofstream(folder / "photos.toml") << text; }
  std::string list_text() const {
    std::ifstream stream(folder / "photos.toml");
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  Error error_of_import() const {
    const auto result = import_panel_photos(folder);
    EXPECT_FALSE(result);
    return result ? Error{} : result.error();
  }

  fs::path folder;
};

TEST_F(PanelPhotos, AVirtualPanelComesBack) {
  const Recipe recipe = silver();
  const auto nodes = virtual_panel(recipe, {{0, 0}, {3, 0}, {1, 2}, {2, 4}});
  ASSERT_EQ(nodes.size(), 4u);
  write_list(head(recipe) + photograph(recipe, nodes, {}, {0.4, 0.02}));
  ImportNotes notes;
  const auto capture = import_panel_photos(folder, &notes);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_TRUE(capture->is_fitted);
  EXPECT_EQ(capture->edge_texels, edge);
  EXPECT_EQ(capture->layout, core::axf_layout());
  const bool verbose = std::getenv("LACKWERK_VERBOSE") != nullptr;
  for (const PanelNode& node : nodes) {
    const auto slice = static_cast<std::size_t>(*capture->layout.slice_at(node.bin_h, node.bin_i));
    const double h = node.bin_h * bin_deg * radians, i = node.bin_i * bin_deg * radians;
    const glm::dvec3 base = table_colour(capture->analytic, h, i) * node_factor(capture->analytic, h, i);
    const std::vector<glm::vec3>& flakes = capture->slices[slice].texels;
    const glm::dvec3 wanted = node.base + mean_of(node.flakes.texels), got = base + mean_of(flakes);
    const double mean_error = std::abs(got.y / wanted.y - 1.0), base_error = base.y / node.base.y - 1.0;
    const auto whole = distance(lab_of(flakes, base), lab_of(node.flakes.texels, node.base));
    const auto alone = distance(lab_of(flakes, glm::dvec3(0.0)), lab_of(node.flakes.texels, glm::dvec3(0.0)));
    const double mean_lab = glm::distance(core::lab_from_linear(got), core::lab_from_linear(wanted));
    if (verbose)
      std::printf(
          "h %d i %d: mean %.4f of %.4f (%.2f %%, %.2f Lab), base %+.1f %%, W1 whole %.2f to %.2f, flakes alone %.2f "
          "to %.2f\n",
          node.bin_h, node.bin_i, got.y, wanted.y, 100 * mean_error, mean_lab, 100 * base_error, whole.lower,
          whole.upper, alone.lower, alone.upper);
    const std::string at = std::to_string(node.bin_h) + " " + std::to_string(node.bin_i);
    EXPECT_LT(mean_error, 0.005) << at;           // measured: 0.001
    EXPECT_LT(mean_lab, 0.2) << at;               // measured: 0.04
    EXPECT_LT(std::abs(base_error), 0.05) << at;  // measured: 0.02, noise below the quantile
    EXPECT_LT(whole.upper, 5.0) << at;            // measured: 2.5 to 4, at two pixels a texel; half of it at four
    // A picture of the mean alone is at least twice as far.
    const std::vector<glm::vec3> flat(flakes.size(), glm::vec3(core::lab_from_linear(got)));
    EXPECT_LT(whole.upper, 0.5 * distance(lab_of(flakes, base), flat).lower) << at;
  }
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].rfind("4 of 67 slices were photographed", 0), 0u) << notes[0];
  EXPECT_EQ(notes[1].rfind("63 slices", 0), 0u) << notes[1];
  if (verbose)
    for (const auto& n : notes) std::printf("note: %s\n", n.c_str());
}

/// A panel of one grey behind a straight camera: what only the list decides.
class PanelList : public PanelPhotos {
 protected:
  static constexpr int pixels = 64;
  void grey(const std::string& name, float level, int width = pixels, int height = pixels, int channels = 3) const {
    const auto image = OIIO::ImageOutput::create((folder / name).string());
    const OIIO::ImageSpec spec(width, height, channels,
                               name.ends_with(".png") ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    const std::vector<float> values(static_cast<std::size_t>(width * height * channels), level);
    ASSERT_TRUE(image && image->open((folder / name).string(), spec) &&
                image->write_image(OIIO::TypeDesc::FLOAT, values.data()) && image->close());
  }
  static std::string list(const std::string& photo = "light_deg = 20\ncamera_deg = 0\ncrop_px = [8, 8, 32, 32]\n",
                          const std::string& top = "", const std::string& white = "") {
    return "format = 1\nname = \"Grey\"\nsource = \"here\"\nIOR = 1.0\ntexel_mm = 0.2\npanel_mm = [3.2, 3.2]\n" + top +
           "[provenance]\nlobes = \"measured\"\nflakes = \"measured\"\ncoat = \"simulated\"\n[camera]\nresponse = "
           "\"linear\"\n[[white]]\nfile = \"white.exr\"\nexposure_s = 0.5\nreflectance = 0.9\n" +
           white + "[[photo]]\nfile = \"photo.exr\"\nexposure_s = 2\n" + photo;
  }
};

TEST_F(PanelList, RadianceFactorsAreRelativeToTheWhite) {
  grey("white.exr", 0.5f);
  grey("photo.exr", 0.8f);
  write_list(list());
  auto capture = import_panel_photos(folder);
  ASSERT_TRUE(capture) << capture.error().line();
  // (0.8 / 2) / (0.5 / 0.5) * 0.9, all of it below the flakes.
  EXPECT_EQ(capture->edge_texels, 16u);
  EXPECT_NEAR(capture->analytic.table->linear[0].x, 0.36, 1e-6);
  EXPECT_NEAR(capture->slices[0].texels[0].x, 0.0, 1e-6);
  // A white lit at 60 degrees had half the light.
  write_list(list("light_deg = 0\ncamera_deg = 20\ncrop_px = [8, 8, 32, 32]\n", "", "light_deg = 60\n"));
  capture = import_panel_photos(folder);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_NEAR(capture->analytic.table->linear[0].x, 0.18, 1e-6);
}

TEST_F(PanelList, EmptyRowsAreLeftOutWhereAsked) {
  grey("white.exr", 0.5f);
  grey("photo.exr", 0.8f);
  write_list(list("theta_h_deg = 15\ntheta_i_deg = 7.5\ncrop_px = [8, 8, 32, 32]\n", "missing = \"empty\"\n"));
  const auto capture = import_panel_photos(folder);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_EQ(capture->layout.lut, (std::vector<std::uint16_t>{0, 0, 3}));
}

TEST_F(PanelList, BadListsAreNamed) {
  grey("white.exr", 0.5f);
  grey("photo.exr", 0.8f);
  const std::string crop = "crop_px = [8, 8, 32, 32]\n", view = "light_deg = 20\ncamera_deg = 0\n";
  const std::vector<std::pair<std::string, std::string>> bad = {
      {list(view), "corners_px"},
      {list(view + "crop_px = [8, 8]\n"), "crop_px"},
      {list(view + "corners_px = [1, 2, 3]\n"), "corners_px"},
      {list(view + "corners_px = [8, 8, 8, 40, 40, 40, 40, 8]\n"), "corners_px"},
      {list(view + "crop_px = [50, 8, 32, 32]\n"), "corners_px"},
      {list("light_deg = 85\ncamera_deg = 0\n" + crop), "light_deg"},
      {list("light_deg = nan\ncamera_deg = 0\n" + crop), "light_deg"},
      {list("theta_h_deg = 88\ntheta_i_deg = 0\n" + crop), "theta_h_deg"},
      {list(view + "theta_h_deg = 1\ntheta_i_deg = 1\n" + crop), "light_deg"},
      {list(view + crop + "white = \"other\"\n"), "white"},
      {list(view + crop, "edge_texels = 17\n"), "edge_texels"},
      {list(view + crop, "base_quantile = 2\n"), "base_quantile"},
      {list(view + crop, "missing = \"guess\"\n"), "missing"},
      {list(view + crop, "colour = 1\n"), "colour"},
      {list(view + crop, "", "reflectance_of = 1\n"), "reflectance_of"},
  };
  for (const auto& [text, field] : bad) {
    write_list(text);
    const Error error = error_of_import();
    EXPECT_NE(error.field.find(field), std::string::npos) << error.line();
    EXPECT_EQ(error.line().find('\n'), std::string::npos);
  }
  write_list(list().replace(list().find("texel_mm = 0.2"), 14, "texel_mm = 1e-6"));
  EXPECT_NE(error_of_import().field.find("texel_mm"), std::string::npos);
  write_list(list() + "light");
  EXPECT_NE(error_of_import().field.find("line"), std::string::npos);
  fs::remove(folder / "photos.toml");
  EXPECT_NE(error_of_import().file.find("photos.toml"), std::string::npos);
}

TEST_F(PanelList, BadPicturesAreNamed) {
  write_list(list());
  EXPECT_NE(error_of_import().file.find("photo.exr"), std::string::npos);
  grey("photo.exr", 0.8f);
  EXPECT_NE(error_of_import().file.find("white.exr"), std::string::npos);
  grey("white.exr", 0.0f);
  EXPECT_EQ(error_of_import().what, "the white is black");
  grey("white.exr", 0.5f, 32, 32);
  EXPECT_EQ(error_of_import().field, "size");
  grey("white.exr", 0.5f);
  for (const float level : {-0.5f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    grey("photo.exr", level);
    EXPECT_NE(error_of_import().field.find("pixel 0,0"), std::string::npos) << level;
  }
  grey("photo.exr", 0.5f, pixels, pixels, 1);
  EXPECT_EQ(error_of_import().field, "channels");
  grey("photo.exr", 0.8f);
  for (const std::uintmax_t bytes : {fs::file_size(folder / "photo.exr") / 2, std::uintmax_t{0}}) {
    fs::resize_file(folder / "photo.exr", bytes);
    EXPECT_NE(error_of_import().file.find("photo.exr"), std::string::npos) << bytes;
  }
}

TEST(CameraResponse, CurvesAreTheirOwn) {
  CameraResponse response;
  EXPECT_EQ(response.light(0.25), 0.25);
  response.kind = CameraResponse::Kind::srgb;
  EXPECT_NEAR(response.light(0.5), core::srgb_decode(0.5), 1e-12);
  response.kind = CameraResponse::Kind::gamma;
  EXPECT_NEAR(response.light(0.5), std::pow(0.5, 2.2), 1e-12);
  response.kind = CameraResponse::Kind::table;
  response.points = {{0.0, 0.0}, {0.5, 0.1}, {1.0, 1.0}};
  EXPECT_NEAR(response.light(0.25), 0.05, 1e-12);
  EXPECT_NEAR(response.light(0.75), 0.55, 1e-12);
  EXPECT_NEAR(response.light(1.0), 1.0, 1e-12);
}

TEST(PanelGrid, CornersAreCornersAndStraightLinesStayStraight) {
  const std::array<glm::dvec2, 4> corners{glm::dvec2(10, 12), glm::dvec2(90, 20), glm::dvec2(80, 70),
                                          glm::dvec2(18, 62)};
  const auto view = PanelView::of(corners, {40.0, 20.0});
  ASSERT_TRUE(view);
  EXPECT_LT(glm::distance(view->pixel({40.0, 0.0}), corners[1]), 1e-9);
  EXPECT_LT(glm::distance(view->pixel({40.0, 20.0}), corners[2]), 1e-9);
  EXPECT_LT(glm::distance(view->pixel({0.0, 20.0}), corners[3]), 1e-9);
  // Diagonals meet in the middle.
  const glm::dvec2 middle = view->pixel({20.0, 10.0}), a = corners[2] - corners[0], b = corners[3] - corners[1];
  EXPECT_NEAR(a.x * (middle - corners[0]).y - a.y * (middle - corners[0]).x, 0.0, 1e-9);
  EXPECT_NEAR(b.x * (middle - corners[1]).y - b.y * (middle - corners[1]).x, 0.0, 1e-9);
  EXPECT_FALSE(PanelView::of({corners[0], corners[3], corners[2], corners[1]}, {1.0, 1.0}));  // the wrong way round
  EXPECT_FALSE(PanelView::of({corners[0], corners[2], corners[1], corners[3]}, {1.0, 1.0}));  // crossed
  EXPECT_FALSE(PanelView::of({corners[0], corners[0], corners[0], corners[0]}, {1.0, 1.0}));
}

TEST(PanelGrid, TexelsAreTheSameForAnyNumberOfThreads) {
  CameraPicture picture{40, 40, {}, std::vector<std::uint8_t>(1600, 0)};
  for (int k = 0; k < 1600; ++k)
    picture.light.emplace_back(static_cast<float>(k % 37), static_cast<float>(k % 11), 1.0f);
  const auto view =
      PanelView::of({glm::dvec2(2, 3), glm::dvec2(38, 5), glm::dvec2(36, 37), glm::dvec2(4, 35)}, {4.0, 4.0});
  ASSERT_TRUE(view);
  const PanelGrid grid{{0.0, 0.0}, 0.25, 16};
  const auto one = resample(picture, *view, grid, 1), many = resample(picture, *view, grid, 5);
  ASSERT_TRUE(one && many);
  EXPECT_EQ(one->texels, many->texels);
  EXPECT_FALSE(resample(picture, *view, {{-2.0, 0.0}, 0.25, 16}, 1));
}

}  // namespace
}  // namespace lackwerk::packs

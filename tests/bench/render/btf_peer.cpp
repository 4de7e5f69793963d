#include "tests/bench/render/btf_peer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "core/analysis/mip_chain.hpp"
#include "core/check.hpp"
#include "core/environment.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::bench {
namespace {

constexpr int page_edge = 4096;
constexpr int page_count = 2;
/// What takes the place of flake_factor. Each picture's block: level 0, and to its right the smaller ones below each
/// other; every level has a border of one texel that repeats the other side, so that linear filtering shows no seam.
constexpr const char* look_up = R"(
uniform sampler2D u_page0;
uniform sampler2D u_page1;
uniform float u_page_scale;
uniform float u_edge;           // texels of level 0
uniform float u_blocks_across;  // and down: blocks of a page
uniform float u_blocks_down;
vec3 btf_tap(float bin_h, float bin_i, vec2 texel, float level) {
  vec4 where = fetch_slice(bin_h, bin_i);
  if (where.y > 0.5) return vec3(0.0);
  float slice = floor(where.x * 255.0 + 0.5);
  float per_page = u_blocks_across * u_blocks_down;
  float page = floor((slice + 0.5) / per_page);
  float block = slice - page * per_page;
  float down = floor((block + 0.5) / u_blocks_across);
  float across = block - down * u_blocks_across;
  float shrink = exp2(-level);
  float edge = floor(u_edge * shrink + 1e-3);
  vec2 origin = vec2(across * BLOCK_WIDTH, down * BLOCK_HEIGHT) + vec2(1.0);
  if (level > 0.5) origin += vec2(u_edge + 2.0, LEVEL_ROWS);
  vec2 at = (origin + fract(texel / u_edge) * edge) / PAGE_EDGE;
  vec4 t = page < 0.5 ? texture2D(u_page0, at) : texture2D(u_page1, at);
  vec3 root = t.xyz * t.w;
  return root * root * u_page_scale;
}
vec3 btf_level(float fh, float fi, vec2 texel, float level) {
#if FLAKE_TAPS == 1
  return btf_tap(floor(fh + 0.5), floor(fi + 0.5), texel, level);
#else
  float h0 = floor(fh);
  float i0 = floor(fi);
  float wh = fh - h0;
  float wi = fi - i0;
  return mix(mix(btf_tap(h0, i0, texel, level), btf_tap(h0 + 1.0, i0, texel, level), wh),
             mix(btf_tap(h0, i0 + 1.0, texel, level), btf_tap(h0 + 1.0, i0 + 1.0, texel, level), wh), wi);
#endif
}
vec3 flake_factor(real theta_h, real theta_i, vec2 texel, real lod) {
  float fh = theta_h * u_bins_per_rad;
  float fi = theta_i * u_bins_per_rad;
  float last = u_level_count - 1.0;
  if (lod >= last) return flake_mean(theta_h, theta_i);
  float l = max(lod, 0.0);
  float l0 = floor(l);
  float f = l - l0;
  vec3 sum = btf_level(fh, fi, texel, l0) * (1.0 - f);
  if (f > 0.0) sum += (l0 + 1.0 >= last ? flake_mean(theta_h, theta_i) : btf_level(fh, fi, texel, l0 + 1.0)) * f;
  return sum;
}
)";

/// Rows above level k >= 1 in its column: 2 (k - 1) border rows and the edges of levels 1 to k - 1.
int rows_above(int edge, int level) {
  int rows = 0;
  for (int k = 1; k < level; ++k) rows += (edge >> k) + 2;
  return rows;
}

/// The same as an expression of GLSL, which has no integers to shift. The largest level is asked first.
std::string rows_text(int edge, int levels) {
  std::string text;
  for (int k = levels - 1; k >= 2; --k)
    text.append("level > ")
        .append(std::to_string(k))
        .append(".0 - 0.5 ? ")
        .append(std::to_string(rows_above(edge, k)))
        .append(".0 : ");
  return "(" + text + "0.0)";
}

struct Atlas {
  int edge = 0, across = 0, down = 0, width = 0, height = 0;
  float range = 1.0f;
  std::array<std::vector<std::uint8_t>, page_count> pages;
};

void copy_level(const core::MipLevel& level, int x0, int y0, float range, std::vector<std::uint8_t>& page) {
  const int edge = static_cast<int>(level.edge);
  for (int y = -1; y <= edge; ++y)
    for (int x = -1; x <= edge; ++x) {
      const int from = (y + edge) % edge * edge + (x + edge) % edge;
      std::uint8_t* to =
          &page[4 * (static_cast<std::size_t>(y0 + y + 1) * page_edge + static_cast<std::size_t>(x0 + x + 1))];
      core::encode_radiance(glm::dvec3(level.texels[static_cast<std::size_t>(from)]), range, to);
    }
}

Result<Atlas> make_atlas(const packs::Capture& capture) {
  Atlas out;
  out.edge = static_cast<int>(capture.edge_texels);
  out.width = out.edge + 2 + out.edge / 2 + 2;
  out.height = std::max(out.edge + 2, rows_above(out.edge, core::mip_level_count(capture.edge_texels)));
  out.across = page_edge / out.width;
  out.down = page_edge / out.height;
  const int per_page = out.across * out.down;
  if (capture.slices.empty() || static_cast<int>(capture.slices.size()) > per_page * page_count)
    return fail("capture", "slices", "do not fit into two textures of 4096 texels", "capture with 480 texels");
  float most = 0.0f;
  for (const auto& slice : capture.slices)
    for (const glm::vec3& texel : slice.texels) most = std::max({most, texel.x, texel.y, texel.z});
  out.range = std::max(most, 1e-3f);
  for (auto& page : out.pages) page.resize(std::size_t{4} * page_edge * page_edge);
  for (std::size_t k = 0; k < capture.slices.size(); ++k) {
    const int block = static_cast<int>(k) % per_page;
    const int x = block % out.across * out.width, y = block / out.across * out.height;
    const auto levels = core::mip_chain(capture.slices[k].texels, capture.edge_texels);
    for (int level = 0; level < static_cast<int>(levels.size()); ++level)
      copy_level(levels[static_cast<std::size_t>(level)], level > 0 ? x + out.edge + 2 : x,
                 level > 0 ? y + rows_above(out.edge, level) : y, out.range,
                 out.pages[k / static_cast<std::size_t>(per_page)]);
  }
  return out;
}

gles::GlObject upload_page(const gles::GlApi& gl, const std::vector<std::uint8_t>& page) {
  gles::GlObject texture = gles::make_texture(gl);
  gl.BindTexture(GL_TEXTURE_2D, texture.id());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, page_edge, page_edge, 0, GL_RGBA, GL_UNSIGNED_BYTE, page.data());
  return texture;
}

/// The surface's shader; for `plain` with the look-up in place of the flakes' own function.
std::string shader(const gles::Features& features, bool highp, const Atlas& atlas, bool plain) {
  std::string text = gles::fragment_source(features, highp);
  if (!plain) return text;
  const std::string head = "vec3 flake_factor(";
  const auto at = text.find(head);
  check_equal(at != std::string::npos, true, "the paint model has a flake_factor");
  text.replace(at, head.size(), "vec3 statistics_factor(");  // nothing calls it any more
  const auto number = [](const char* name, int value) {
    return std::string("#define ") + name + " " + std::to_string(value) + ".0\n";
  };
  text.insert(at, number("BLOCK_WIDTH", atlas.width) + number("BLOCK_HEIGHT", atlas.height) +
                      number("PAGE_EDGE", page_edge) + "#define LEVEL_ROWS " +
                      rows_text(atlas.edge, core::mip_level_count(static_cast<std::uint32_t>(atlas.edge))) + look_up);
  return text;
}

double mean_byte(const gles::Image& image) {
  double sum = 0.0;
  for (const std::uint8_t byte : image.rgb) sum += byte;
  return sum / static_cast<double>(image.rgb.size());
}

/// One way of drawing the paint parts of a scene under one light.
class Way {
 public:
  Way(Stage& stage, const gles::MeshBuffers& mesh, const Atlas& atlas, const gles::Features& features, bool plain)
      : gl_(&stage.context().gl()), stage_(&stage), mesh_(&mesh) {
    id_ = gles::link_program(*gl_, gles::vertex_source(features),
                             shader(features, stage.context().info().fragment_highp, atlas, plain),
                             {"a_position", "a_normal", "a_irradiance", "a_visible0", "a_visible1", "a_visible2"},
                             plain ? "look-up" : "statistics");
    gl_->UseProgram(id_.id());
    number("u_page_scale", atlas.range);
    number("u_edge", static_cast<float>(atlas.edge));
    number("u_blocks_across", static_cast<float>(atlas.across));
    number("u_blocks_down", static_cast<float>(atlas.down));
    set_paint();
  }

  void draw(const gles::View& view) const {
    const gles::Framebuffer& target = stage_->target();
    std::vector<gles::Box> boxes;
    for (const auto& part : mesh_->draws()) boxes.push_back(part.box);
    const glm::mat4 clip = gles::clip_from_world(view, target.width(), target.height(), boxes);
    const float texels_per_m = 1000.0f / stage_->paint().texel_mm;
    target.bind();
    gl_->ClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl_->Enable(GL_DEPTH_TEST);
    gl_->Enable(GL_CULL_FACE);
    gl_->UseProgram(id_.id());
    gl_->UniformMatrix4fv(at("u_clip_from_world"), 1, GL_FALSE, &clip[0][0]);
    gl_->Uniform3f(at("u_eye"), view.eye_mm.x, view.eye_mm.y, view.eye_mm.z);
    gl_->Uniform4f(at("u_frame"), 1.0f, 0.0f, gles::pixel_size_per_mm(view, target.height()) * texels_per_m,
                   texels_per_m);
    const glm::vec3 light = glm::normalize(glm::normalize(view.eye_mm - view.target_mm) + glm::vec3(0.0f, 0.1f, 0.3f));
    gl_->Uniform3f(at("u_light_dir"), light.x, light.y, light.z);
    gl_->Uniform3f(at("u_light"), 1.0f, 1.0f, 1.0f);
    for (const auto& part : mesh_->draws())
      if (part.surface == packs::SurfaceKind::paint) mesh_->draw(*gl_, part);
    gl_->Finish();
  }

 private:
  [[nodiscard]] GLint at(const char* name) const { return gl_->GetUniformLocation(id_.id(), name); }
  void number(const char* name, float value) const { gl_->Uniform1f(at(name), value); }

  void set_paint() const {
    const core::AnalyticPaint& paint = stage_->renderer().paint()->analytic();
    const core::PaintTextures& textures = stage_->renderer().paint()->textures();
    const core::InterpolatablePaint& source = stage_->paint();
    gl_->Uniform3f(at("u_diffuse"), static_cast<float>(paint.diffuse.x), static_cast<float>(paint.diffuse.y),
                   static_cast<float>(paint.diffuse.z));
    std::array<float, 4 * core::max_lobes> lobes{};
    std::array<float, core::max_lobes> inverse{};
    for (std::size_t k = 0; k < core::max_lobes; ++k) {
      for (int c = 0; c < 3; ++c) lobes[4 * k + static_cast<std::size_t>(c)] = static_cast<float>(paint.lobes[k].s[c]);
      lobes[4 * k + 3] = static_cast<float>(paint.lobes[k].f0);
      inverse[k] = static_cast<float>(1.0 / paint.lobes[k].m);
    }
    GLint count = core::max_lobes;
    while (count > 1 && at(("u_lobe[" + std::to_string(count - 1) + "]").c_str()) < 0) --count;
    gl_->Uniform4fv(at("u_lobe"), count, lobes.data());
    gl_->Uniform3f(at("u_inv_m"), inverse[0], inverse[1], inverse[2]);
    number("u_coat_ior", static_cast<float>(paint.coat_ior));
    number("u_refraction_ior", static_cast<float>(paint.refraction_ior));
    number("u_table_size", static_cast<float>(std::max(textures.table_size, 1)));
    number("u_chi_scale", textures.chi_scale);
    number("u_slice_count", static_cast<float>(source.layout.slice_count()));
    number("u_level_count", source.level_count);
    number("u_bins_per_rad", static_cast<float>(1.0 / source.layout.bin_width_rad()));
    const auto cells = source.flake_cells_per_bin();
    gl_->Uniform2f(at("u_flake_cells"), static_cast<float>(cells[0]), static_cast<float>(cells[1]));
    gl_->Uniform2f(at("u_corner_size"), static_cast<float>(3 * textures.width),
                   static_cast<float>(textures.asked_rows));
    const glm::vec3 lo = source.range.lo, span = source.range.hi - source.range.lo;
    gl_->Uniform3f(at("u_lab_lo"), lo.x, lo.y, lo.z);
    gl_->Uniform3f(at("u_lab_span"), span.x, span.y, span.z);
    int unit = 0;
    for (const char* name : {"u_chi", "u_mean", "u_slice", "u_rank", "u_corner", "u_random"})
      gl_->Uniform1i(at(name), unit++);
    gl_->Uniform1i(at("u_page0"), 6);
    gl_->Uniform1i(at("u_page1"), 7);
  }

  const gles::GlApi* gl_;
  Stage* stage_;
  const gles::MeshBuffers* mesh_;
  gles::GlObject id_;
};

}  // namespace

Result<void> compare_with_btf(Stage& stage, const std::string& capture, int rounds, Report& report) {
  auto read = packs::read_capture(capture);
  if (!read) return tl::unexpected(read.error());
  if (read->layout != stage.paint().layout || read->edge_texels != stage.paint().level0_texels)
    return fail(capture, "layout", "is not the pack's", "give the capture that the pack's first paint was made from");
  auto atlas = make_atlas(*read);
  if (!atlas) return tl::unexpected(atlas.error());
  std::vector<double> first(stage.paint().paints.size(), 0.0);
  first[0] = 1.0;
  if (auto ok = stage.renderer().update(core::Weights::uniform(first)); !ok) return ok;
  stage.renderer().bring_flakes(0);

  const gles::GlApi& gl = stage.context().gl();
  const gles::MeshBuffers mesh(gl, stage.scene());
  gles::Features features;
  features.flakes = true;
  features.path = gles::ShaderPath::none;
  features.lights = features.flake_lights = 1;
  for (const auto& part : mesh.draws())
    if (part.surface == packs::SurfaceKind::paint) features.visibility = part.visibility;
  stage.renderer().paint()->add_features(features);

  std::vector<gles::Features> kinds(3, features);
  kinds[0].flake_taps = 1, kinds[0].flake_cells = 1;
  kinds[1].flake_taps = 4, kinds[1].flake_cells = 1;
  kinds[2].flake_taps = 4, kinds[2].flake_cells = 4;
  const std::vector<std::string> names = {"nearest slice, one cell", "four slices, one cell",
                                          "four slices, four cells"};
  std::vector<std::unique_ptr<Way>> statistics, pictures;
  for (const gles::Features& kind : kinds)
    statistics.push_back(std::make_unique<Way>(stage, mesh, *atlas, kind.canonical(), false));
  for (const std::size_t k : {0u, 1u})
    pictures.push_back(std::make_unique<Way>(stage, mesh, *atlas, kinds[k].canonical(), true));
  gles::Features mean = features;
  mean.flake_lights = 0;
  const Way without(stage, mesh, *atlas, mean.canonical(), false);

  // Units 0 to 5: what the paint has; 6 and 7: the pictures.
  const gles::Program binder(gl, kinds[2].canonical(), stage.context().info().fragment_highp);
  binder.use();
  stage.renderer().paint()->apply(gl, binder);
  std::array<gles::GlObject, page_count> pages;
  for (std::size_t k = 0; k < page_count; ++k) {
    gl.ActiveTexture(GL_TEXTURE6 + static_cast<GLenum>(k));
    pages[k] = upload_page(gl, atlas->pages[k]);
  }
  for (const char* camera : {"hero", "rim", "macro"}) {
    report.title("Statistics against the flake pictures themselves, one light, paint alone, " + std::string(camera));
    std::vector<Candidate> all = {{"the flakes' mean", [&](int k) { without.draw(stage.view(camera, k)); }, {}, {}}};
    for (std::size_t w = 0; w < pictures.size(); ++w)
      all.push_back({"pictures, " + std::string(w == 0 ? "nearest slice" : "four slices"),
                     [&, w](int k) { pictures[w]->draw(stage.view(camera, k)); },
                     {},
                     {}});
    for (std::size_t w = 0; w < statistics.size(); ++w)
      all.push_back({"statistics, " + names[w], [&, w](int k) { statistics[w]->draw(stage.view(camera, k)); }, {}, {}});
    run_rounds(all, rounds);
    report.table(all);
    // Proof that both draw the same paint: at equal light the mean of their pictures must be alike.
    pictures[0]->draw(stage.view(camera, 0));
    const double of_pictures = mean_byte(stage.target().read());
    statistics[0]->draw(stage.view(camera, 0));
    report.value("mean byte, statistics over pictures", mean_byte(stage.target().read()) / of_pictures, "", 1);
    report.compare("statistics over pictures, nearest", all[3], all[1], "GK17: 1.46");
    report.compare("statistics over pictures, four slices", all[4], all[2]);
    report.compare("statistics with random cells over pictures, four slices", all[5], all[2]);
  }
  report.title("Bytes of the flakes on the GPU");
  double texels = 0.0;
  for (std::uint32_t edge = read->edge_texels; edge > 0; edge /= 2) texels += double{1} * edge * edge;
  const double of_pictures = 4.0 * texels * static_cast<double>(read->slices.size());
  const double of_statistics = static_cast<double>(stage.renderer().paint()->bytes());
  report.value("pictures and their mip levels, one paint", of_pictures * 1e-6, "MB", 1);
  report.value("statistics of all paints of the pack", of_statistics * 1e-6, "MB", 1);
  report.value("pictures over statistics", of_pictures / of_statistics, "", 1);
  return {};
}

}  // namespace lackwerk::bench

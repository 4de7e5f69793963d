#include "render_gles/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "core/check.hpp"
#include "render_gles/display_model.hpp"

namespace lackwerk::gles {
namespace {

/// The floor's mirror image is drawn this much smaller than the picture: the polished floor blurs it anyway.
constexpr int mirror_reduction = 3;
constexpr int smallest_mirror_px = 32;

/// Boxes of the paint's triangles, gathered in cells of a grid by their middles.
std::vector<Box> paint_cells(const packs::Scene& scene) {
  constexpr float cell_mm = 400.0f;
  std::map<std::array<int, 3>, Box> cells;
  for (const packs::MeshPart& part : scene.parts) {
    if (part.kind != packs::SurfaceKind::paint) continue;
    for (std::size_t k = 0; k + 2 < part.indices.size(); k += 3) {
      Box triangle;
      for (std::size_t corner = 0; corner < 3; ++corner) triangle.include(part.positions_mm[part.indices[k + corner]]);
      const glm::vec3 middle = triangle.centre() / cell_mm;
      cells[{static_cast<int>(std::floor(middle.x)), static_cast<int>(std::floor(middle.y)),
             static_cast<int>(std::floor(middle.z))}]
          .include(triangle);
    }
  }
  std::vector<Box> boxes;
  boxes.reserve(cells.size());
  for (const auto& [key, box] : cells) boxes.push_back(box);
  return boxes;
}

}  // namespace

Renderer::Renderer(Context& context)
    : context_(context), gl_(context.gl()), programs_(context), screen_(context), materials_(context.gl()) {}

Renderer::~Renderer() {
  // A context that cannot be made current any more has taken its objects with it.
  (void)context_.make_current();
}

void Renderer::set_scene(const packs::Scene& scene) {
  mesh_ = MeshBuffers(gl_, scene);
  boxes_.clear();
  paint_boxes_.clear();
  bounds_ = {};
  for (const MeshBuffers::Draw& draw : mesh_.draws()) {
    boxes_.push_back(draw.box);
    bounds_.include(draw.box);
  }
  paint_boxes_ = paint_cells(scene);
  environment_texture_ = upload_environment(gl_, scene.environment);
  environment_ = scene.environment;
  environment_.atlas.clear();
  environment_.atlas.shrink_to_fit();
  irradiance_range_ = scene.irradiance_range;
  // Of the cut into 16: of 64 the four strongest would hold too little of a room's light, and moving pictures would
  // sparkle less than resting ones.
  sparkle_ = core::lights_of(environment_, 16);
  sparkle_.resize(std::min(sparkle_.size(), static_cast<std::size_t>(max_lights)));
  ++revision_;
  check_gl(gl_, "upload of a scene");
}

Result<void> Renderer::set_paint(const core::InterpolatablePaint& paint, const PaintMap* map) {
  auto made = PaintGpu::create(context_, paint, map);
  if (!made) return tl::unexpected(made.error());
  paint_ = std::move(*made);
  ++revision_;
  return {};
}

Result<void> Renderer::update(const core::Weights& weights) {
  check_equal(paint_.has_value(), true, "set_paint before update");
  const auto changed = paint_->update(weights);
  if (!changed) return tl::unexpected(changed.error());
  if (!*changed) return {};
  paint_->count_upload(materials_.set_paint(gl_, paint_->source(), paint_->analytic(), paint_->textures()));
  ++revision_;
  return {};
}

Renderer::Frame Renderer::frame_of(const View& view, const Lighting& lighting, const Framebuffer& target) const {
  Frame frame{view, lighting, target.width(), target.height(), target.texture(), revision_};
  // The strongest shows single flakes first.
  std::stable_sort(frame.lighting.lights.begin(), frame.lighting.lights.end(),
                   [](const DirectionalLight& a, const DirectionalLight& b) {
                     return core::luminance_of(glm::dvec3(a.radiance)) > core::luminance_of(glm::dvec3(b.radiance));
                   });
  return frame;
}

bool Renderer::needs_draw(const View& view, const Lighting& lighting, const Framebuffer& target) const {
  return drawn_ != frame_of(view, lighting, target);
}

bool Renderer::flakes_show(const View& view, int height, double contrast) const {
  if (!paint_ || !paint_->has_flakes()) return false;
  if (keep_.single_flakes) return true;
  // 16-bit floats cannot tell the texels of a car apart, nor the rare ranks.
  if (!context_.info().fragment_highp) return false;
  return finest_level(view, height) < paint_->calm_level(contrast);
}

double Renderer::finest_level(const View& view, int height) const {
  float nearest = 1e30f;
  for (const Box& box : paint_boxes_)
    nearest = std::min(nearest, glm::distance(glm::clamp(view.eye_mm, box.lo, box.hi), view.eye_mm));
  // surface_lod at normal view.
  const float texels = nearest * pixel_size_per_mm(view, height) / paint_->texel_mm();
  return static_cast<double>(std::log2(std::max(texels, 1e-4f)) + 0.585f);
}

Renderer::Pass Renderer::moving_pass(const Frame& frame) const {
  const Quality& quality = frame.lighting.quality;
  const std::vector<DirectionalLight>& lights = frame.lighting.lights;
  Pass pass;
  pass.path = quality.path == LightPath::none       ? ShaderPath::none
              : quality.path == LightPath::filtered ? ShaderPath::filtered
                                                    : ShaderPath::mirror;
  pass.lights =
      std::span(lights).first(std::min(lights.size(), static_cast<std::size_t>(usable_lights(context_.info()))));
  const bool single = (quality.flakes == FlakeMode::nearest || quality.flakes == FlakeMode::bilinear) &&
                      flakes_show(frame.view, frame.height, moving_contrast);
  pass.flake_lights = single ? quality.flake_lights : 0;
  if (single && pass.path == ShaderPath::filtered)
    pass.sparkle_lights = std::min({quality.sparkle_lights, static_cast<int>(sparkle_.size()),
                                    usable_sparkle_lights(context_.info(), static_cast<int>(lights.size()))});
  pass.detail = quality.coarse ? packs::detail_coarse : packs::detail_full;
  pass.floor_mirror = quality.floor_mirror && pass.path != ShaderPath::none && !frame.lighting.stripes &&
                      mesh_.has(packs::SurfaceKind::floor);
  return pass;
}

std::vector<Renderer::Pass> Renderer::light_passes(const Frame& frame, std::vector<DirectionalLight>& cut) const {
  const Pass whole = moving_pass(frame);
  cut.clear();
  const std::vector<core::EnvironmentLight> lights_of_room =
      core::lights_of(environment_, frame.lighting.quality.cut_lights);
  const double parts = effective_parts(lights_of_room);
  for (const core::EnvironmentLight& light : lights_of_room)
    cut.push_back({light.direction, light.radiance * frame.lighting.environment_gain});
  const auto at_once = static_cast<std::size_t>(std::max(usable_lights(context_.info()), 1));
  // The mood's lights are the stronger ones: single flakes are theirs first.
  int flake_lights = whole.flake_lights;
  std::vector<Pass> passes;
  const auto add = [&](std::span<const DirectionalLight> lights, int of_cut) {
    Pass pass = whole;
    pass.lights = lights;
    pass.cut = of_cut;
    pass.parts = parts;
    pass.flake_lights = std::min(flake_lights, static_cast<int>(lights.size()));
    flake_lights -= pass.flake_lights;
    passes.push_back(pass);
  };
  if (!whole.lights.empty()) add(whole.lights, 0);
  for (std::size_t first = 0; first < cut.size(); first += at_once)
    add(std::span(cut).subspan(first, std::min(at_once, cut.size() - first)), static_cast<int>(cut.size()));
  // The cut's first pass brings the environment and the background, so it is drawn first.
  if (!whole.lights.empty()) std::rotate(passes.begin(), passes.begin() + 1, passes.end());
  for (std::size_t k = 1; k < passes.size(); ++k) {
    passes[k].path = ShaderPath::none;
    passes[k].floor_mirror = false;
    passes[k].black = true;
  }
  return passes;
}

std::vector<Renderer::Pass> Renderer::passes_of(const Frame& frame, std::vector<DirectionalLight>& cut) const {
  if (frame.lighting.quality.path == LightPath::lights && !frame.lighting.stripes) return light_passes(frame, cut);
  return {moving_pass(frame)};
}

LightShares Renderer::shares_of(packs::SurfaceKind kind, const Pass& pass) const {
  LightShares all{};
  all.fill(1.0f);
  if (pass.cut == 0) return all;
  if (kind != packs::SurfaceKind::paint) return light_shares(packs::material_of(kind).surface, 1.0, pass.parts);
  return paint_ ? light_shares(paint_->analytic(), paint_->flake_roughness(), pass.parts) : all;
}

std::vector<const MeshBuffers::Draw*> Renderer::order_of(const View& view, const Pass& pass, bool glass) const {
  std::vector<const MeshBuffers::Draw*> order;
  for (const MeshBuffers::Draw& draw : mesh_.draws()) {
    if ((draw.detail & pass.detail) == 0) continue;
    // In the mirror image glass is a dark surface among others.
    if (!pass.mirrored && (draw.surface == packs::SurfaceKind::glass) != glass) continue;
    if (pass.mirrored && draw.surface == packs::SurfaceKind::floor) continue;
    order.push_back(&draw);
  }
  // Front to back, so that the depth test spares hidden paint its shading; the floor lies behind nearly everything.
  // Glass is blended: back to front.
  const auto key = [&](const MeshBuffers::Draw* draw) {
    const float distance = glm::distance(draw->box.centre(), view.eye_mm);
    return std::pair(draw->surface == packs::SurfaceKind::floor, glass ? -distance : distance);
  };
  std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) { return key(a) < key(b); });
  return order;
}

void Renderer::draw_parts(const std::vector<const MeshBuffers::Draw*>& parts, const Frame& frame, const Pass& pass,
                          const glm::mat4& clip) {
  std::vector<const Program*> applied;  // programs keep their uniforms: set them once a pass
  for (const MeshBuffers::Draw* part : parts) {
    const Program& program = programs_.get(features_of(*part, frame.lighting, pass));
    if (std::find(applied.begin(), applied.end(), &program) == applied.end()) {
      apply_frame(program, frame, pass, clip);
      apply_material(program, part->surface, frame, pass);
      applied.push_back(&program);
    }
    program.use();
    mesh_.draw(gl_, *part);
  }
}

void Renderer::draw_pass(const Frame& frame, const Pass& pass, const Framebuffer& target) {
  if (paint_ && (pass.flake_lights > 0 || pass.sparkle_lights > 0 || pass.still_flakes))
    bring_flakes(static_cast<int>(std::floor(finest_level(frame.view, frame.height))));
  std::vector<Box> boxes = boxes_;
  if (pass.mirrored)
    for (Box& box : boxes) {
      const float low = box.lo.z;
      box.lo.z = -box.hi.z;
      box.hi.z = -low;
    }
  glm::mat4 clip = clip_from_world(frame.view, frame.width, frame.height, boxes);
  if (pass.mirrored) clip[2] = -clip[2];  // z of the world turned over

  target.bind();
  glm::vec4 sky(0.0f);
  if (!pass.mirrored && !pass.black) {
    const glm::vec3& backdrop = frame.lighting.backdrop;
    sky = glm::vec4(pass.output == ShaderOutput::display ? DisplayModel<float>().display_transform(backdrop) : backdrop,
                    1.0f);
  }
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_SCISSOR_TEST);
  if (pass.strips > 1) {
    const int from = target.height() * pass.strip / pass.strips, to = target.height() * (pass.strip + 1) / pass.strips;
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Scissor(0, from, target.width(), to - from);
  }
  gl_.ClearColor(sky.x, sky.y, sky.z, sky.w);
  gl_.ClearDepthf(1.0f);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  if (pass.mirrored) {
    gl_.Disable(GL_CULL_FACE);
  } else {
    gl_.Enable(GL_CULL_FACE);
  }
  gl_.CullFace(GL_BACK);
  gl_.FrontFace(pass.mirrored ? GL_CW : GL_CCW);
  gl_.Disable(GL_DITHER);
  View from = frame.view;
  if (pass.mirrored) from.eye_mm.z = -from.eye_mm.z;
  draw_parts(order_of(from, pass, false), frame, pass, clip);

  if (!pass.mirrored && mesh_.has(packs::SurfaceKind::glass)) {
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_.DepthMask(GL_FALSE);
    draw_parts(order_of(from, pass, true), frame, pass, clip);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_BLEND);
  }
  if (pass.strips > 1) gl_.Disable(GL_SCISSOR_TEST);
  check_gl(gl_, "drawing a frame");
}

void Renderer::draw_mirror(const Frame& frame) {
  const int width = std::max(frame.width / mirror_reduction, smallest_mirror_px);
  const int height = std::max(frame.height / mirror_reduction, smallest_mirror_px);
  if (!mirror_ || mirror_->width() != width || mirror_->height() != height) {
    auto made = Framebuffer::create(context_, width, height);
    check_equal(made.has_value(), true, "a mirror image is smaller than a picture that could be drawn");
    mirror_ = std::move(*made);
  }
  Pass pass;
  pass.output = ShaderOutput::mirror_image;
  pass.detail = packs::detail_coarse;
  pass.lights = std::span(frame.lighting.lights).first(std::min<std::size_t>(frame.lighting.lights.size(), 1));
  pass.mirrored = true;
  draw_pass(frame, pass, *mirror_);
}

void Renderer::add_passes(const Frame& frame, const std::vector<Pass>& passes, Accumulator& sum) {
  for (std::size_t k = 0; k < passes.size(); ++k) {
    Pass pass = passes[k];
    pass.output = sum.linear() ? ShaderOutput::linear : ShaderOutput::display;
    draw_pass(frame, pass, sum.frame());
    if (k == 0) {
      sum.add(screen_);
    } else {
      sum.add_to_last(screen_);
    }
  }
}

void Renderer::draw_moving(const Frame& frame, const Framebuffer& target) {
  std::vector<DirectionalLight> cut;
  const std::vector<Pass> passes = passes_of(frame, cut);
  if (passes.front().floor_mirror) draw_mirror(frame);
  if (passes.size() == 1) {
    draw_pass(frame, passes.front(), target);
    return;
  }
  check_equal(ensure_accumulator(frame.width, frame.height).has_value(), true, "targets as large as the picture");
  accumulator_->reset();
  add_passes(frame, passes, *accumulator_);
  accumulator_->show(screen_, target, frame.lighting.dither, 1.0f);
  refined_.reset();
}

void Renderer::draw(const View& view, const Lighting& lighting, const Framebuffer& target) {
  check_at_most(lighting.lights.size(), static_cast<std::size_t>(max_lights), "directional lights");
  if (mesh_.has(packs::SurfaceKind::paint) && !lighting.stripes)
    check_equal(paint_ && !paint_->pending(), true, "set_paint and update before a scene with paint is drawn");
  const Frame frame = frame_of(view, lighting, target);
  const float scale = std::clamp(lighting.quality.scale, 0.25f, 1.0f);
  if (scale < 1.0f || lighting.quality.smooth_edges) {
    Frame own = frame;
    own.width = std::max(1, static_cast<int>(std::lround(static_cast<float>(frame.width) * scale)));
    own.height = std::max(1, static_cast<int>(std::lround(static_cast<float>(frame.height) * scale)));
    if (!unfinished_ || unfinished_->width() != own.width || unfinished_->height() != own.height) {
      auto made = Framebuffer::create(context_, own.width, own.height);
      check_equal(made.has_value(), true, "a picture no larger than one that could be drawn");
      unfinished_ = std::move(*made);
    }
    draw_moving(own, *unfinished_);
    if (lighting.quality.smooth_edges) {
      screen_.smooth(*unfinished_, target);
    } else {
      screen_.copy(unfinished_->texture(), target, 1.0f, ScreenPass::Blend::replace);
    }
  } else {
    draw_moving(frame, target);
  }
  target.bind();
  left_out_flakes_ = !flakes_show(view, frame.height, moving_contrast);
  drawn_ = frame;
  refined_.reset();
  ++draws_;
}

void Renderer::prepare(const View& view, const Lighting& lighting, const Framebuffer& target) {
  const Frame frame = frame_of(view, lighting, target);
  std::vector<DirectionalLight> cut;
  const std::vector<Pass> passes = passes_of(frame, cut);
  for (const Pass& pass : passes)
    for (const MeshBuffers::Draw& draw : mesh_.draws()) programs_.get(features_of(draw, lighting, pass));
}

GpuBytes Renderer::gpu_bytes() const {
  GpuBytes out;
  out.geometry = mesh_.bytes();
  if (environment_texture_) out.environment = std::size_t{core::environment_width} * core::environment_height * 4;
  if (paint_) out.paint = paint_->bytes();
  out.materials = MaterialTable::bytes();
  if (mirror_) out.pictures += mirror_->bytes();
  if (unfinished_) out.pictures += unfinished_->bytes();
  if (accumulator_) out.pictures += accumulator_->bytes();
  return out;
}

}  // namespace lackwerk::gles

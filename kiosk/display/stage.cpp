#include "kiosk/display/stage.hpp"

#include <charconv>
#include <utility>

#include "core/check.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr int smallest_edge_px = 16;
constexpr int largest_edge_px = 8192;

bool read_edge(const char*& at, const char* end, int& edge) {
  const auto [next, code] = std::from_chars(at, end, edge);
  at = next;
  return code == std::errc{} && edge >= smallest_edge_px && edge <= largest_edge_px;
}

}  // namespace

Result<void> Stage::set_up(int width, int height) {
  if (scene_.cameras.empty())
    return fail(scene_.name, "cameras", "the scene has no camera", "rebuild it with 'lackwerk scene build'");
  if (auto sized = resize(width, height); !sized) return sized;
  return show();
}

/// Draws with what the pack that is there needs. On an error nothing has changed.
Result<void> Stage::show() {
  if (shows_scans()) {
    show_scans();
    return {};
  }
  // The renderer keeps where the paint is, not what it is.
  std::unique_ptr<gles::Renderer> fresh;
  if (!renderer_) {
    fresh = std::make_unique<gles::Renderer>(*context_);
    fresh->set_scene(scene_);
  }
  gles::Renderer& renderer = fresh ? *fresh : *renderer_;
  if (auto taken = renderer.set_paint(pack_.paints()->paint()); !taken) return taken;
  if (fresh) renderer_ = std::move(fresh);
  scan_renderer_.reset();
  cameras_ = scene_.cameras;
  return {};
}

void Stage::show_scans() {
  if (!scan_renderer_) scan_renderer_ = std::make_unique<gles::ScanRenderer>(*context_);
  scan_renderer_->set_pack(*pack_.scans());
  renderer_.reset();
  // As scenes' cameras are made: for 16 to 9. From a little above, where most of a plant's leaves are seen.
  constexpr double azimuth_deg = 30.0, height_deg = 14.0, aspect = 16.0 / 9.0;
  const gles::View view = scan_renderer_->view_from(azimuth_deg, height_deg, aspect);
  cameras_ = {packs::Camera{"scans", view.eye_mm, view.target_mm, view.vertical_fov_deg}};
}

gles::Renderer& Stage::renderer() {
  check_equal(renderer_ != nullptr, true, "the stage shows paints");
  return *renderer_;
}

gles::ScanRenderer& Stage::scan_renderer() {
  check_equal(scan_renderer_ != nullptr, true, "the stage shows scans");
  return *scan_renderer_;
}

Result<void> Stage::resize(int width, int height) {
  auto framebuffer = gles::Framebuffer::create(*context_, width, height);
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  framebuffer_ = std::make_unique<gles::Framebuffer>(std::move(*framebuffer));
  return {};
}

Result<void> Stage::set_pack(packs::ExhibitPack pack) {
  std::swap(pack_, pack);
  auto taken = show();
  if (!taken) std::swap(pack_, pack);
  return taken;
}

Result<std::unique_ptr<Stage>> Stage::create(gles::Backend backend, int width, int height, packs::ExhibitPack pack,
                                             packs::Scene scene, const gles::ContextSettings& settings) {
  auto context = gles::create_context(backend, settings);
  if (!context) return tl::unexpected(context.error());
  auto stage = create(**context, width, height, std::move(pack), std::move(scene));
  if (stage) (*stage)->own_context_ = std::move(*context);
  return stage;
}

Result<std::unique_ptr<Stage>> Stage::create(gles::Context& context, int width, int height, packs::ExhibitPack pack,
                                             packs::Scene scene) {
  // The constructor is private, so make_unique cannot be used.
  std::unique_ptr<Stage> stage(new Stage(std::move(pack), std::move(scene)));
  stage->context_ = &context;
  if (auto ready = stage->set_up(width, height); !ready) return tl::unexpected(ready.error());
  return stage;
}

Result<Size> parse_size(const std::string& text) {
  Size size;
  const char* at = text.data();
  const char* end = at + text.size();
  if (read_edge(at, end, size.width) && at != end && *at++ == 'x' && read_edge(at, end, size.height) && at == end)
    return size;
  return fail("", "--size", "'" + text + "' is not a size", "write WIDTHxHEIGHT with edges from 16 to 8192 pixels",
              ErrorKind::usage);
}

}  // namespace lackwerk::kiosk

#include "kiosk/display/stage.hpp"

#include <charconv>

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

Result<std::unique_ptr<Stage>> Stage::create(gles::Backend backend, int width, int height, packs::PaintPack pack,
                                             packs::Scene scene, const gles::ContextSettings& settings) {
  if (scene.cameras.empty())
    return fail(scene.name, "cameras", "the scene has no camera", "rebuild it with 'lackwerk scene build'");
  // The constructor is private, so make_unique cannot be used.
  std::unique_ptr<Stage> stage(new Stage(std::move(pack), std::move(scene)));
  auto context = gles::create_context(backend, settings);
  if (!context) return tl::unexpected(context.error());
  stage->context_ = std::move(*context);
  auto framebuffer = gles::Framebuffer::create(*stage->context_, width, height);
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  stage->framebuffer_ = std::make_unique<gles::Framebuffer>(std::move(*framebuffer));
  stage->renderer_ = std::make_unique<gles::Renderer>(*stage->context_);
  stage->renderer_->set_scene(stage->scene_);
  if (auto taken = stage->renderer_->set_paint(stage->pack_.paint()); !taken) return tl::unexpected(taken.error());
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

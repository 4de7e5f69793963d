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

Result<void> Stage::set_up(int width, int height) {
  if (scene_.cameras.empty())
    return fail(scene_.name, "cameras", "the scene has no camera", "rebuild it with 'lackwerk scene build'");
  if (auto sized = resize(width, height); !sized) return sized;
  renderer_ = std::make_unique<gles::Renderer>(*context_);
  renderer_->set_scene(scene_);
  return renderer_->set_paint(pack_.paint());
}

Result<void> Stage::resize(int width, int height) {
  auto framebuffer = gles::Framebuffer::create(*context_, width, height);
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  framebuffer_ = std::make_unique<gles::Framebuffer>(std::move(*framebuffer));
  return {};
}

Result<void> Stage::set_pack(packs::PaintPack pack) {
  // The renderer keeps where the paint is, not what it is.
  std::swap(pack_, pack);
  auto taken = renderer_->set_paint(pack_.paint());
  if (!taken) std::swap(pack_, pack);
  return taken;
}

Result<std::unique_ptr<Stage>> Stage::create(gles::Backend backend, int width, int height, packs::PaintPack pack,
                                             packs::Scene scene, const gles::ContextSettings& settings) {
  auto context = gles::create_context(backend, settings);
  if (!context) return tl::unexpected(context.error());
  auto stage = create(**context, width, height, std::move(pack), std::move(scene));
  if (stage) (*stage)->own_context_ = std::move(*context);
  return stage;
}

Result<std::unique_ptr<Stage>> Stage::create(gles::Context& context, int width, int height, packs::PaintPack pack,
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

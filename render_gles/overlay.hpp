// Puts the interface on the finished picture: tiles as textures, placed on a copy of the picture.
//
// Why it exists: the picture under the interface goes on being refined, so nothing may be drawn into it; and what does
// not change must not be sent again. Owns its textures, framebuffers and programs; the context must be current
// and outlive it; one GL thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "render_gles/context.hpp"
#include "render_gles/framebuffer.hpp"
#include "render_gles/gl_object.hpp"

namespace lackwerk::gles {

/// A tile on the picture, px from its upper left corner; it may hang over the picture's edges. Drawn one to one: what a
/// sprite is larger than its tile stays empty. Tiles nobody has set are left out.
struct OverlaySprite {
  std::uint32_t tile = 0;
  int x_px = 0, y_px = 0, width_px = 0, height_px = 0;
  float opacity = 1.0f;
  bool operator==(const OverlaySprite&) const = default;
};

/// What happens to the picture on its way, besides the sprites.
struct OverlayLook {
  int drift_x_px = 0, drift_y_px = 0;  ///< all of it, against burn-in; what comes in from the border repeats its edge
  float brightness = 1.0f;             ///< of the display values, [0, 1]
  /// Left of this the held picture shows, in parts of the width (Overlay::hold); < 0: none.
  float split = -1.0f;
  float held = 0.0f;  ///< opacity of the held picture over all of it, under the sprites, [0, 1]: a cross-fade from it
  bool operator==(const OverlayLook&) const = default;
};

class Overlay {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Overlay>> create(Context& context);

  /// Sends a tile: premultiplied B, G, R, A bytes in display values. `stride_bytes` >= 4 width. A tile of this number
  /// is replaced. Bounds: 4096 px an edge, max_tiles tiles.
  void set_tile(std::uint32_t tile, int width, int height, int stride_bytes, const unsigned char* bgra);
  void drop_tile(std::uint32_t tile);
  static constexpr std::size_t max_tiles = 256;

  /// Keeps a copy of this picture for `split`.
  [[nodiscard]] Result<void> hold(const Framebuffer& picture);
  void let_go();

  /// The picture with the sprites on it, in a framebuffer of the picture's size that this owns; valid until the next
  /// call. Where there is nothing to do (no sprites, a plain look) it is the picture itself and nothing is drawn.
  [[nodiscard]] Result<const Framebuffer*> compose(const Framebuffer& picture, std::span<const OverlaySprite> sprites,
                                                   const OverlayLook& look);
  /// Bytes of tiles sent since the beginning.
  [[nodiscard]] std::uint64_t sent_bytes() const { return sent_bytes_; }

 private:
  struct Program {
    GlObject program;
    GLint texture = -1, factor = -1;
  };
  struct Tile {
    GlObject texture;
    int width = 0, height = 0;
  };
  /// Pixels of the target from its upper left corner, and where they come from, in [0, 1] of a texture.
  struct Quad {
    double left = 0, top = 0, right = 0, bottom = 0;
    std::array<double, 2> from{0, 0}, to{1, 1};
  };
  /// A quad that is drawn, after those before it.
  struct Drawn {
    const Program* program = nullptr;
    GLuint texture = 0;
    float factor = 1.0f;
  };
  explicit Overlay(Context& context);
  [[nodiscard]] Program make(int texture, bool factor) const;
  [[nodiscard]] Result<void> fit(std::optional<Framebuffer>& target, const Framebuffer& picture) const;
  void copy(const Framebuffer& from, const Framebuffer& to, int left, int right, const OverlayLook& look) const;
  void add(const Quad& quad, const Drawn& how, const Framebuffer& target);
  void add_borders(const Framebuffer& from, const Framebuffer& to, int left, int right, const OverlayLook& look);
  void add_sprites(std::span<const OverlaySprite> sprites, const OverlayLook& look, const Framebuffer& target);
  void draw(const Framebuffer& target, float brightness);

  const Context* context_;
  const GlApi* gl_;
  Program picture_, fading_, tile_, faint_tile_, dimming_;
  GlObject vertices_;
  std::vector<float> corners_;  ///< of this call's quads
  std::vector<Drawn> drawn_;    ///< how each of them is drawn
  std::map<std::uint32_t, Tile> tiles_;
  std::vector<unsigned char> rows_;  ///< scratch, kept for its memory
  std::optional<Framebuffer> target_, held_;
  std::uint64_t sent_bytes_ = 0;
};

}  // namespace lackwerk::gles

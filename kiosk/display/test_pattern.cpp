#include "kiosk/display/test_pattern.hpp"

#include <algorithm>
#include <array>

namespace lackwerk::kiosk {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour white{255, 255, 255}, black{0, 0, 0}, red{255, 0, 0}, ground{96, 96, 96};
/// Half of white's light: what a board of black and white pixels looks like from a distance (srgb_encode(0.5) * 255).
constexpr Colour half_light{188, 188, 188};
/// Dark and bright steps each, and how far apart.
constexpr int steps = 16;
constexpr int step_size = 2;

Colour grey(int value) {
  const auto v = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
  return {v, v, v};
}

struct Box {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Calls colour(x - box.x, y - box.y) for every pixel of the box that the picture has.
template <class F>
void fill(gles::Image& image, const Box& box, const F& colour) {
  const auto width = static_cast<std::size_t>(image.width);
  for (int y = std::max(0, box.y); y < std::min(image.height, box.y + box.height); ++y)
    for (int x = std::max(0, box.x); x < std::min(image.width, box.x + box.width); ++x) {
      const Colour c = colour(x - box.x, y - box.y);
      std::copy(c.begin(), c.end(),
                &image.rgb[(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * 3]);
    }
}

/// A frame one pixel thick, `inside` pixels from the edge.
void frame(gles::Image& image, int inside, const Colour& colour) {
  const Box box{inside, inside, image.width - 2 * inside, image.height - 2 * inside};
  const auto same = [&](int, int) { return colour; };
  fill(image, {box.x, box.y, box.width, 1}, same);
  fill(image, {box.x, box.y + box.height - 1, box.width, 1}, same);
  fill(image, {box.x, box.y, 1, box.height}, same);
  fill(image, {box.x + box.width - 1, box.y, 1, box.height}, same);
}

/// Single pixels, with upright lines to the left and level lines to the right.
void sharpness(gles::Image& image, int centre_x, int centre_y, int edge) {
  const auto odd = [](int k) { return k % 2 == 0 ? white : black; };
  const int x = centre_x - edge / 2, y = centre_y - edge / 2;
  fill(image, {x, y, edge, edge}, [&](int i, int j) { return odd(i + j); });
  fill(image, {x - edge / 2, y, edge / 2, edge}, [&](int i, int) { return odd(i); });
  fill(image, {x + edge, y, edge / 2, edge}, [&](int, int j) { return odd(j); });
}

/// Two rows: at full and at half of the pixel value.
void colours(gles::Image& image, const Box& box) {
  static constexpr std::array<Colour, 8> full = {red,           {0, 255, 0},   {0, 0, 255}, {0, 255, 255},
                                                 {255, 0, 255}, {255, 255, 0}, white,       black};
  fill(image, box, [&](int x, int y) {
    Colour c = full[static_cast<std::size_t>(x * 8 / box.width)];
    if (y >= box.height / 2)
      for (std::uint8_t& v : c) v = v == 255 ? 128 : 0;
    return c;
  });
}

void greys(gles::Image& image, const Box& box) {
  const int ramp = box.height / 2;
  fill(image, {box.x, box.y, box.width, ramp}, [&](int x, int) { return grey(x * 255 / std::max(1, box.width - 1)); });
  fill(image, {box.x, box.y + ramp, box.width, box.height - ramp}, [&](int x, int) {
    const int step = x * 2 * steps / box.width;
    return grey(step < steps ? step * step_size : 255 - (2 * steps - 1 - step) * step_size);
  });
}

void arrow_up(gles::Image& image, int centre_x, int top, int edge) {
  fill(image, {centre_x - edge / 2, top, edge, edge / 2},
       [&](int x, int y) { return std::abs(2 * x + 1 - edge) <= 2 * y + 1 ? white : ground; });
  fill(image, {centre_x - edge / 8, top + edge / 2, std::max(1, edge / 4), edge / 2}, [](int, int) { return white; });
}

}  // namespace

gles::Image test_pattern(int width, int height) {
  gles::Image image(width, height);
  fill(image, {0, 0, width, height}, [](int, int) { return ground; });
  const int least = std::min(width, height);
  const int board = std::max(2, least / 10);
  const int inset = std::max(board, least / 8);
  const int left = width / 8, across = width - 2 * left;

  // Everything between the boards: arrow, ramp and steps, board, colours.
  arrow_up(image, width / 2, height / 16, std::max(4, least / 8));
  greys(image, {left, height * 4 / 16, across, height * 3 / 16});
  colours(image, {left, height * 10 / 16, across, height * 3 / 16});
  for (const int x : {inset, width - inset})
    for (const int y : {inset, height - inset}) sharpness(image, x, y, board);
  const int middle = std::min(board, height / 12);
  fill(image, {width / 2 - 2 * middle, height * 17 / 32 - middle * 3 / 4, 4 * middle, middle * 3 / 2},
       [](int, int) { return half_light; });
  sharpness(image, width / 2, height * 17 / 32, middle);

  fill(image, {0, 0, least / 16, least / 16}, [&](int x, int y) { return x + y < least / 16 ? red : ground; });
  for (const int inside : {least / 40, 0}) {
    frame(image, inside + 1, black);
    frame(image, inside, white);
  }
  return image;
}

}  // namespace lackwerk::kiosk

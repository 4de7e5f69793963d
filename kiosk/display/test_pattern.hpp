// A picture to judge a panel by: edges, sharpness, steps, colours, and which way is up.
//
// Why it exists: overscan, a scaler in the panel, a crushed black or a wrong profile are found in a minute with it and
// in a month without. It is made for the panel's own resolution and goes through the same last pass as every picture.
// Pure; any thread.
#pragma once

#include "render_gles/image.hpp"

namespace lackwerk::kiosk {

/// sRGB values. What to look for, from above:
/// - all four outermost lines of pixels are white, the next ones black: a missing line is overscan; further frames
/// stand
///   2.5 % inside;
/// - an arrow points up, and the upper left corner has the only red triangle;
/// - five boards of single black and white pixels, in the corners and the middle, with single lines to their sides:
///   even grey from a distance; a coarse pattern in them is a scaler at work. The middle one lies on a field of half of
///   white's light: from a distance it vanishes in it where the profile's curve is the panel's;
/// - a smooth ramp, and below it the sixteen darkest and the sixteen brightest values, two apart: all must differ;
/// - red, green, blue, cyan, magenta, yellow, white and black at full, and at half of the pixel value.
/// Edges in [1, max_image_edge]; below about 160 px parts overlap.
[[nodiscard]] gles::Image test_pattern(int width, int height);

}  // namespace lackwerk::kiosk

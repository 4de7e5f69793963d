// The interface's few colours, and how they are shown to be readable.
//
// Why it exists: text must reach 4.5:1 over any paint. All text lies on glass that lets so little through that this
// holds over white; the reckoning is below and a test repeats it on drawn pixels. Constants; any thread.
#pragma once

namespace lackwerk::kiosk::ui {

/// sRGB values, [0, 1]; not premultiplied.
struct Colour {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
  [[nodiscard]] constexpr Colour with(double alpha) const { return {r, g, b, alpha}; }
};

/// Over white, glass shows 0.26 + 0.74 * 0.04 = 0.29 at most: relative luminance 0.068 (WCAG 2.1). `text` (0.90) then
/// has 8:1, `quiet` (0.57) 5.2:1, `accent` (0.56) 5.2:1.
inline constexpr Colour glass{0.034, 0.037, 0.043, 0.74};
/// Cards are read for longer and have small type.
inline constexpr Colour card_glass{0.034, 0.037, 0.043, 0.88};
inline constexpr Colour text_colour{0.95, 0.955, 0.96};
inline constexpr Colour quiet{0.78, 0.785, 0.79};
/// Warm against the cool studio; used for what is on, open or focused, and nothing else.
inline constexpr Colour accent{0.98, 0.75, 0.40};
/// Edges of glass, tracks.
inline constexpr Colour hairline{1.0, 1.0, 1.0, 0.12};
inline constexpr Colour track{1.0, 1.0, 1.0, 0.34};
/// Under a finger. Lightens glass over white to 0.36, luminance 0.107: `text` still has 6:1.
inline constexpr Colour pressed_tint{1.0, 1.0, 1.0, 0.10};
/// Controls while a knob turns another one; text is never dimmed.
inline constexpr double dimmed = 0.45;
inline constexpr Colour shadow{0.0, 0.0, 0.0, 0.55};

}  // namespace lackwerk::kiosk::ui

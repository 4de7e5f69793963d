// Sets text with Pango: Inter for Latin, DejaVu Sans for Arabic, whatever the system has for the rest.
//
// Why it exists: shaping, bidirectional order, line breaks and ellipses are Pango's; sizes, weights and boxes are ours.
// Owns the font map's contexts; one thread.
#pragma once

#include <cairo.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "core/error.hpp"
#include "kiosk/display/ui/layout.hpp"
#include "kiosk/display/ui/theme.hpp"

typedef struct _PangoContext PangoContext;  // NOLINT(modernize-use-using,bugprone-reserved-identifier): Pango's names
typedef struct _PangoLayout PangoLayout;    // NOLINT(modernize-use-using,bugprone-reserved-identifier)

namespace lackwerk::kiosk::ui {

enum class Weight : std::uint8_t { light, regular, medium };
/// Along the line: leading is left in left-to-right languages.
enum class Align : std::uint8_t { leading, centre, trailing };

struct TextStyle {
  double size_px = 15.0;
  Weight weight = Weight::regular;
  Colour colour = text_colour;
  Align align = Align::leading;
  int lines = 1;              ///< at most; what does not fit ends in an ellipsis
  double spacing_em = 0.0;    ///< between letters, in parts of the size (Latin only: Arabic letters join)
  bool from_top = false;      ///< else in the middle of the box's height
  bool machine_text = false;  ///< codes and figures: left to right in every language
};

class Fonts {
 public:
  /// Error: the system has no font at all.
  [[nodiscard]] static Result<std::unique_ptr<Fonts>> create();
  ~Fonts();
  Fonts(const Fonts&) = delete;
  Fonts& operator=(const Fonts&) = delete;

  /// Of the texts to come.
  void set_language(Language language);

  /// Draws within the box; returns what the text covers.
  Rect draw(cairo_t* cr, std::string_view text, const TextStyle& style, const Rect& box);
  /// Width and height the text takes within `width` px.
  [[nodiscard]] std::array<double, 2> measure(std::string_view text, const TextStyle& style, double width);

 private:
  Fonts() = default;
  void prepare(std::string_view text, const TextStyle& style, double width);

  struct Unref {
    void operator()(PangoContext* context) const;
    void operator()(PangoLayout* layout) const;
  };
  std::unique_ptr<PangoContext, Unref> context_;
  std::unique_ptr<PangoLayout, Unref> layout_;
  Language language_ = Language::english;
};

}  // namespace lackwerk::kiosk::ui

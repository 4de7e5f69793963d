// A contact sheet: captioned pictures in a grid.
//
// Why it exists: pictures are judged side by side, today's beside the last ones. A pure function over images; one
// thread.
#pragma once

#include <string>
#include <vector>

#include "render_gles/image.hpp"

namespace lackwerk::tools {

struct Tile {
  std::string caption;
  gles::Image image;
};

/// Lays tiles out in rows of `columns` (at least 1), each cell as large as the largest tile, on dark grey, with the
/// captions below in DejaVu Sans (left out where that font is not installed).
[[nodiscard]] gles::Image contact_sheet(const std::vector<Tile>& tiles, int columns);

/// Half the size in both directions, each pixel the mean of four (in encoded values). For sheets.
[[nodiscard]] gles::Image halved(const gles::Image& image);

}  // namespace lackwerk::tools

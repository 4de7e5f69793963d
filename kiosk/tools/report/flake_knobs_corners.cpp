#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <utility>

#include "core/analysis/flake_clusters.hpp"
#include "core/colour.hpp"
#include "kiosk/tools/report/flake_knobs.hpp"
#include "kiosk/tools/report/flake_knobs_slices.hpp"

namespace lackwerk::report {

namespace {

using core::LabCuboid;
using Points = std::vector<glm::vec3>;

/// In [0, 1), the same on every standard library.
double uniform(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

// ---- precision of corners

/// IEC 60559 binary16, rounded to nearest even; |value| below 65504.
std::uint16_t half_from(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000u);
  const std::uint32_t size = bits & 0x7fffffffu;
  if (size < 0x38800000u)  // below 2^-14: steps of 2^-24
    return static_cast<std::uint16_t>(sign | std::lround(std::abs(value) * 16777216.0f));
  const std::uint32_t rounded = size + 0xfffu + (size >> 13 & 1u);
  return static_cast<std::uint16_t>(sign | ((rounded >> 13) - (112u << 10)));
}

float from_half(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16;
  const std::uint32_t size = half & 0x7fffu;
  if (size < 0x400u) return std::copysign(static_cast<float>(size) / 16777216.0f, std::bit_cast<float>(sign));
  return std::bit_cast<float>(sign | ((size << 13) + (112u << 23)));
}

/// How one corner's coordinate is kept: stored = store(value, lo, span).
struct Precision {
  const char* label;
  double bits;  ///< for the axis of the plot: digits of the fraction
  double bytes_a_tuple;
  std::uint16_t (*store)(float value, float lo, float span);
  float (*load)(std::uint16_t stored, float lo, float span);
};

template <int bits>
std::uint16_t store_grid(float value, float lo, float span) {
  constexpr float most = static_cast<float>((1 << bits) - 1);
  return static_cast<std::uint16_t>(std::clamp((value - lo) / span * most + 0.5f, 0.0f, most));
}
template <int bits>
float load_grid(std::uint16_t stored, float lo, float span) {
  constexpr float most = static_cast<float>((1 << bits) - 1);
  return lo + span * (static_cast<float>(stored) / most);
}

constexpr std::array<Precision, 4> precisions = {{
    {"8 bits", 8, 6, store_grid<8>, load_grid<8>},
    {"12 bits", 12, 9, store_grid<12>, load_grid<12>},
    {"16 bits", 16, 12, store_grid<16>, load_grid<16>},
    {"half float", 11, 12, [](float value, float, float) { return half_from(value); },
     [](std::uint16_t stored, float, float) { return from_half(stored); }},
}};

/// Corners of some boxes, stored.
using Stored = std::vector<std::array<std::uint16_t, 6>>;

void store_all(const std::vector<LabCuboid>& boxes, const Precision& kept, const core::LabRange& range, Stored& out) {
  out.resize(boxes.size());
  const glm::vec3 span = range.hi - range.lo;
  for (std::size_t k = 0; k < boxes.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      out[k][2 * a] = kept.store(boxes[k].lo[axis], range.lo[axis], span[axis]);
      out[k][2 * a + 1] = kept.store(boxes[k].hi[axis], range.lo[axis], span[axis]);
    }
}

glm::vec3 drawn(const std::array<std::uint16_t, 6>& stored, const Precision& kept, const core::LabRange& range,
                const glm::vec3& at) {
  glm::vec3 lab;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const float span = range.hi[axis] - range.lo[axis];
    const float lo = kept.load(stored[2 * a], range.lo[axis], span);
    const float hi = kept.load(stored[2 * a + 1], range.lo[axis], span);
    lab[axis] = lo + (hi - lo) * at[axis];
  }
  return lab;
}

Knob corner_knob(const Workbench& bench, const std::vector<LabCuboid>& boxes, const core::LabRange& range) {
  Knob knob;
  knob.id = "corners";
  knob.title = "Precision of the boxes' corners";
  knob.what = "Colours drawn from " + std::to_string(boxes.size()) +
              " boxes of three paints, 8 places in each; the grids span the pack's range, half floats hold Lab itself.";
  knob.error_unit = "CIEDE2000 against corners in double";
  knob.time_of = "storing and decoding one place of each of " + std::to_string(boxes.size()) + " boxes";
  knob.bytes_of = "one tuple";
  knob.chosen = "16 bits";
  double ours = none, twelve = none, half = none, eight = none;
  for (const Precision& kept : precisions) {
    Stored stored;
    store_all(boxes, kept, range, stored);
    std::mt19937 random(11);
    std::vector<double> errors;
    errors.reserve(8 * boxes.size());
    for (std::size_t k = 0; k < boxes.size(); ++k)
      for (int place = 0; place < 8; ++place) {
        const double l = uniform(random), a = uniform(random), b = uniform(random);
        const glm::dvec3 at(l, a, b);
        const glm::dvec3 exact = glm::dvec3(boxes[k].lo) + (glm::dvec3(boxes[k].hi) - glm::dvec3(boxes[k].lo)) * at;
        errors.push_back(core::ciede2000(exact, glm::dvec3(drawn(stored[k], kept, range, glm::vec3(at)))));
      }
    Setting one;
    one.label = kept.label;
    one.value = kept.bits;
    one.line = kept.load == load_grid<8> || kept.load == load_grid<12> || kept.load == load_grid<16>
                   ? "grid over the pack's range"
                   : "half float";
    one.bytes = kept.bytes_a_tuple;
    set_errors(one, std::move(errors));
    glm::vec3 sum(0.0f);
    one.time = bench.time(
        [&] {
          store_all(boxes, kept, range, stored);
          for (const auto& tuple : stored)
            sum += core::linear_from_lab(drawn(tuple, kept, range, glm::vec3(0.25f, 0.5f, 0.75f)));
        },
        60.0, 3, 200);
    if (!std::isfinite(sum.x)) one.note = "a colour is not finite";
    if (kept.bits == 16) ours = one.error;
    if (kept.bits == 12) twelve = one.error;
    if (kept.bits == 11) half = one.error;
    if (kept.bits == 8) eight = one.error;
    knob.settings.push_back(std::move(one));
  }
  knob.why = "16 bits err by " + digits(ours) + " on average, half floats of the same size by " + digits(half) +
             ", 12 bits by " + digits(twelve) + " and 8 bits by " + digits(eight) +
             "; two bytes of an RGBA8 texel are read without extensions of OpenGL ES 2.0.";
  return knob;
}

// ---- the space inside a box

/// Mean way when both clouds are halved together, each at its median along the longer axis of the first: a coupling,
/// so no less than the 1-Wasserstein distance. The same number of points in both.
double coupled(std::span<glm::vec3> one, std::span<glm::vec3> two) {
  if (one.size() == 1) {
    const glm::vec3 way = one[0] - two[0];
    return std::sqrt(static_cast<double>(way.x * way.x + way.y * way.y + way.z * way.z));
  }
  glm::vec3 lo = one[0], hi = one[0];
  for (const glm::vec3& p : one)
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], p[axis]);
      hi[axis] = std::max(hi[axis], p[axis]);
    }
  const glm::vec3 side = hi - lo;
  int axis = side.x >= side.y ? 0 : 1;
  if (side.z > side[axis]) axis = 2;
  const std::size_t half = one.size() / 2;
  const auto before = [axis](const glm::vec3& p, const glm::vec3& q) { return p[axis] < q[axis]; };
  std::nth_element(one.begin(), one.begin() + static_cast<std::ptrdiff_t>(half), one.end(), before);
  std::nth_element(two.begin(), two.begin() + static_cast<std::ptrdiff_t>(half), two.end(), before);
  return coupled(one.first(half), two.first(half)) + coupled(one.subspan(half), two.subspan(half));
}

bool holds(const LabCuboid& box, const glm::vec3& p) {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < box.lo[axis] || p[axis] > box.hi[axis]) return false;
  return true;
}

enum class Space : std::uint8_t { lab, rgb_in_lab_clusters, rgb };

/// A colour drawn from a box: uniform in the box's own space, shown in Lab and as light.
glm::vec3 draw_from(const LabCuboid& box, std::mt19937& random) {
  const auto l = static_cast<float>(uniform(random)), a = static_cast<float>(uniform(random)),
             b = static_cast<float>(uniform(random));
  return box.lo + (box.hi - box.lo) * glm::vec3(l, a, b);
}

double reconstruction_error(const FlakeLevel& level, Space space) {
  constexpr std::size_t most = 8192;  // of one box: enough to tell spaces apart, and n log n
  const Points& clustered = space == Space::rgb ? level.linear : level.lab;
  const std::vector<LabCuboid> boxes = core::cluster_texels(clustered, {});
  std::vector<std::vector<std::size_t>> members(boxes.size());
  for (std::size_t k = 0; k < clustered.size(); ++k) {
    const auto box =
        std::find_if(boxes.begin(), boxes.end(), [&](const LabCuboid& b) { return holds(b, clustered[k]); });
    members[static_cast<std::size_t>(box - boxes.begin())].push_back(k);
  }
  std::mt19937 random(3);
  double sum = 0.0;
  Points captured, drawn_lab;
  for (std::size_t c = 0; c < boxes.size(); ++c) {
    LabCuboid box = boxes[c];
    if (space == Space::rgb_in_lab_clusters) {
      box.lo = box.hi = level.linear[members[c].front()];
      for (const std::size_t k : members[c])
        for (int axis = 0; axis < 3; ++axis) {
          box.lo[axis] = std::min(box.lo[axis], level.linear[k][axis]);
          box.hi[axis] = std::max(box.hi[axis], level.linear[k][axis]);
        }
    }
    const std::size_t used = std::min(members[c].size(), most);
    captured.clear();
    drawn_lab.clear();
    for (std::size_t k = 0; k < used; ++k) {
      captured.push_back(level.lab[members[c][k * members[c].size() / used]]);
      const glm::vec3 colour = draw_from(box, random);
      drawn_lab.push_back(space == Space::lab ? colour : core::lab_from_linear(colour));
    }
    sum += coupled(captured, drawn_lab) * static_cast<double>(members[c].size()) / static_cast<double>(used);
  }
  return sum / static_cast<double>(level.lab.size());
}

Timing decode_time(const Workbench& bench, const std::vector<LabCuboid>& boxes, bool lab) {
  glm::vec3 sum(0.0f);
  const Timing time = bench.time(
      [&] {
        for (std::size_t k = 0; k < 1'000'000; ++k) {
          const LabCuboid& box = boxes[k % boxes.size()];
          const float at = static_cast<float>(k & 255) / 256.0f;
          const glm::vec3 colour = box.lo + (box.hi - box.lo) * at;
          sum += lab ? core::linear_from_lab(colour) : colour;
        }
      },
      60.0, 3, 50);
  return std::isfinite(sum.x) ? time : Timing{};
}

Knob space_knob(const Workbench& bench, const std::vector<FlakeSample>& samples, const std::vector<LabCuboid>& boxes) {
  Knob knob;
  knob.id = "cuboid_space";
  knob.title = "Colour space inside a box";
  knob.what = "Boxes that are filled evenly in Lab or in linear RGB; 50 clusters, level 0 of " +
              std::to_string(samples.size()) +
              " slices. As many colours are drawn as there are texels; the grain of that draw is in all errors.";
  knob.error_unit = "1-Wasserstein distance of drawn from captured texels, Lab";
  knob.time_of = "decoding 1 million colours on the CPU";
  knob.bytes_of = "one tuple";
  knob.chosen = "Lab";
  const std::array<std::pair<Space, const char*>, 3> spaces = {{{Space::lab, "Lab"},
                                                                {Space::rgb_in_lab_clusters, "RGB in Lab's clusters"},
                                                                {Space::rgb, "RGB, clustered there"}}};
  std::string figures;
  for (const auto& [space, label] : spaces) {
    std::vector<double> errors;
    errors.reserve(samples.size());
    for (const FlakeSample& slice : samples) errors.push_back(reconstruction_error(slice.levels.front(), space));
    Setting one;
    one.label = label;
    one.line = "50 boxes, 16 bits";
    one.bytes = sizeof(core::QuantisedCuboid);
    set_errors(one, std::move(errors));
    one.time = decode_time(bench, boxes, space == Space::lab);
    figures += (figures.empty() ? "" : "; ") + std::string(label) + " " + digits(one.error) + " Lab in " +
               digits(one.time.median_ms) + " ms";
    knob.settings.push_back(std::move(one));
  }
  knob.why =
      "Transport and blending are in Lab, where colours between two paints look like between; measured: " + figures +
      ".";
  return knob;
}

}  // namespace

Result<void> add_flake_corners(Workbench& bench, Findings& findings) {
  const auto samples = flake_samples(bench);
  if (!samples) return tl::unexpected(samples.error());
  const auto pack = bench.pack();
  if (!pack) return tl::unexpected(pack.error());
  std::vector<LabCuboid> boxes;
  for (const FlakeSample& slice : *samples) {
    const std::vector<LabCuboid> own = core::cluster_texels(slice.levels.front().lab, {});
    boxes.insert(boxes.end(), own.begin(), own.end());
  }
  findings.knobs.push_back(corner_knob(bench, boxes, (*pack)->data.range));
  findings.knobs.push_back(space_knob(bench, *samples, boxes));
  return {};
}

}  // namespace lackwerk::report

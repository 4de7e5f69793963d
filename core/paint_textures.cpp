#include "core/paint_textures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.hpp"
#include "core/gaussian.hpp"

namespace lackwerk::core {
namespace {

/// SplitMix64 (Steele, Lea & Flood 2014): a counter-based generator, so that texel k never depends on texel k-1.
std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

/// Shared exponent in A, biased by 128: value = byte/255 * 2^(A - 128).
void encode_rgbe(const glm::vec3& value, std::uint8_t* out) {
  const float largest = std::max({value.x, value.y, value.z});
  if (!(largest > 1e-30f)) {
    std::fill(out, out + 4, std::uint8_t{0});
    return;
  }
  int exponent = 0;
  std::frexp(largest, &exponent);  // largest in [2^(e-1), 2^e)
  const float scale = std::ldexp(1.0f, -exponent) * 255.0f;
  for (int c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(std::clamp(std::lround(value[c] * scale), 0l, 255l));
  out[3] = static_cast<std::uint8_t>(std::clamp(exponent + 128, 1, 255));
}

/// The random texture: every quantile once, so that a whole texture has the exact distribution, in an order drawn from
/// the seed (Fisher & Yates).
std::vector<std::uint8_t> random_texture(std::uint64_t seed) {
  constexpr std::size_t count = std::size_t{random_edge} * random_edge;
  std::vector<std::uint16_t> value(count);
  for (std::size_t k = 0; k < count / 2; ++k) {
    const double g = normal_lower_quantile((static_cast<double>(k) + 0.5) / static_cast<double>(count));
    const auto q = static_cast<std::uint16_t>(std::lround((g / (2.0 * random_reach) + 0.5) * 65535.0));
    value[k] = q;
    value[count - 1 - k] = static_cast<std::uint16_t>(65535 - q);
  }
  for (std::size_t k = count - 1; k > 0; --k) {
    // The high 32 bits of a product: uniform to 2^-14 of a part, no division.
    const std::uint64_t j = ((splitmix64(seed + k) >> 32) * (k + 1)) >> 32;
    std::swap(value[k], value[static_cast<std::size_t>(j)]);
  }
  std::vector<std::uint8_t> out(count * 2);
  for (std::size_t k = 0; k < count; ++k) {
    out[2 * k] = static_cast<std::uint8_t>(value[k] & 255);
    out[2 * k + 1] = static_cast<std::uint8_t>(value[k] >> 8);
  }
  return out;
}

std::size_t grid_offset(int bin_h, int bin_i) {
  const int h = std::clamp(bin_h, 0, angle_grid - 1);
  const int i = std::clamp(bin_i, 0, angle_grid - 1);
  return static_cast<std::size_t>(i * angle_grid + h) * 4;
}

}  // namespace

glm::dvec3 PaintTextures::sample_chi(double u, double v) const {
  if (table_size == 0) return glm::dvec3(1.0);
  // GL's LINEAR filter with CLAMP_TO_EDGE on unorm bytes, then the shader's own decoding.
  const double x = std::clamp(u * table_size - 0.5, 0.0, table_size - 1.0);
  const double y = std::clamp(v * table_size - 0.5, 0.0, table_size - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, table_size - 1), y1 = std::min(y0 + 1, table_size - 1);
  const double fx = x - x0, fy = y - y0;
  glm::dvec3 sum(0.0);
  const auto add = [&](int xi, int yi, double w) {
    const std::uint8_t* t = &chi[static_cast<std::size_t>(yi * table_size + xi) * 4];
    sum += glm::dvec3(t[0], t[1], t[2]) * (w / 255.0);
  };
  add(x0, y0, (1 - fx) * (1 - fy));
  add(x1, y0, fx * (1 - fy));
  add(x0, y1, (1 - fx) * fy);
  add(x1, y1, fx * fy);
  return sum * sum * static_cast<double>(chi_scale);
}

glm::dvec3 PaintTextures::mean_at(int bin_h, int bin_i) const {
  if (mean.empty()) return glm::dvec3(0.0);
  const std::uint8_t* t = &mean[grid_offset(bin_h, bin_i)];
  if (t[3] == 0) return glm::dvec3(0.0);
  return glm::dvec3(t[0], t[1], t[2]) * (std::ldexp(1.0, t[3] - 128) / 255.0);
}

const std::uint8_t* PaintTextures::slice_texel(int bin_h, int bin_i) const {
  static constexpr std::uint8_t none[4] = {0, 255, 0, 0};
  return slice.empty() ? none : &slice[grid_offset(bin_h, bin_i)];
}

const std::uint8_t* PaintTextures::rank_texel(int step, int row) const {
  return &rank[static_cast<std::size_t>(row) * rank_table_steps + static_cast<std::size_t>(step)].first;
}

const std::uint8_t* PaintTextures::corner_texel(int x, int row) const {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(corner.data());
  return bytes +
         (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) * 3 + static_cast<std::size_t>(x)) * 4;
}

const PaintTextures& no_textures() {
  static const PaintTextures none;
  return none;
}

const std::uint8_t* PaintTextures::random_texel(std::int64_t x, std::int64_t y) const {
  static constexpr std::uint8_t zero[2] = {0, 0};
  if (random.empty()) return zero;
  constexpr std::int64_t mask = random_edge - 1;
  return &random[static_cast<std::size_t>((y & mask) * random_edge + (x & mask)) * 2];
}

PaintTextures make_static_textures(const InterpolatablePaint& paint) {
  PaintTextures out;
  out.row_count = paint.row_count();
  out.asked_rows = std::max(paint.level_count - 1, 1) * paint.layout.slice_count();
  out.mean.assign(angle_grid * angle_grid * 4, 0);
  out.slice.assign(angle_grid * angle_grid * 4, 0);
  for (int i = 0; i < angle_grid; ++i)
    for (int h = 0; h < angle_grid; ++h) {
      const auto slice = paint.layout.slice_at(h, i);
      std::uint8_t* t = &out.slice[grid_offset(h, i)];
      t[0] = static_cast<std::uint8_t>(slice.value_or(0));
      t[1] = slice ? 0 : 255;
    }
  if (out.row_count == 0) return out;
  check_at_most(paint.layout.slice_count(), 256, "slices fit the slice map's byte");
  check_at_most(paint.layout.num_theta + 1, static_cast<int>(angle_grid), "angle nodes fit the slice map");
  out.rank = build_rank_table(paint);
  out.random = random_texture(paint.random_seed);
  return out;
}

void update_textures(const InterpolatablePaint& paint, RealisedPaint& realised, PaintTextures& textures) {
  textures.table_size = 0;
  if (const auto& table = realised.analytic.table) {
    textures.table_size = table->num_theta;
    float largest = 1e-6f;
    for (const glm::vec3& c : table->linear) largest = std::max({largest, c.x, c.y, c.z});
    textures.chi_scale = largest;
    textures.chi.resize(table->linear.size() * 4);
    for (std::size_t k = 0; k < table->linear.size(); ++k) {
      for (int c = 0; c < 3; ++c)
        textures.chi[k * 4 + static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(255.0f * std::sqrt(std::max(table->linear[k][c], 0.0f) / largest)));
      textures.chi[k * 4 + 3] = 255;
    }
  }
  if (textures.row_count == 0) return;
  textures.width = realised.width;
  std::swap(textures.corner, realised.corners);
  for (int slice = 0; slice < paint.layout.slice_count(); ++slice) {
    const auto node = paint.layout.node_of(slice);
    encode_rgbe(realised.flake_mean[static_cast<std::size_t>(slice)],
                &textures.mean[grid_offset(node.bin_h, node.bin_i)]);
  }
}

}  // namespace lackwerk::core

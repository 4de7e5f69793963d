#include "core/analysis/reference.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <mutex>
#include <thread>

#include "core/analysis/reference_geometry.hpp"
#include "core/analysis/reference_numbers.hpp"
#include "core/analysis/reference_room.hpp"
#include "core/analysis/reference_shading.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

using glm::dvec3;
using Clock = std::chrono::steady_clock;

constexpr int tile_edge = 16;
constexpr int largest_edge = 8192;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Rays through the picture, as gles::clip_from_world projects.
struct Eye {
  dvec3 at, forward, right, up;
  double half_height, half_width;

  Eye(const ReferenceView& view, int width, int height) : at(view.eye_mm) {
    forward = glm::normalize(view.target_mm - view.eye_mm);
    const dvec3 above = std::abs(forward.z) > 0.999 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 0.0, 1.0);
    right = glm::normalize(glm::cross(forward, above));
    up = glm::cross(right, forward);
    half_height = std::tan(glm::radians(view.vertical_fov_deg) * 0.5);
    half_width = half_height * width / height;
  }
  /// x, y in parts of the picture, [0, 1], y downwards.
  [[nodiscard]] dvec3 ray(double x, double y) const {
    return glm::normalize(forward + right * ((2.0 * x - 1.0) * half_width) + up * ((1.0 - 2.0 * y) * half_height));
  }
};

/// What is kept of a pixel: sums over batch means.
struct Sums {
  dvec3 mean{0.0}, squared{0.0};
  double luminance_squared = 0.0;
};

class Picture {
 public:
  Picture(const ReferenceShader::World& world, const Eye& eye, const ReferenceOptions& options)
      : world_(world),
        eye_(eye),
        options_(options),
        columns_((options.width + tile_edge - 1) / tile_edge),
        rows_((options.height + tile_edge - 1) / tile_edge),
        sums_(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height)),
        threads_(options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency())) {
    for (unsigned t = 0; t < threads_; ++t) shaders_.emplace_back(world_);
  }

  /// One more batch for every pixel. `done`: called after each tile with the share of this batch.
  template <class Done>
  void add_batch(int batch, const Done& done) {
    std::atomic<int> next{0};
    const int count = columns_ * rows_;
    const auto work = [&](ReferenceShader& shader) {
      for (int tile = next++; tile < count; tile = next++) {
        add_tile(shader, tile, batch);
        done(static_cast<double>(tile + 1) / count);
      }
    };
    std::vector<std::jthread> others;  // joined at the end of this batch
    for (unsigned t = 1; t < threads_; ++t) others.emplace_back([&, t] { work(shaders_[t]); });
    work(shaders_[0]);
  }

  [[nodiscard]] ReferenceImage finish(int batches) const {
    ReferenceImage out;
    out.width = options_.width;
    out.height = options_.height;
    out.samples = batches * reference_batch;
    out.paths = sums_.size() * static_cast<std::uint64_t>(out.samples);
    const double n = batches;
    // Standard error of a mean of n independent batches from their scatter.
    const auto error = [n](double sum, double squared) {
      return std::sqrt(std::max(squared - sum * sum / n, 0.0) / (n * (n - 1.0)));
    };
    for (const Sums& s : sums_) {
      out.mean.push_back(s.mean / n);
      out.error.emplace_back(error(s.mean.x, s.squared.x), error(s.mean.y, s.squared.y), error(s.mean.z, s.squared.z));
      out.luminance_error.push_back(error(luminance_of(s.mean), s.luminance_squared));
    }
    for (const ReferenceShader& shader : shaders_) out.rays += shader.rays();
    return out;
  }

 private:
  void add_tile(ReferenceShader& shader, int tile, int batch) {
    const int x0 = tile % columns_ * tile_edge, y0 = tile / columns_ * tile_edge;
    for (int y = y0; y < std::min(y0 + tile_edge, options_.height); ++y)
      for (int x = x0; x < std::min(x0 + tile_edge, options_.width); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(options_.width) + static_cast<std::size_t>(x);
        dvec3 sum(0.0);
        for (std::uint32_t k = 0; k < reference_batch; ++k) {
          ReferenceNumbers numbers(options_.seed, pixel, static_cast<std::uint64_t>(batch), k);
          const glm::dvec2 at = numbers.next();
          sum +=
              shader.camera_ray(eye_.at, eye_.ray((x + at.x) / options_.width, (y + at.y) / options_.height), numbers);
        }
        const dvec3 mean = sum / static_cast<double>(reference_batch);
        const double luminance = luminance_of(mean);
        sums_[pixel].mean += mean;
        sums_[pixel].squared += mean * mean;
        sums_[pixel].luminance_squared += luminance * luminance;
      }
  }

  const ReferenceShader::World world_;
  const Eye eye_;
  const ReferenceOptions options_;
  const int columns_, rows_;
  std::vector<Sums> sums_;
  const unsigned threads_;
  std::vector<ReferenceShader> shaders_;  ///< one per thread
};

Result<void> check(const ReferenceScene& scene, const ReferenceOptions& options) {
  if (options.width < 1 || options.height < 1 || options.width > largest_edge || options.height > largest_edge)
    return fail("", "--size", "the picture's edges must be 1 to " + std::to_string(largest_edge) + " pixels",
                "choose another size", ErrorKind::usage);
  for (const ReferenceMaterial& material : scene.materials)
    if (material.is_paint &&
        (scene.paint.pack == nullptr || scene.paint.analytic == nullptr || scene.paint.textures == nullptr))
      return fail("", "paint", "the scene is painted, but there is no paint", "give a paint pack");
  return {};
}

}  // namespace

Result<ReferenceImage> render_reference(const ReferenceScene& scene, const ReferenceView& view,
                                        const ReferenceLighting& lighting, const ReferenceOptions& options,
                                        const ReferenceProgress& progress) {
  if (auto checked = check(scene, options); !checked) return tl::unexpected(checked.error());
  const auto start = Clock::now();
  const auto geometry = ReferenceGeometry::create(scene);
  if (!geometry) return tl::unexpected(geometry.error());
  const RoomSampler room(*scene.environment);
  const Eye eye(view, options.width, options.height);
  const ReferenceShader::World world{&scene,
                                     &*geometry,
                                     &room,
                                     &lighting,
                                     options.visibility,
                                     std::clamp(options.bounces, 0, 8),
                                     2.0 * eye.half_height / options.height};
  Picture picture(world, eye, options);

  const int wanted = std::max(2, (options.samples + reference_batch - 1) / reference_batch);
  std::mutex mutex;
  int batches = 0;
  double batch_s = 0.0;
  while (batches < wanted) {
    const double before = since(start);
    if (options.seconds > 0.0 && batches >= 2 && before + batch_s > options.seconds) break;
    picture.add_batch(batches, [&](double part) {
      if (!progress) return;
      const std::lock_guard lock(mutex);
      const double by_samples = (batches + part) / wanted;
      const double by_time = options.seconds > 0.0 ? since(start) / options.seconds : 0.0;
      progress(std::min(std::max(by_samples, by_time), 1.0), batches * reference_batch);
    });
    ++batches;
    batch_s = since(start) - before;
  }
  ReferenceImage out = picture.finish(batches);
  out.seconds = since(start);
  return out;
}

std::vector<std::uint8_t> reference_bytes(const ReferenceImage& image, double exposure) {
  PaintModel<double> model;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * image.mean.size());
  for (const dvec3& mean : image.mean) {
    const dvec3 shown = model.display_transform(mean * exposure);
    for (int c = 0; c < 3; ++c)
      bytes.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(shown[c], 0.0, 1.0) * 255.0)));
  }
  return bytes;
}

std::vector<float> reference_error_steps(const ReferenceImage& image, double exposure) {
  PaintModel<double> model;
  std::vector<float> steps;
  steps.reserve(image.mean.size());
  for (std::size_t k = 0; k < image.mean.size(); ++k) {
    const dvec3 up = model.display_transform((image.mean[k] + image.error[k]) * exposure);
    const dvec3 down = model.display_transform((image.mean[k] - image.error[k]) * exposure);
    const dvec3 move = glm::abs(up - down) * (0.5 * 255.0);
    steps.push_back(static_cast<float>(std::max({move.x, move.y, move.z})));
  }
  return steps;
}

}  // namespace lackwerk::core

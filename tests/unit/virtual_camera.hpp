// A simulated camera before a virtual panel: lens fall-off, uneven light, perspective, response, noise, dark, exposure.
//
// Why it exists: the importer of photographs is tried where the truth is known. The camera is a pinhole in space and
// shares no code with what undoes it. Pure but for write_numbers(); one thread.
#pragma once

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

namespace lackwerk::test {

struct VirtualCamera {
  int width = 420, height = 360;
  double distance_mm = 150.0, focal_px = 0.0;  ///< focal 0: the panel fills about 70 % of the height
  double panel_mm = 6.4;
  double gamma = 2.2;           ///< number = light^(1/gamma)
  double dark = 0.004;          ///< offset, as a share of full scale
  double electrons = 30000.0;   ///< at full scale: photon noise
  double read_electrons = 6.0;  ///< noise of reading out
  int bits = 16;
  glm::dvec3 to_camera{0.0, 0.0, 1.0};  ///< direction from the panel's middle

  [[nodiscard]] double focal() const { return focal_px > 0.0 ? focal_px : 0.7 * height * distance_mm / panel_mm; }
  struct Axes {
    glm::dvec3 position, forward, right, down;
  };
  /// The panel lies in z = 0, x right, y down its picture, seen from z > 0; its normal is +z and y is flipped.
  [[nodiscard]] Axes axes() const {
    const glm::dvec3 d = glm::normalize(to_camera);
    Axes a;
    a.position = d * distance_mm;
    a.forward = -d;
    const glm::dvec3 x(1.0, 0.0, 0.0);
    a.right = glm::normalize(x - d * glm::dot(x, d));
    a.down = glm::cross(a.forward, a.right);
    return a;
  }
  /// Panel millimetres from its top left corner (y down) to space and back.
  [[nodiscard]] glm::dvec3 in_space(const glm::dvec2& mm) const {
    return {mm.x - 0.5 * panel_mm, 0.5 * panel_mm - mm.y, 0.0};
  }
  [[nodiscard]] glm::dvec2 project(const glm::dvec2& mm) const {
    const Axes a = axes();
    const glm::dvec3 ray = in_space(mm) - a.position;
    const double depth = glm::dot(ray, a.forward);
    return {0.5 * width + focal() * glm::dot(ray, a.right) / depth,
            0.5 * height + focal() * glm::dot(ray, a.down) / depth};
  }
  [[nodiscard]] std::array<glm::dvec2, 4> corners() const {
    return {project({0, 0}), project({panel_mm, 0}), project({panel_mm, panel_mm}), project({0, panel_mm})};
  }

  /// Light at each pixel: `factor` of the place (mm) times the light that falls there and the lens's loss.
  [[nodiscard]] std::vector<glm::dvec3> see(const std::function<glm::dvec3(const glm::dvec2& mm)>& factor) const {
    const Axes a = axes();
    constexpr int samples = 4;
    std::vector<glm::dvec3> out;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        glm::dvec3 sum(0.0);
        for (int k = 0; k < samples * samples; ++k) {
          const double px = x + (k % samples + 0.5) / samples - 0.5 * width;
          const double py = y + (k / samples + 0.5) / samples - 0.5 * height;
          const glm::dvec3 ray = a.forward * focal() + a.right * px + a.down * py;
          const glm::dvec3 hit = a.position - ray * (a.position.z / ray.z);
          const glm::dvec2 mm(hit.x + 0.5 * panel_mm, 0.5 * panel_mm - hit.y);
          const double lamp = 1.0 + 0.25 * hit.x / panel_mm - 0.15 * hit.y / panel_mm;
          sum += factor(mm) * lamp;
        }
        const double off = std::hypot(x + 0.5 - 0.5 * width, y + 0.5 - 0.5 * height) / height;
        const double lens = std::pow(std::cos(std::atan(off)), 4.0);
        out.push_back(sum * (lens / (samples * samples)));
      }
    }
    return out;
  }

  /// What the camera writes for this light, 0 to 1 in steps of its bits.
  [[nodiscard]] std::vector<float> expose(const std::vector<glm::dvec3>& light, double exposure,
                                          std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double codes = std::pow(2.0, bits) - 1.0;
    std::vector<float> out;
    for (const glm::dvec3& pixel : light) {
      for (int c = 0; c < 3; ++c) {
        double value = pixel[c] * exposure;
        value +=
            normal(random) * std::sqrt(value / electrons + read_electrons * read_electrons / (electrons * electrons));
        value = std::clamp(value + dark, 0.0, 1.0);
        out.push_back(static_cast<float>(std::round(std::pow(value, 1.0 / gamma) * codes) / codes));
      }
    }
    return out;
  }
  [[nodiscard]] bool write(const std::filesystem::path& file, const std::vector<float>& numbers) const {
    const auto image = OIIO::ImageOutput::create(file.string());
    const OIIO::ImageSpec spec(width, height, 3, bits == 8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16);
    return image && image->open(file.string(), spec) && image->write_image(OIIO::TypeDesc::FLOAT, numbers.data()) &&
           image->close();
  }
};

}  // namespace lackwerk::test

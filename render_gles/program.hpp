// Shader programs, one per set of features: what a scene or pack does not need is not compiled in.
//
// Why it exists: ES 2.0 hardware pays for every term it must not take, so the shading texts are switched by the
// preprocessor. Compiled once per set and kept. Owns GL programs; destroy it while its context is current; one GL
// thread.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "packs/scene.hpp"
#include "render_gles/context.hpp"
#include "render_gles/gl_object.hpp"

namespace lackwerk::gles {

/// "paint", "glass", ...: for messages.
[[nodiscard]] const char* surface_name(packs::SurfaceKind kind);

/// The switches of surface_fragment.glsl and paint_model.glsl.
struct Features {
  packs::SurfaceKind surface = packs::SurfaceKind::paint;
  int lobes = 0;  ///< [0, 3]
  bool table = false;
  bool flakes = false;  ///< single flakes or their mean
  int flake_taps = 1;   ///< 1 (nearest slice) or 4 (bilinear)
  bool coat = false;
  bool refraction = false;
  int lights = 0;        ///< directional lights, [0, 4]
  int flake_lights = 0;  ///< how many of them show single flakes; the others show the mean
  bool stripes = false;
  bool studio = false;
  auto operator<=>(const Features&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 misreads it

  /// The same picture with the fewest switches on: equal pictures share one program.
  [[nodiscard]] Features canonical() const;
  /// "paint, 3 lobes, table, ..." for explanations.
  [[nodiscard]] std::string text() const;
};

class Program {
 public:
  /// Compiles and links. Aborts with the log and the numbered source if the driver refuses: the texts are ours.
  Program(const GlApi& gl, const Features& features, bool fragment_highp);

  void use() const { gl_->UseProgram(program_.id()); }
  /// Location of an active uniform (arrays without "[0]"); -1, which GL ignores, if it was compiled out.
  [[nodiscard]] GLint location(std::string_view uniform) const;
  [[nodiscard]] double compile_ms() const { return compile_ms_; }
  /// Active fragment and vertex uniforms in vec4 units, counted without packing.
  [[nodiscard]] int uniform_vectors() const { return uniform_vectors_; }

 private:
  const GlApi* gl_;
  GlObject program_;
  std::map<std::string, GLint, std::less<>> locations_;
  double compile_ms_ = 0.0;
  int uniform_vectors_ = 0;
};

/// Attribute slots, bound before linking.
inline constexpr GLuint attribute_position = 0;
inline constexpr GLuint attribute_normal = 1;
inline constexpr GLuint attribute_open = 2;

class ProgramCache {
 public:
  /// `context` must be current and outlive the cache.
  explicit ProgramCache(const Context& context) : context_(&context) {}

  /// The program for these features, compiled on first use (tens of milliseconds).
  const Program& get(const Features& features);
  [[nodiscard]] std::size_t size() const { return programs_.size(); }
  /// One line a program: features and compile time.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  const Context* context_;
  std::map<Features, std::unique_ptr<Program>> programs_;
};

/// The complete texts, for tests and offline validators.
[[nodiscard]] std::string vertex_source();
[[nodiscard]] std::string fragment_source(const Features& features, bool fragment_highp);

}  // namespace lackwerk::gles

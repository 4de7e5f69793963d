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

/// Where a surface's light from the environment comes from: PATH in surface_fragment.glsl. `mirror`: what lights cut
/// from it leave over.
enum class ShaderPath : int { none = 0, filtered = 1, sampled = 2, mirror = 3 };
/// What the fragment shader writes.
enum class ShaderOutput : int { display = 0, linear = 1, mirror_image = 2, subject = 3 };

/// Whether chi comes from a colour map, and what happens beyond the critical angle: COLOUR_MAP in mapped_paint.glsl.
enum class MapUse : int { none = 0, clip = 1, slide = 2 };

/// The switches of surface_fragment.glsl and paint_model.glsl.
struct Features {
  packs::SurfaceKind surface = packs::SurfaceKind::paint;
  int lobes = 0;  ///< [0, 3]
  bool diffuse = true;
  bool table = false;
  MapUse map = MapUse::none;  ///< in the table's place
  bool flakes = false;        ///< single flakes or their mean
  int flake_taps = 1;         ///< 1 (nearest slice) or 4 (bilinear)
  int flake_cells = 1;        ///< 1 (nearest random cell) or 4 (cross-faded): how flakes live along the angles
  bool coat = false;
  bool refraction = false;
  ShaderPath path = ShaderPath::filtered;
  int narrow = 0;            ///< bit k: lobe k may need environment levels below 2
  int looked_up = 31;        ///< bits 0 to 2: lobes, 3: flakes, 4: diffuse; what the filtered and mirror paths look up
  int lights = 0;            ///< directional lights, [0, 4]
  bool room_lights = false;  ///< the lights stand on the room's wall and floor
  bool less_mean_flakes = false;  ///< a share of the flakes' mean is looked up, and not the lights'
  int flake_lights = 0;           ///< how many of them show single flakes; the others show the mean
  int sparkle_lights = 0;         ///< lights of the environment that show single flakes on the filtered path, [0, 4]
  bool still_flakes = false;      ///< single flakes on the sampled path
  bool visibility = false;        ///< baked, per vertex
  bool irradiance = false;        ///< baked, per vertex
  bool floor_mirror = false;
  bool stripes = false;
  bool orange_peel = false;  ///< waves in the coat's mirror image
  ShaderOutput output = ShaderOutput::display;
  auto operator<=>(const Features&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 misreads it

  /// The same picture with the fewest switches on: equal pictures share one program.
  [[nodiscard]] Features canonical() const;
  /// Whether the flake textures are read.
  [[nodiscard]] bool single_flakes() const { return flake_lights > 0 || sparkle_lights > 0 || still_flakes; }
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
  /// Elements of an active uniform array; 0 if it was compiled out.
  [[nodiscard]] int size(std::string_view uniform) const;
  [[nodiscard]] double compile_ms() const { return compile_ms_; }
  /// Active fragment and vertex uniforms in vec4 units, counted without packing.
  [[nodiscard]] int uniform_vectors() const { return uniform_vectors_; }

 private:
  const GlApi* gl_;
  GlObject program_;
  struct Uniform {
    GLint location = -1;
    GLint size = 0;
  };
  std::map<std::string, Uniform, std::less<>> uniforms_;
  double compile_ms_ = 0.0;
  int uniform_vectors_ = 0;
};

/// Attribute slots, bound before linking.
inline constexpr GLuint attribute_position = 0;
inline constexpr GLuint attribute_normal = 1;
inline constexpr GLuint attribute_irradiance = 2;
inline constexpr GLuint attribute_visible = 3;  ///< and the two after it

/// "#version 100", precision, and what the texts shared with C++ need; for fragment shaders.
[[nodiscard]] std::string shader_prelude(bool fragment_highp);
/// Compiles and links; `attributes` get slots 0, 1, ... Aborts with log and source if the driver refuses: the texts are
/// ours. `what` is for the message.
[[nodiscard]] GlObject link_program(const GlApi& gl, const std::string& vertex, const std::string& fragment,
                                    const std::vector<const char*>& attributes, const std::string& what);

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
[[nodiscard]] std::string vertex_source(const Features& features);
[[nodiscard]] std::string fragment_source(const Features& features, bool fragment_highp);

}  // namespace lackwerk::gles

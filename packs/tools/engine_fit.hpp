// A capture as a game engine's material: one GGX lobe, two colours, one flake texture, a clear coat.
//
// Why it exists: paints are wanted outside the kiosk, where neither three lobes nor colour tables nor flake slices
// exist (Kneiphof et al. 2018). The engine's model is what the glTF 2.0 specification and KHR_materials_clearcoat,
// _specular and _ior write down, because those are the same in every engine. Values; pure functions; any thread.
//
// The material, as those texts have it (D, V of ggx_factor; all below the coat):
//   f = (1 - c F(o)) ((1 - w) b/pi + (s + (w - s) (1 - h.o)^5) D V) + c F(o) (coat's own lobe or mirror)
// with an index of 0 (KHR_materials_ior: no dielectric of its own), w = specularFactor, s = w specularColor, b = base
// colour. With w = the largest channel of s nothing rises towards grazing but the hue, and what the base loses is
// constant: (1 - w) b is the diffuse colour d, exactly.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/analysis/brdf_table.hpp"
#include "core/analysis/ggx_fit.hpp"
#include "core/error.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

/// The specular colour of each texel: KN 3.1, "the flake value is simply added to the specular color".
///
/// Which image? Emission would glow in the dark, and base colour does not shine. A normal map turns whole lobes about:
/// engines look a flake up in an environment filtered with the paint's one roughness, so that tilted normals only blur.
/// A metal's base colour is read by every engine, but then diffuse and specular share one hue. specularColorTexture is
/// what KN's engine calls the specular map; three.js, Babylon.js, Blender and the Khronos viewer read it.
struct FlakeTexture {
  std::uint32_t edge = 0;          ///< texels; tiles without a seam if the slices do
  double texel_mm = 0.0;           ///< on the paint
  std::vector<std::uint8_t> rgba;  ///< rgb: sRGB-encoded s / w; alpha: w / specular_weight, linear; edge * edge
};

struct EngineMaterial {
  glm::dvec3 diffuse{0.0};       ///< d, [0, 1 - mean w]
  glm::dvec3 specular{0.0};      ///< mean s, [0, 1]
  double alpha = 1.0;            ///< GGX; glTF's roughness is its root
  double clearcoat = 0.0;        ///< factor of a coat of index 1.5, [0, 1]
  double clearcoat_alpha = 0.0;  ///< 0: a mirror
  double specular_weight = 0.0;  ///< w: with a texture that of its brightest texel
  double mean_weight = 0.0;      ///< w on average over the texture
  FlakeTexture flakes;           ///< edge 0: none
};

struct EngineFit {
  EngineMaterial material;
  core::GgxFit kn;                                 ///< as the paper fits it (coat both ways), for tables
  core::GgxFit gltf;                               ///< under glTF's coat: what the material uses
  bool peak_is_coat = false;                       ///< the narrowest lobe became the coat
  core::GgxFit coat;                               ///< its fit, where it did
  glm::dvec3 diffuse_chi{1.0}, specular_chi{1.0};  ///< the colour table filtered with either part (KN 3.3)
  double brightest_flake = 0.0;                    ///< of s before it was cut at 1, the largest channel
  std::vector<std::string> notes;                  ///< what the engine cannot show, one sentence each
};

/// Fits. The capture is complete (is_fitted). Without a coat of its own, a narrow last lobe of a dielectric's strength
/// is the coat's peak (that is what the published fits of Guenther et al. 2005 hold): it becomes the engine's clear
/// coat, or one lobe would have to be both peak and body. Errors: the capture is not fitted, or has a texture of a
/// wrong size.
[[nodiscard]] Result<EngineFit> fit_engine_material(const Capture& capture);

/// The material as the specifications draw it, with mean flakes, without the mirror of a smooth coat.
[[nodiscard]] core::Brdf engine_brdf(const EngineMaterial& material);

}  // namespace lackwerk::packs

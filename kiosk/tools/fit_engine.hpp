// What `lackwerk fit DIR --engine ggx -o OUT` does once the capture has been read.
//
// Why it exists: the command's options are those of every fit; what a game engine needs (one lobe, two colours, one
// flake texture, glTF) is its own story. Prints its table or JSON, writes OUT. One thread.
#pragma once

#include <filesystem>

#include "packs/tools/capture.hpp"

namespace lackwerk::tools {

struct EngineFitOptions {
  std::filesystem::path source;  ///< the capture's folder, for messages
  bool json = false;             ///< one line of JSON on stdout in place of the table
};

/// Fits the engine's model and writes into the folder `out` (made if missing, files of the same names replaced):
///   paint.glb       a sphere under the material, everything in one file
///   paint.gltf      the same as text, with paint.bin and flakes.png (where the paint has flakes) beside it
///   lobe.svg        Kneiphof et al. 2018, Figure 2: roughness and scale of one lobe against its m, under
///                   the paint's index and under 1.5
///   compare.png     what was measured (the paint's model where the capture has no measurement), the engine's model
///                   and their CIEDE2000, on a sphere under the lights of brdf_sphere.hpp
/// Returns the exit code of output.hpp; a capture that is not fitted yet (`is_fitted` false) is an error, reported
/// here. A lobe the engine cannot show (narrower or wider than its roughness reaches) is no error: the text says so in
/// place of a number.
[[nodiscard]] int run_engine_fit(const packs::Capture& capture, const std::filesystem::path& out,
                                 const EngineFitOptions& options);

}  // namespace lackwerk::tools

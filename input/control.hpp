// The one event type that every input becomes: touch, knobs, recorded and scripted input.
//
// Why it exists: the kiosk's state machine must not know what a customer turned or touched. Values; any thread.
#pragma once

#include <string>
#include <vector>

namespace lackwerk::input {

enum class ControlKind {
  weights,          ///< values: one weight per paint, for all groups
  base,             ///< values: one weight per paint, for lobes, diffuse and colour table only
  flake_lightness,  ///< values: one weight per paint, L of the flakes only
  flake_colour,     ///< values: one weight per paint, a and b of the flakes only
  camera,           ///< name: a camera of the scene
  orbit,            ///< values: azimuth and elevation to add, degrees
  zoom,             ///< values: factor on the distance to the target, > 0
};

struct Control {
  ControlKind kind = ControlKind::weights;
  std::vector<double> values;
  std::string name;
};

}  // namespace lackwerk::input

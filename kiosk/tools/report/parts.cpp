#include "kiosk/tools/report/parts.hpp"

#include <array>

#include "kiosk/tools/report/flake_knobs.hpp"
#include "kiosk/tools/report/light_knobs.hpp"
#include "kiosk/tools/report/material_knobs.hpp"
#include "kiosk/tools/report/picture_knobs.hpp"
#include "kiosk/tools/report/precision_knob.hpp"
#include "kiosk/tools/report/realise_part.hpp"
#include "kiosk/tools/report/scan_knobs.hpp"
#include "kiosk/tools/report/stiff_clusters.hpp"
#include "kiosk/tools/report/stiff_model.hpp"
#include "kiosk/tools/report/stiff_numbers.hpp"
#include "kiosk/tools/report/stiff_scans.hpp"
#include "kiosk/tools/report/stiff_sinkhorn.hpp"
#include "kiosk/tools/report/stiff_transport.hpp"
#include "kiosk/tools/report/transport_knobs.hpp"

namespace lackwerk::report {

namespace {

Result<void> add_stiff_transports(Workbench& /*bench*/, Findings& findings) {
  add_stiff_transport(findings);
  add_stiff_sinkhorn(findings);
  return {};
}

Result<void> add_stiff_models(Workbench& bench, Findings& findings) {
  add_stiff_model(bench.quick(), findings);
  return {};
}

Result<void> add_stiff_kernels(Workbench& bench, Findings& findings) {
  add_stiff_colour(findings);
  add_stiff_weights(findings);
  bench.progress(0.3);
  add_stiff_light(bench.quick(), findings);
  bench.progress(0.9);
  add_stiff_fits(findings);
  return {};
}

Result<void> add_stiff_octrees(Workbench& bench, Findings& findings) {
  add_stiff_clusters(bench.quick(), findings);
  return {};
}

Result<void> add_stiff_scan_pairs(Workbench& /*bench*/, Findings& findings) {
  add_stiff_scans(findings);
  return {};
}

}  // namespace

std::span<const Part> parts() {
  static const std::array all = {
      Part{"flakes", 15.0, 120.0, add_flakes},
      Part{"transport", 4.0, 40.0, add_transport},
      Part{"realise", 1.0, 4.0, add_realise},
      Part{"pictures", 17.0, 250.0, add_pictures},
      Part{"light", 4.0, 40.0, add_light},
      Part{"materials", 4.0, 40.0, add_materials},
      Part{"precision", 0.5, 2.0, add_precision},
      Part{"scans", 4.0, 40.0, add_scans},
      Part{"stiff model", 0.5, 2.0, add_stiff_models},
      Part{"stiff kernels", 5.0, 8.0, add_stiff_kernels},
      Part{"stiff transport", 3.0, 4.0, add_stiff_transports},
      Part{"stiff clusters", 1.0, 8.0, add_stiff_octrees},
      Part{"stiff scans", 1.0, 1.0, add_stiff_scan_pairs},
  };
  return all;
}

}  // namespace lackwerk::report

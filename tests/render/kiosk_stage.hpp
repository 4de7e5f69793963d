// A stage with a synthetic pack of two paints and a sphere: what tests of the kiosk show.
//
// Why it exists: tests of the live kiosk and of the interface want pictures that are drawn in a moment. Test code; one
// thread.
#pragma once

#include <memory>

#include "kiosk/display/stage.hpp"

namespace lackwerk::test {

/// Pack "live-test", serial 7; camera "hero". `context` must outlive it. Failure: a failed test and null.
[[nodiscard]] std::unique_ptr<kiosk::Stage> synthetic_stage(gles::Context& context, int width, int height);

}  // namespace lackwerk::test

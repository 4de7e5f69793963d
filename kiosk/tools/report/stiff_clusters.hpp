// Stiff cases of the flake clusters: colours that leave an octree no volume, no range or no memory.
//
// Why it exists: a capture may hold one colour, a line of colours, one dead pixel or 16 million texels, and the boxes
// must still be a partition of it. The report shows these cases and the unit tests hold them to the same bounds. Free
// function; one thread, no memory of its own afterwards (the largest case takes 0.7 GB while it runs).
#pragma once

#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

/// Adds the cases of kernel "clusters". `quick` takes 1 million texels for 16 million.
///
/// Reference: brute force over all texels and boxes, in double and long double. Every case is judged by texels outside
/// their one box and texels not counted (bound 0), and by the upper bound of the 1-Wasserstein distance.
void add_stiff_clusters(bool quick, Findings& findings);

}  // namespace lackwerk::report

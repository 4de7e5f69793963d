// The stiff cases of the flake clusters, as the report shows them, held to their bounds.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "kiosk/tools/report/stiff_clusters.hpp"

namespace lackwerk::report {
namespace {

TEST(ClusterStiffness, EveryCaseStaysWithinItsBound) {
  Findings findings;
  add_stiff_clusters(false, findings);
  std::set<std::string> names;
  for (const StiffCase& one : findings.stiff) {
    EXPECT_TRUE(one.passed()) << one.kernel << ", " << one.name << ": " << one.measure << " " << one.worst << ", bound "
                              << one.bound << " (" << one.where << ")";
    EXPECT_EQ(one.kernel, "clusters");
    names.insert(one.name);
  }
  const std::set<std::string> expected = {"1 pixel",  "one colour",         "two colours",      "collinear",
                                          "coplanar", "one outlier of 1e4", "16 million pixels"};
  EXPECT_EQ(names, expected);
  EXPECT_EQ(findings.stiff.size(), 6u * 4u + 1u + 3u);  // four judgements each, the outlier's others, three for many
}

}  // namespace
}  // namespace lackwerk::report

// Broken invariants abort, with both values printed. For programming errors only: expected failures are `Result`s.
// Any thread.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string_view>

namespace lackwerk {

/// Aborts unless `left == right`, printing both and `what`. Use: check_equal(tuples.size(), masses.size(), "row 3").
template <class A, class B>
void check_equal(const A& left, const B& right, std::string_view what) {
  if (left == right) return;
  std::ostringstream text;
  text << "broken invariant: " << what << ": " << left << " != " << right << '\n';
  std::fputs(text.str().c_str(), stderr);
  std::abort();
}

/// Aborts unless `left <= right`, printing both and `what`.
template <class A, class B>
void check_at_most(const A& left, const B& right, std::string_view what) {
  if (left <= right) return;
  std::ostringstream text;
  text << "broken invariant: " << what << ": " << left << " > " << right << '\n';
  std::fputs(text.str().c_str(), stderr);
  std::abort();
}

}  // namespace lackwerk

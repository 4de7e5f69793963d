// One loop over many numbers on several threads.
//
// Why it exists: baking is the same work for every vertex; the order must not matter, the waiting time does. Threads
// end with the call.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace lackwerk::packs {

/// `wanted`, or as many as the machine has (at most 16) where it is 0.
[[nodiscard]] inline int thread_count(int wanted) {
  const int most = 16;
  return std::clamp(wanted > 0 ? wanted : static_cast<int>(std::thread::hardware_concurrency()), 1, most);
}

/// Calls work(k) once for each k in [0, count), from `threads` threads, in no order. `work` must not throw.
template <class Work>
void for_each_index(std::size_t count, int threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t k = next++; k < count; k = next++) work(k);
  };
  std::vector<std::jthread> others;  // joined at the end
  for (int t = 1; t < threads; ++t) others.emplace_back(run);
  run();
}

}  // namespace lackwerk::packs

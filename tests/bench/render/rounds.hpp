// Timing of things that are compared with each other.
//
// Why it exists: on a shared machine two measurements one after the other differ by what else was running. Here all
// candidates take turns, round by round, and a ratio is the median over rounds of neighbours in time. Where a software
// rasteriser draws, the processor time of all its threads is the steadier measure: other programs hardly touch it.
// Values; the thread that calls run_rounds runs the candidates.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lackwerk::bench {

struct Candidate {
  std::string name;
  std::function<void(int frame)> frame;  ///< draws frame number `frame` and waits until it is drawn
  std::vector<double> ms;                ///< by the clock on the wall, one per round
  std::vector<double> cpu_ms;            ///< processor time of all threads of this process
};

/// Milliseconds that `work` takes.
[[nodiscard]] double time_ms(const std::function<void()>& work);
/// Middle value (the upper one of two); 0 for none.
[[nodiscard]] double median(std::vector<double> values);

/// Runs every candidate once untimed (it compiles and uploads), then `rounds` times in turn. `frame` counts rounds.
void run_rounds(std::vector<Candidate>& candidates, int rounds);

/// Median over the rounds of a's time over b's in the same round.
[[nodiscard]] double ratio(const Candidate& a, const Candidate& b);
[[nodiscard]] double cpu_ratio(const Candidate& a, const Candidate& b);

/// Figures as they are found, printed at once and kept for the JSON file.
class Report {
 public:
  void title(const std::string& text);
  /// `limit` is for the reader: "<= 1.8", or empty.
  void value(const std::string& name, double value, const std::string& unit, std::size_t count,
             const std::string& limit = {});
  /// The ratio of two candidates of one run, by both clocks.
  void compare(const std::string& name, const Candidate& a, const Candidate& b, const std::string& limit = {});
  /// Medians and smallest times of all candidates, and their ratios to the first.
  void table(const std::vector<Candidate>& candidates);
  [[nodiscard]] std::string json() const;

 private:
  struct Row {
    std::string section, name, unit, limit;
    double value;
    std::size_t count;
  };
  std::string section_;
  std::vector<Row> rows_;
};

/// The three load averages of the machine, as the kernel says them; "unknown" elsewhere.
[[nodiscard]] std::string machine_load();

}  // namespace lackwerk::bench

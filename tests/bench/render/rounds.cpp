#include "tests/bench/render/rounds.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>

namespace lackwerk::bench {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

double median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    if (b[k] > 0.0) ratios.push_back(a[k] / b[k]);
  return median(std::move(ratios));
}

double processor_ms() { return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

double time_ms(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void run_rounds(std::vector<Candidate>& candidates, int rounds) {
  for (Candidate& candidate : candidates) candidate.frame(0);
  for (int k = 1; k <= rounds; ++k)
    for (Candidate& candidate : candidates) {
      const double before = processor_ms();
      candidate.ms.push_back(time_ms([&] { candidate.frame(k); }));
      candidate.cpu_ms.push_back(processor_ms() - before);
    }
}

double ratio(const Candidate& a, const Candidate& b) { return median_ratio(a.ms, b.ms); }
double cpu_ratio(const Candidate& a, const Candidate& b) { return median_ratio(a.cpu_ms, b.cpu_ms); }

void Report::title(const std::string& text) {
  section_ = text;
  std::printf("\n%s\n", text.c_str());
}

void Report::value(const std::string& name, double value, const std::string& unit, std::size_t count,
                   const std::string& limit) {
  std::printf("  %-58s %9.3f %-4s %s of %zu\n", name.c_str(), value, unit.c_str(), limit.c_str(), count);
  std::fflush(stdout);
  rows_.push_back({section_, name, unit, limit, value, count});
}

void Report::compare(const std::string& name, const Candidate& a, const Candidate& b, const std::string& limit) {
  value(name, ratio(a, b), "", a.ms.size(), limit);
  value(name + ", processor time", cpu_ratio(a, b), "", a.ms.size(), limit);
}

void Report::table(const std::vector<Candidate>& candidates) {
  std::printf("  %-58s   median ms  least   x first  cpu ms   x first\n", "");
  for (const Candidate& candidate : candidates) {
    const Candidate& first = candidates.front();
    const double least = *std::min_element(candidate.ms.begin(), candidate.ms.end());
    std::printf("  %-58s %9.2f %8.2f %8.3f %8.2f %8.3f   of %zu\n", candidate.name.c_str(), median(candidate.ms), least,
                ratio(candidate, first), median(candidate.cpu_ms), cpu_ratio(candidate, first), candidate.ms.size());
    const auto keep = [&](const char* what, const char* unit, double number) {
      rows_.push_back({section_, candidate.name + what, unit, {}, number, candidate.ms.size()});
    };
    keep("", "ms", median(candidate.ms));
    keep(", least", "ms", least);
    keep(" / first", "", ratio(candidate, first));
    keep(", processor time", "ms", median(candidate.cpu_ms));
    keep(", processor time / first", "", cpu_ratio(candidate, first));
  }
  std::fflush(stdout);
}

std::string Report::json() const {
  std::string out = "[";
  for (const Row& row : rows_) {
    std::array<char, 64> number{};
    std::snprintf(number.data(), number.size(), "%.6g", row.value);
    out += out.size() > 1 ? ",\n " : "\n ";
    out += "{\"section\": " + quoted(row.section) + ", \"name\": " + quoted(row.name) +
           ", \"value\": " + number.data() + ", \"unit\": " + quoted(row.unit) +
           ", \"count\": " + std::to_string(row.count) + "}";
  }
  return out + "\n]\n";
}

std::string machine_load() {
  std::ifstream file("/proc/loadavg");
  std::string one, five, fifteen;
  if (!(file >> one >> five >> fifteen)) return "unknown";
  return one + " " + five + " " + fifteen;
}

}  // namespace lackwerk::bench

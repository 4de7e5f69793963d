#include "kiosk/tools/report/machine.hpp"

#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>

#include <fstream>

namespace lackwerk::report {
namespace {

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return CPU_COUNT(&set);
}

}  // namespace

double load_now() {
  double load = 0.0;
  return getloadavg(&load, 1) == 1 ? load : 0.0;
}

Machine this_machine() {
  Machine machine;
  machine.processor = processor_name();
  machine.cores = usable_cores();
  const double pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
  machine.memory_gib = pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0 * 1024.0);
  utsname name{};
  if (uname(&name) == 0) machine.system = std::string(name.sysname) + " " + name.release + " " + name.machine;
#if defined(__clang__)
  machine.compiler = "clang " __clang_version__;
#else
  machine.compiler = "g++ " __VERSION__;
#endif
  machine.load_before = load_now();
  return machine;
}

}  // namespace lackwerk::report

// What the report was measured on.
//
// Why it exists: a time without its machine says nothing. Read once, before anything is measured; a value.
#pragma once

#include <string>

namespace lackwerk::report {

struct Machine {
  std::string processor;  ///< model name; "unknown processor" where the system does not tell
  int cores = 1;          ///< that this process may use
  double memory_gib = 0.0;
  std::string system;        ///< kernel name and release, machine
  std::string compiler;      ///< that built this program
  double load_before = 0.0;  ///< of one minute, when the report began: above 0.5 its times are too long
  double load_after = 0.0;   ///< when it ended: the report's own work included
};

[[nodiscard]] Machine this_machine();
/// The system's load of one minute; 0 where it does not tell.
[[nodiscard]] double load_now();

}  // namespace lackwerk::report

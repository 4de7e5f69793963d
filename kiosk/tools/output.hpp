// What every command prints alike: errors, JSON, and the exit codes.
//
// Why it exists: whoever scripts `lackwerk` relies on one line of error on stderr and on three exit codes. Free
// functions; one thread.
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"

namespace lackwerk::tools {

inline constexpr int exit_done = 0, exit_failed = 1, exit_usage = 2;

/// `text` with every control character (line ends included) replaced by a space.
[[nodiscard]] std::string one_line(std::string_view text);

/// Prints "lackwerk: file: field: what (remedy)" on stderr, one line whatever the texts hold. Returns the exit code.
[[nodiscard]] int report(const Error& error);

/// Sends stderr to nowhere while it lives: libpng prints its own complaints there, and an error is to be one line. For
/// the main thread around one library call; nothing else may be printing.
class QuietStderr {
 public:
  QuietStderr();
  ~QuietStderr();
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  int saved_;
};

/// Prints a line on stdout.
void print(std::string_view line);

/// `value` with `digits` digits after the point.
[[nodiscard]] std::string fixed(double value, int digits);

}  // namespace lackwerk::tools

// Expected failures as values: what went wrong, where (file and field), and what to do about it.
//
// Why it exists: bad files, devices and packs are everyday events of a kiosk. They travel as `Result<T>` up to the
// command line, which prints one line and picks the exit code. Owns its strings; any thread.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace lackwerk {

enum class ErrorKind {
  run,    ///< bad data, bad device, bad pack: exit code 1
  usage,  ///< the caller asked for something that makes no sense: exit code 2
};

struct Error {
  std::string file;    ///< the file or device concerned; empty where there is none
  std::string field;   ///< field, key, line or offset inside it; empty where there is none
  std::string what;    ///< what is wrong
  std::string remedy;  ///< what to do about it
  ErrorKind kind = ErrorKind::run;

  /// One line for stderr: "file: field: what (remedy)".
  [[nodiscard]] std::string line() const {
    std::string out;
    if (!file.empty()) out += file + ": ";
    if (!field.empty()) out += field + ": ";
    out += what;
    if (!remedy.empty()) out += " (" + remedy + ")";
    return out;
  }
};

template <class T>
using Result = tl::expected<T, Error>;

/// Builds the unexpected side of a Result. `kind` is `run` unless the mistake is in the call itself.
[[nodiscard]] inline tl::unexpected<Error> fail(std::string file, std::string field, std::string what,
                                                std::string remedy = {}, ErrorKind kind = ErrorKind::run) {
  return tl::unexpected<Error>(Error{std::move(file), std::move(field), std::move(what), std::move(remedy), kind});
}

}  // namespace lackwerk

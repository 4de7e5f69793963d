// What devices say of themselves, made fit for logs and screens, and the short list of what a source has to say.
//
// Why it exists: a device's name comes from a stranger and goes to a terminal, into JSON and to a text renderer; and a
// plug with a loose contact must not fill the journal. Values; any thread, one at a time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "input/source.hpp"

namespace lackwerk::input {

/// At most 80 bytes of `text`, well-formed UTF-8; each byte that is none, and every control character, becomes '?'.
/// Spaces at both ends fall away; an empty one becomes "unnamed".
[[nodiscard]] std::string printable(std::string_view text);

/// Notices until somebody takes them: the same one once, 32 at most; more are counted.
class Notices {
 public:
  void add(bool problem, const std::string& text);
  void take(std::vector<Notice>& out);

 private:
  std::vector<Notice> lines_;
  std::size_t dropped_ = 0;
};

}  // namespace lackwerk::input

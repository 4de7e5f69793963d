// Reads a JSON file of our own, field by field.
//
// Why it exists: what the dealer has chosen and what the importer has left are read by the same rules: an absent key
// changes nothing, unknown ones are passed over, and the first key with a value it cannot have is named. A reader
// refers to its object and to `wrong`, which outlive it; one thread.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/error.hpp"

namespace lackwerk::kiosk {

/// The object that `text` is; whoever calls has bounded its length. `file` and `remedy` are for the error: it is none.
[[nodiscard]] Result<nlohmann::json> parse_object(const std::string& text, const std::string& file, const char* remedy);

class JsonFields {
 public:
  /// `wrong`: the first key whose value is none it can have is put there; empty: there was none yet. Several readers
  /// may share one.
  JsonFields(const nlohmann::json& object, std::string& wrong) : object_(object), wrong_(wrong) {}

  void take(const char* key, bool& to) const;
  /// In [least, most].
  void take(const char* key, double& to, double least, double most) const;
  /// The same; what stands behind the point falls away.
  void take(const char* key, int& to, int least, int most) const;
  /// Whole and not negative.
  void take(const char* key, std::uint64_t& to) const;
  void take(const char* key, std::int64_t& to) const;

  /// For values with rules of their own. Null: the key is absent, or (of text()) refused, for it is none.
  [[nodiscard]] const nlohmann::json* find(const char* key) const;
  [[nodiscard]] const std::string* text(const char* key) const;
  void refuse(const char* key) const;

 private:
  const nlohmann::json& object_;
  std::string& wrong_;
};

}  // namespace lackwerk::kiosk

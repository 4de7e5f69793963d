#include "kiosk/display/json_fields.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace lackwerk::kiosk {
namespace {

using Json = nlohmann::json;

template <class Number>
std::optional<Number> whole_number(const Json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  return std::in_range<Number>(number) ? std::optional(static_cast<Number>(number)) : std::nullopt;
}

}  // namespace

Result<Json> parse_object(const std::string& text, const std::string& file, const char* remedy) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return fail(file, "", "is damaged: no JSON object", remedy);
  return json;
}

void JsonFields::take(const char* key, bool& to) const {
  const Json* value = find(key);
  if (value == nullptr) return;
  value->is_boolean() ? void(to = value->get<bool>()) : refuse(key);
}

void JsonFields::take(const char* key, double& to, double least, double most) const {
  const Json* value = find(key);
  if (value == nullptr) return;
  const double number = value->is_number() ? value->get<double>() : least - 1.0;
  number >= least&& number <= most ? void(to = number) : refuse(key);
}

void JsonFields::take(const char* key, int& to, int least, int most) const {
  double number = to;
  take(key, number, least, most);
  to = static_cast<int>(number);
}

void JsonFields::take(const char* key, std::uint64_t& to) const {
  const Json* value = find(key);
  if (value == nullptr) return;
  const auto number = whole_number<std::uint64_t>(*value);
  number ? void(to = *number) : refuse(key);
}

void JsonFields::take(const char* key, std::int64_t& to) const {
  const Json* value = find(key);
  if (value == nullptr) return;
  const auto number = whole_number<std::int64_t>(*value);
  number ? void(to = *number) : refuse(key);
}

const Json* JsonFields::find(const char* key) const {
  const auto at = object_.find(key);
  return at == object_.end() ? nullptr : &*at;
}

const std::string* JsonFields::text(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) return nullptr;
  if (value->is_string()) return &value->get_ref<const std::string&>();
  refuse(key);
  return nullptr;
}

void JsonFields::refuse(const char* key) const {
  if (wrong_.empty()) wrong_ = key;
}

}  // namespace lackwerk::kiosk

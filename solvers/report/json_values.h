// Values of a JSON document that may lack them.
#pragma once
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "ibrdf/base/format.h"

namespace ibrdf {

inline double ToNumber(const nlohmann::ordered_json& value) {
  return value.is_number() ? value.get<double>()
                           : std::numeric_limits<double>::quiet_NaN();
}

// The member of an object; NaN where it is missing or not a number.
inline double NumberAt(const nlohmann::ordered_json& object, const char* key) {
  if (!object.is_object()) return ToNumber(nullptr);
  const auto found = object.find(key);
  return found == object.end() ? ToNumber(nullptr) : ToNumber(*found);
}

// The same, empty where it is missing or not a text.
inline std::string TextAt(const nlohmann::ordered_json& object,
                          const char* key) {
  if (!object.is_object()) return "";
  const auto found = object.find(key);
  return found == object.end() || !found->is_string()
             ? ""
             : found->get<std::string>();
}

// The same, null where it is missing.
inline nlohmann::ordered_json MemberAt(const nlohmann::ordered_json& object,
                                       const char* key) {
  if (!object.is_object() || !object.contains(key)) return nullptr;
  return object.at(key);
}

// Four digits, whole numbers below a billion in full; "-" for what is not
// finite.
inline std::string ShortNumber(double value) {
  if (!std::isfinite(value)) return "-";
  const bool whole = value == std::floor(value) && std::fabs(value) < 1e9;
  return Format(whole ? "%.0f" : "%.4g", value);
}

}  // namespace ibrdf

// The metrics of a result and what they mean.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace ibrdf {

// Of result.json's `metrics` and `problem`: a <section>.
std::string MetricsSection(const nlohmann::ordered_json& metrics,
                           const nlohmann::ordered_json& problem);

}  // namespace ibrdf

// What a reader should know before trusting a result.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ibrdf {

// Sentences about a document as result.json; none: nothing stands out.
std::vector<std::string> ResultWarnings(const nlohmann::ordered_json& result);

}  // namespace ibrdf

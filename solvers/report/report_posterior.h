// How well a reflectance is known.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace ibrdf {

// Of result.json's `posterior` and of brdf.json: a <section>, empty if `brdf`
// is null (the reflectance was known).
std::string PosteriorSection(const nlohmann::ordered_json& posterior,
                             const nlohmann::ordered_json& brdf);

}  // namespace ibrdf

#include "ibrdf/io/problem_schema.h"

#include <glog/logging.h>

#include <algorithm>

#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_keys.h"

namespace ibrdf {
namespace problem_keys {
namespace {

Keys KindKeys() {
  return {
      Row("problem", "What is unknown, and so estimated.")
          .Choice("joint",
                  {{"joint", "Reflectance and illumination are both unknown."},
                   {"reflectance",
                    "The illumination is known, so `illumination.known` is "
                    "needed."},
                   {"illumination",
                    "The reflectance is known, so `reflectance.known` is "
                    "needed."},
                   {"textures",
                    "Roughness, gloss and albedo of every texel, of several "
                    "`views` under known light. `ibrdf_uncertainty` says what "
                    "they leave unknown."}})
          .UsedBy(kPhotographs)};
}

Keys AllKeys() {
  return Join({KindKeys(), ImageKeys(), CameraKeys(), ViewKeys(),
               GeometryKeys(), ReflectanceKeys(), IlluminationKeys(), SkyKeys(),
               LikelihoodKeys(), EffectsKeys(), SolverKeys(), TruthKeys(),
               TextureKeys(), RenderKeys()});
}

}  // namespace
}  // namespace problem_keys

const ProblemKey& ProblemSchema::Key(const std::string& path) const {
  const auto key =
      std::find_if(keys.begin(), keys.end(),
                   [&](const ProblemKey& k) { return k.path == path; });
  CHECK(key != keys.end()) << "no key " << path;
  return *key;
}

std::vector<std::string> ProblemSchema::NamesBelow(
    const std::string& map) const {
  std::vector<std::string> names;
  for (const ProblemKey& key : keys) {
    if (key.Parent() == map) names.push_back(key.Name());
  }
  return names;
}

const ProblemSchema& ProblemFileSchema() {
  static const ProblemSchema schema = {problem_keys::AllKeys()};
  return schema;
}

}  // namespace ibrdf

// What a map of uncertainty is made from: surface, views, light.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/next_view/candidate_views.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/solvers/problem/photographed_views.h"
#include "ibrdf/surface/texel_irradiance.h"

namespace ibrdf {

struct UncertaintyInputs {
  TexturedSurface surface;
  std::vector<PhotographedView> views;  // one or more
  Image prefiltered;                    // PrefilterMap of the light
  double prefilter_alpha = 0.0;
  double mean_radiance = 1.0;  // of the light, over directions and channels
  // With the shadows of the problem's uncertainty.
  std::shared_ptr<const TexelIrradiance> irradiance;
  std::vector<std::string> warnings;
};

// Reads the files of a problem that CheckTextures passes, which is called
// first. Refuses black light.
StatusOr<UncertaintyInputs> LoadUncertaintyInputs(const Problem& problem,
                                                  int num_threads);

// What candidates for further views are placed by.
CandidateSetting SettingOf(const UncertaintyInputs& inputs);

}  // namespace ibrdf

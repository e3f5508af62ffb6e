// The look before a solve: the numbers that say whether the photograph and the
// shape can be what the problem takes them for.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/photograph_check/colour_spread.h"
#include "ibrdf/solvers/photograph_check/colour_steps.h"
#include "ibrdf/solvers/photograph_check/like_normals.h"
#include "ibrdf/solvers/photograph_check/normal_scores.h"
#include "ibrdf/solvers/photograph_check/pixel_counts.h"

namespace ibrdf {

// Borrows what it refers to, for the call.
struct LookInput {
  const Image& radiance;
  const Mask& mask;                         // of the object; empty: all
  const std::vector<ShadingPoint>& points;  // of the object's pixels
  const Image& normal_map;  // as Scene::normal_map(); empty: another geometry
  bool codes = false;       // the file holds whole numbers
  std::string curve;        // which curve was taken and why, in words
  double exposure = 1.0;    // that radiance was divided by
  size_t missing = 0;       // the mask's pixels that the file lacks or hides
  // Intersection over union of mask and object; unset: no mask.
  std::optional<double> overlap;
};

struct PhotographCheck {
  int width = 0, height = 0;
  size_t mask_pixels = 0;  // of the mask, where there is one, else of the image
  bool has_mask = false;
  bool codes = false;
  std::string curve;
  double exposure = 1.0;
  size_t missing = 0;
  std::optional<double> overlap;
  ObjectPixelCounts counts;
  double radiance_1 = 0.0, radiance_99 = 0.0;  // percentiles of used values
  LikeNormalsSpread like_normals;
  ColourSpread colours;
  double colour_steps = 0.0;  // SharpColourSteps
  // Readings of a normal map, the most plausible first; empty: another
  // geometry.
  std::vector<NormalScore> normals;

  bool SeveralMaterials() const { return SaysSeveralMaterials(colours); }
  // Where no two places have like normals, sharp changes of colour are all that
  // tells of paint.
  bool MayBePainted() const {
    return !colours.observable && colour_steps >= kMayBePainted;
  }
  // Null where there is no normal map.
  const NormalScore* AsGiven() const;
  // The first of the ranking where it is clearly better than what was given;
  // null: none is.
  const NormalScore* BetterNormals() const;
};

PhotographCheck CheckPhotograph(const LookInput& input);

}  // namespace ibrdf

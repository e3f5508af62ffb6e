// The photographed object: image, shape, the pixels that see it, and the look
// before a solve.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/radiance_bounds.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/photograph_check/photograph_check.h"
#include "ibrdf/solvers/problem/load_labels.h"
#include "ibrdf/solvers/problem/unknown_curve.h"
#include "ibrdf/solvers/problem/view_sheet.h"

namespace ibrdf {

// What the look before a solve saw, and what it is drawn from.
struct ObjectLook {
  PhotographCheck check;
  // What is known from both sides; NaN where codes are clipped, 0 where they
  // are black.
  Image radiance;
  Mask mask;         // of the object; empty: all pixels
  Mask silhouette;   // pixels that see the object, inside the mask or not
  Image normal_map;  // as Scene::normal_map(); empty: another geometry
};

struct PhotographedObject {
  // Observed, with its bounds and what is to be found of it (Photograph). All
  // images are the sheet's where there are several views.
  ViewSheet sheet;
  Image radiance;
  std::optional<RadianceBounds> bounds;
  std::optional<UnknownCurve> unknown_curve;
  Scene scene = Scene::UnitSphere();
  std::vector<ShadingPoint> points;      // at the centres of the mask's pixels
  std::vector<MaterialLabel> materials;  // of the points; empty: not labelled
  std::shared_ptr<const ObjectLook> look;
  std::vector<std::string> warnings;  // sentences that name the file
};

// What reflectance.variation comes to, auto by the look: kNone or kAlbedo, or
// kAuto where the solve is to decide. kLabels stays.
ReflectanceVariation ChosenVariation(const Problem& problem,
                                     const PhotographCheck& check);

// Reads image, mask and geometry of a problem that CheckSolvable passes, which
// is called first. Takes about a second for a megapixel.
StatusOr<PhotographedObject> LoadPhotographedObject(const Problem& problem,
                                                    int num_threads);

}  // namespace ibrdf

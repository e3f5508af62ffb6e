// The evaluators of entropy with their defaults, in the published form, and
// with each choice undone.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/entropy_study/study_scene.h"
#include "ibrdf/uncertainty/angular_entropy.h"
#include "ibrdf/uncertainty/spectrum_entropy.h"

namespace ibrdf {

// Where the angular evaluator has a texel's irradiance from.
enum class IrradianceSource {
  kFit,       // its fit to the incoming radiance
  kOpen,      // the map, as if the surface hid nothing
  kUnhidden,  // the map without what the surface hides
};

struct EvaluatorVariant {
  std::string name;  // no comma
  bool is_angular = false;
  SpectrumOptions spectrum;
  AngularOptions angular;
  IrradianceSource irradiance = IrradianceSource::kUnhidden;
  // Whether the incoming radiance is without what the surface hides. The
  // published model does not know of it.
  bool unhidden_light = true;
};

std::vector<EvaluatorVariant> EvaluatorVariants();

// num_threads <= 0: all.
StatusOr<EntropyMaps> EvaluateVariant(const EvaluatorVariant& variant,
                                      const StudyScene& scene, int num_threads);

}  // namespace ibrdf

#include "ibrdf/solvers/report/gauge_words.h"

namespace ibrdf {
namespace {

std::string LevelWords(SolverEstimator estimator) {
  return estimator == SolverEstimator::kMarginal
             ? "mean log reflectance that of the training materials"
             : "level: least prior cost of log colours (training materials)";
}

}  // namespace

std::string GaugeWords(const InverseProblem& inverse) {
  if (inverse.known_map.has_value()) return "set by the known illumination";
  if (inverse.known_brdf.has_value()) return "set by the known reflectance";
  switch (inverse.solver.gauge) {
    case SolverGauge::kGreyLight:
      return "scale between reflectance and light: the light's mean radiance "
             "is grey; " +
             LevelWords(inverse.solver.estimator);
    case SolverGauge::kUnitLight:
      return "scale between reflectance and light: the light's mean radiance "
             "is 1 in every channel";
    case SolverGauge::kPrior:
      break;
  }
  if (inverse.solver.estimator == SolverEstimator::kMarginal) {
    return "scale between reflectance and light: " +
           LevelWords(inverse.solver.estimator) + "; hue: most probable";
  }
  return "scale per channel between reflectance and light: least prior cost of "
         "log colours (training materials) and of the light's mean chroma";
}

}  // namespace ibrdf

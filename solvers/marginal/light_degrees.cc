#include "ibrdf/solvers/marginal/light_degrees.h"

#include <algorithm>

#include "ibrdf/approximation/harmonics.h"

namespace ibrdf {

RowMatrix HarmonicsOfTexels(int order, int map_height, int map_width) {
  const HarmonicProjection projection(order, map_height, map_width);
  RowMatrix out(map_height * map_width, NumHarmonics(order));
  for (int row = 0; row < map_height; ++row) {
    for (int column = 0; column < map_width; ++column) {
      projection.Texel(row, column, out.row(row * map_width + column).data());
    }
  }
  return out;
}

std::vector<double> VarianceLeftByDegree(
    const MarginalLikelihood& likelihood,
    const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, const LightMode& mode,
    int map_height, int map_width) {
  const int order = std::min(kLightDegrees, map_height / 2);
  const MarginalLikelihood::FunctionVariance variance =
      likelihood.LightFunctionVariance(
          matrices, errors, hyperparameters, mode,
          HarmonicsOfTexels(order, map_height, map_width));
  std::vector<double> out;
  for (int l = 0; l <= order; ++l) {
    const double prior = variance.prior.segment(l * l, 2 * l + 1).sum();
    const double left = variance.posterior.segment(l * l, 2 * l + 1).sum();
    out.push_back(prior > 0.0 ? std::clamp(left / prior, 0.0, 1.0) : 0.0);
  }
  return out;
}

}  // namespace ibrdf

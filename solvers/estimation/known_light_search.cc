#include "ibrdf/solvers/estimation/known_light_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/base/eigen_vectors.h"

namespace ibrdf {

std::vector<RankedMaterial> RankUnderKnownLight(
    const Transport& transport, const LobeModel& lobes,
    const MaterialPrior& prior, const std::vector<float>& map,
    const Observations& observed, const RobustLogLikelihood& likelihood) {
  const int num_lobes = lobes.num_lobes();
  const size_t nodes = lobes.grid_shape().num_nodes();
  const size_t points = observed.valid.size();
  std::vector<std::vector<float>> shapes(prior.materials.size());
  std::vector<const float*> fields;
  for (size_t m = 0; m < shapes.size(); ++m) {
    lobes.Tabulate(prior.materials[m].parameters.data(), false, &shapes[m]);
    for (int k = 0; k < num_lobes; ++k) {
      fields.push_back(shapes[m].data() + k * nodes);
    }
  }
  const size_t stride = 3 * fields.size();
  std::vector<float> rendered(points * stride);
  transport.RenderLobes(fields.data(), static_cast<int>(fields.size()),
                        map.data(), rendered.data());
  std::vector<RankedMaterial> ranked;
  std::vector<double> L_o(3 * points);
  for (size_t m = 0; m < prior.materials.size(); ++m) {
    Eigen::VectorXd x = prior.materials[m].parameters;
    Eigen::Array3d shift = Eigen::Array3d::Zero();
    int lit[3] = {0, 0, 0};
    const MutableLobeMixture mixture = lobes.Mixture(x.data());
    const Eigen::Array3Xd colours = mixture.Colours();
    for (size_t i = 0; i < L_o.size(); ++i) {
      const int c = static_cast<int>(i % 3);
      L_o[i] = 0.0;
      for (int k = 0; k < num_lobes; ++k) {
        L_o[i] += colours(c, k) *
                  rendered[i / 3 * stride + 3 * (m * num_lobes + k) + c];
      }
      // A black point, of which no level is right, tells nothing of it, nor
      // does one of stray light alone.
      const double light = observed.radiance[i] - likelihood.ambient[c];
      if (observed.valid[i / 3] && L_o[i] + likelihood.epsilon > 0.0 &&
          light > 0.0) {
        shift[c] += std::log(light + likelihood.epsilon) -
                    std::log(L_o[i] + likelihood.epsilon);
        ++lit[c];
      }
    }
    for (int c = 0; c < 3; ++c) shift[c] /= std::max(lit[c], 1);
    for (size_t i = 0; i < L_o.size(); ++i) L_o[i] *= std::exp(shift[i % 3]);
    mixture.ShiftColours(shift);
    double cost = EvaluateLikelihood(L_o, observed, likelihood, nullptr).cost +
                  prior.Cost(x, nullptr);
    if (!std::isfinite(cost)) cost = std::numeric_limits<double>::infinity();
    ranked.push_back({prior.materials[m].name, cost, ToVector(x)});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const RankedMaterial& a, const RankedMaterial& b) {
                     return a.cost < b.cost;
                   });
  return ranked;
}

}  // namespace ibrdf

#include "ibrdf/solvers/priors/embedding_prior.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

double SquaredDistance(const std::vector<double>& a,
                       const std::vector<double>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace

std::vector<MaterialCode> MaterialCodes(const NeuralBrdfModel& model) {
  const int size = model.shape.code_size();
  std::vector<MaterialCode> materials;
  for (int i = 0; i + 2 < model.num_codes(); i += 3) {
    MaterialCode m;
    m.name = model.names[i].substr(0, model.names[i].rfind('.'));
    m.code.assign(size, 0.0);
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < size; ++k) {
        m.code[k] += model.codes[static_cast<size_t>(i + c) * size + k] / 3.0;
      }
    }
    materials.push_back(std::move(m));
  }
  return materials;
}

std::vector<MaterialCode> SpreadMaterials(const NeuralBrdfModel& model,
                                          int count) {
  const std::vector<MaterialCode> all = MaterialCodes(model);
  std::vector<MaterialCode> taken;
  if (all.empty()) return taken;
  std::vector<double> mean(model.shape.code_size(), 0.0);
  for (const MaterialCode& m : all) {
    for (size_t k = 0; k < mean.size(); ++k) {
      mean[k] += m.code[k] / static_cast<double>(all.size());
    }
  }
  std::vector<double> nearest(all.size(),
                              std::numeric_limits<double>::infinity());
  size_t next = 0;
  for (size_t i = 1; i < all.size(); ++i) {
    if (SquaredDistance(all[i].code, mean) <
        SquaredDistance(all[next].code, mean)) {
      next = i;
    }
  }
  while (static_cast<int>(taken.size()) < count && taken.size() < all.size()) {
    taken.push_back(all[next]);
    for (size_t i = 0; i < all.size(); ++i) {
      nearest[i] =
          std::min(nearest[i], SquaredDistance(all[i].code, all[next].code));
    }
    next = static_cast<size_t>(
        std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return taken;
}

LobePrior EmbeddingPrior(const NeuralBrdfModel& model, double prior_sigma) {
  LobePrior prior;
  prior.sigma = prior_sigma;
  const int materials = model.num_codes() / 3;
  if (materials == 0) return prior;
  double mean[3] = {0, 0, 0}, all = 0.0, square = 0.0;
  for (int i = 0; i < 3 * materials; ++i) {
    const double a = model.log_colours[i];
    mean[i % 3] += a / materials;
    all += a;
    square += a * a;
  }
  all /= 3.0 * materials;
  for (int c = 0; c < 3; ++c) prior.colour_mean[c] = mean[c];
  prior.colour_sigma = std::max(
      std::sqrt(std::max(square / (3.0 * materials) - all * all, 0.0)), 0.5);
  return prior;
}

}  // namespace ibrdf

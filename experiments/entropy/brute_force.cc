#include "experiments/entropy/brute_force.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr int kSteps = 8;
constexpr int kCells = kBruteRoughnesses * kSteps * kSteps;

// The mean square of one channel of a texel for every cell (roughness, Ks, Kd).
std::vector<double> MeanSquares(const StudyScene& scene,
                                const std::vector<int>& views, int texel,
                                int c) {
  std::vector<double> sums(kCells, 0.0);
  double seen = 0.0;
  const double white = scene.samples.irradiance[3 * texel + c] / kPi;
  for (const int view : views) {
    const size_t at =
        static_cast<size_t>(texel) * scene.samples.num_views + view;
    if (scene.samples.weight[at] <= 0.0f) continue;
    seen += 1.0;
    const double B = scene.samples.outgoing[3 * at + c];
    for (int k = 0; k < kCells; ++k) {
      const int i = k / (kSteps * kSteps), j = k / kSteps % kSteps;
      const size_t from = (at * kBruteRoughnesses + i) * 3 + c;
      const double r = scene.fixed[from] +
                       j / (kSteps - 1.0) * scene.slope[from] +
                       k % kSteps / (kSteps - 1.0) * white - B;
      sums[k] += r * r;
    }
  }
  if (seen > 0.0) {
    for (double& x : sums) x /= seen;
  }
  return sums;
}

}  // namespace

BruteForce EvaluateBruteForce(const StudyScene& scene,
                              const std::vector<int>& views, double sharpness) {
  std::vector<int> used = views;
  if (used.empty()) {
    used.resize(scene.samples.num_views);
    std::iota(used.begin(), used.end(), 0);
  }
  BruteForce out;
  const int texels = scene.samples.num_texels;
  out.entropy.resize(3 * texels);
  out.error.resize(3 * texels);
  ParallelFor(texels, 0, [&](int64_t texel, int) {
    const StudyMaterial& m = scene.materials[texel];
    for (int c = 0; c < 3; ++c) {
      std::vector<double> x =
          MeanSquares(scene, used, static_cast<int>(texel), c);
      const double least = *std::min_element(x.begin(), x.end());
      double Z = 0.0;
      for (double& v : x) Z += v = std::exp((least - v) / sharpness);
      double H = 0.0, error = 0.0;
      for (int k = 0; k < kCells; ++k) {
        const double p = x[k] / Z;
        if (p > 0.0) H -= p * std::log(p);
        error += p *
                 (std::abs(k / (kSteps * kSteps) / 7.0 - m.roughness) +
                  std::abs(k / kSteps % kSteps / 7.0 - m.Ks[c]) +
                  std::abs(k % kSteps / 7.0 - m.Kd[c])) /
                 3.0;
      }
      out.entropy[3 * texel + c] = H / std::log(double(kCells));
      out.error[3 * texel + c] = error;
    }
  });
  return out;
}

}  // namespace ibrdf

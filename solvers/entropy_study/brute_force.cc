#include "ibrdf/solvers/entropy_study/brute_force.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "ibrdf/base/parallel_for.h"

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
  const double white = scene.matte[3 * texel + c];
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

// What a texel shows at a view for values of the parameters.
double Radiance(const StudyScene& scene, size_t at, int c, int i, double Ks,
                double matte) {
  const size_t from = (at * kBruteRoughnesses + i) * 3 + c;
  return scene.fixed[from] + Ks * scene.slope[from] + matte;
}

double LaplaceEntropy(const StudyScene& scene, const std::vector<int>& views,
                      int texel, int c, int cell, double sharpness) {
  const double white = scene.matte[3 * texel + c];
  const int i = cell / (kSteps * kSteps);
  const int low = std::max(0, i - 1);
  const int high = std::min(kBruteRoughnesses - 1, i + 1);
  const double Ks = cell / kSteps % kSteps / (kSteps - 1.0);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double seen = 0.0;
  for (const int view : views) {
    const size_t at =
        static_cast<size_t>(texel) * scene.samples.num_views + view;
    if (scene.samples.weight[at] <= 0.0f) continue;
    seen += 1.0;
    const double rise = Radiance(scene, at, c, high, Ks, 0.0) -
                        Radiance(scene, at, c, low, Ks, 0.0);
    const Eigen::Vector3d J(rise * (kBruteRoughnesses - 1.0) / (high - low),
                            scene.slope[(at * kBruteRoughnesses + i) * 3 + c],
                            white);
    information += J * J.transpose();
  }
  // exp(-mse / sharpness) has the variance sharpness / 2.
  if (seen > 0.0) information *= 2.0 / (sharpness * seen);
  information += 12.0 * Eigen::Matrix3d::Identity();
  return -0.5 * std::log(information.determinant());
}

}  // namespace

BruteForce EvaluateBruteForce(const StudyScene& scene,
                              const std::vector<int>& views, double sharpness,
                              int num_threads) {
  std::vector<int> used = views;
  if (used.empty()) {
    used.resize(scene.samples.num_views);
    std::iota(used.begin(), used.end(), 0);
  }
  BruteForce out;
  const int texels = scene.samples.num_texels;
  out.entropy.resize(3 * texels);
  out.error.resize(3 * texels);
  out.laplace.resize(3 * texels);
  ParallelFor(texels, num_threads, [&](int64_t texel, int) {
    const StudyMaterial& m = scene.materials[texel];
    for (int c = 0; c < 3; ++c) {
      std::vector<double> x =
          MeanSquares(scene, used, static_cast<int>(texel), c);
      const auto best = std::min_element(x.begin(), x.end());
      out.laplace[3 * texel + c] =
          LaplaceEntropy(scene, used, static_cast<int>(texel), c,
                         static_cast<int>(best - x.begin()), sharpness);
      const double least = *best;
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

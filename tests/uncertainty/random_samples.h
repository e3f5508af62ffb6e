// Samples of texels for tests.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/uncertainty/texel_samples.h"

namespace ibrdf {

// Sizes and zeros.
inline TexelSamples EmptySamples(int num_texels, int num_views) {
  TexelSamples out;
  out.num_texels = num_texels;
  out.num_views = num_views;
  const size_t samples = static_cast<size_t>(num_texels) * num_views;
  out.directions.assign(3 * samples, 0.0f);
  for (size_t k = 0; k < samples; ++k) out.directions[3 * k + 2] = 1.0f;
  out.outgoing.assign(3 * samples, 0.0f);
  out.incoming.assign(3 * samples, 0.0f);
  out.weight.assign(samples, 1.0f);
  return out;
}

// Directions all over the sphere, so that about half are below the horizon.
inline void RandomDirections(std::mt19937* rng, TexelSamples* samples) {
  std::normal_distribution<double> normal;
  for (size_t k = 0; k < samples->weight.size(); ++k) {
    const Eigen::Vector3d u =
        Eigen::Vector3d(normal(*rng), normal(*rng), normal(*rng)).normalized();
    for (int i = 0; i < 3; ++i) {
      samples->directions[3 * k + i] = static_cast<float>(u[i]);
    }
  }
}

// A band-limited light of amplitude falling with the degree, mean radiance
// about 1, and a Kd + Ks exp(-(alpha l)^2) surface under it: the model of
// Wiersma et al. without its approximations. Every texel has its own light.
inline void FillByModel(int order, double alpha, double Ks, double Kd,
                        std::mt19937* rng, TexelSamples* samples) {
  const HarmonicBasis basis(order);
  Eigen::VectorXd Y(basis.count());
  std::normal_distribution<double> normal;
  for (int texel = 0; texel < samples->num_texels; ++texel) {
    HarmonicColours L(basis.count(), 3);
    for (int l = 0; l <= order; ++l) {
      for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
        for (int c = 0; c < 3; ++c) {
          L(k, c) = l == 0 ? 3.5 : normal(*rng) / (l + 1.0);
        }
      }
    }
    HarmonicColours B = L;
    for (int l = 0; l <= order; ++l) {
      B.middleRows(l * l, 2 * l + 1) *=
          Ks * std::exp(-(alpha * l) * (alpha * l));
    }
    B.row(0).array() += 3.5 * Kd;
    for (int view = 0; view < samples->num_views; ++view) {
      const size_t at =
          3 * (static_cast<size_t>(texel) * samples->num_views + view);
      const float* const w = &samples->directions[at];
      basis.Evaluate({w[1], w[2], w[0]}, Y.data());
      const Eigen::RowVector3d out = Y.transpose() * B, in = Y.transpose() * L;
      for (int c = 0; c < 3; ++c) {
        samples->outgoing[at + c] = static_cast<float>(out[c]);
        samples->incoming[at + c] = static_cast<float>(in[c]);
      }
    }
  }
}

}  // namespace ibrdf

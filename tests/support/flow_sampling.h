// Exact samples of a flow's density: the inverse flow of uniform numbers.
#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "ibrdf/flow/brdf_flow.h"

namespace ibrdf {

// Draws `count` points of the cube from the density of a code [code_size]:
// x [3][count], each coordinate in [0, 1]. The same seed gives the same bits
// for any number of threads.
inline void SampleFlow(const BrdfFlow& flow, const float* code, uint64_t seed,
                       int64_t count, int num_threads, double* x) {
  std::mt19937_64 rng(seed);
  std::vector<double> latent(3 * count);
  // The top 53 bits as a fraction, in [0, 1): the same with any library.
  for (double& u : latent) u = static_cast<double>(rng() >> 11) * 0x1p-53;
  flow.Inverse(latent.data(), count, code, num_threads, x);
}

}  // namespace ibrdf

#include "ibrdf/flow/sampling.h"

#include <random>
#include <vector>

namespace ibrdf {

void SampleFlow(const BrdfFlow& flow, const float* code, uint64_t seed,
                int64_t count, int num_threads, double* x) {
  std::mt19937_64 rng(seed);
  std::vector<double> latent(3 * count);
  // The top 53 bits as a fraction, in [0, 1): the same with any library.
  for (double& u : latent) u = static_cast<double>(rng() >> 11) * 0x1p-53;
  flow.Inverse(latent.data(), count, code, num_threads, x);
}

}  // namespace ibrdf

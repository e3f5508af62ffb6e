// Exact samples of the flow's density: the inverse flow of uniform numbers.
#pragma once
#include <cstdint>

#include "ibrdf/flow/brdf_flow.h"

namespace ibrdf {

// Draws `count` points of the cube from the density of a code [code_size]:
// x [3][count], each coordinate in [0, 1]. The same seed gives the same bits
// for any number of threads.
void SampleFlow(const BrdfFlow& flow, const float* code, uint64_t seed,
                int64_t count, int num_threads, double* x);

}  // namespace ibrdf

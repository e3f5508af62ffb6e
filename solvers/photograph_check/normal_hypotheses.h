// What a normal map may be in truth, if its frame or encoding was taken
// wrongly.
#pragma once
#include <array>

#include "ibrdf/image/image.h"

namespace ibrdf {

enum class NormalHypothesis {
  kAsGiven,
  kXFlipped,
  kYFlipped,
  kBothFlipped,
  kSwapped,     // x and y
  kOpenCv,      // y down, z away from the camera, or the other way round
  kWasEncoded,  // (n + 1) / 2, taken for n
  kWasFloat,    // n, taken for (n + 1) / 2
};
inline constexpr int kNumNormalHypotheses = 8;

// In a picture: "y flipped".
const char* NameOf(NormalHypothesis hypothesis);

// What to do where it is true: a key of the problem file, or words.
const char* AdviceFor(NormalHypothesis hypothesis);

// The normals as they would be if the hypothesis were true. `normals`: unit
// vectors in the camera's frame as they were taken; zero: none, which stays.
// Exact, but for kWasEncoded, where a normal with n_x + n_y + n_z < -1 cannot
// be told from its mirror image, as lengths are lost.
Image UnderHypothesis(const Image& normals, NormalHypothesis hypothesis);

}  // namespace ibrdf

// Dense layers of the conditioner networks: where their weights lie.
#pragma once
#include <cstddef>

namespace ibrdf {

// Rows [out, out + out_count) of the activations =
// act(W rows [in, in + in_count) + b). Offsets count floats from the start of
// the network's weights; W is [out_count][in_count].
struct DenseLayer {
  int in = 0, in_count = 0;
  int out = 0, out_count = 0;
  bool activation = true;
  size_t weight_offset = 0;
  size_t bias_offset = 0;
  // The offset of the gradient [out_count][PaddedCount(in_count)] in a kernel's
  // own layout.
  size_t padded_offset = 0;
};

// The start's last layer, relative to He scaling: near the identity, yet with
// enough signal for the hidden layers' first gradients.
inline constexpr float kLastLayerScale = 0.1f;

// Whole vectors of any instruction set.
inline int PaddedCount(int n) { return (n + 31) / 32 * 32; }

// Activation (x + sqrt(x^2 + kSharpness)) / 2: a smooth ReLU, so that residuals
// have continuous derivatives in code and colour.
inline constexpr double kSharpness = 0.25;

}  // namespace ibrdf

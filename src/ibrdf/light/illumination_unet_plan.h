// Structure of the illumination UNet: its feature maps, steps and weights.
//
// One plan drives both implementations, the fast float one
// (illumination_unet.cc) and the plain one (illumination_unet_reference.h).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ibrdf/light/illumination_unet_activation.h"

namespace ibrdf {

struct IlluminationUnetOptions {
  int width = 128;        // of the map, texels; even
  int height = 64;        // of the map, texels
  int scales = 4;         // at most; see UnetPlan::scales
  int channels = 32;      // of every feature map but the skip branches
  int skip_channels = 8;  // of the 1x1 skip branches; 0: none
  int noise_channels = 8;
  // Instance normalisation of every hidden convolution: bounds how strongly
  // the map responds to its weights, which optimisers of any order need.
  bool normalize = true;
  uint64_t seed = 0;    // of the noise
  int num_threads = 0;  // <= 0: HardwareThreads(); the bits do not depend on it
};

// A feature map [channels][height][width].
struct UnetTensor {
  int channels;
  int height;
  int width;
};

// A convolution, with its bias and usually the activation, of one or two
// inputs concatenated along the channels; or a bilinear upsampling by two.
//
// Beyond its edges a map continues on the sphere (UnetTexel below). Output
// texel q of a convolution of size k and stride s sees the k input texels from
// s q - (k - s)/2 on, which lie evenly about it: halving takes 4 x 4 taps, as 3
// would move the map by half a texel, towards the one pole and from the other.
struct UnetStep {
  enum Kind { kConvolution, kUpsampling };
  Kind kind;
  std::vector<int> inputs;  // tensors
  int output;               // tensor
  int size = 1;             // 1, 3, or 4 with stride 2
  int stride = 1;           // 1 or 2
  int before() const { return (size - stride) / 2; }  // taps before s q
  // Before bias and activation, each output channel less its mean over the
  // map, by its standard deviation (+ kUnetNormEpsilon under the root).
  bool normalize = false;
  bool activate = false;
  int weight_offset = 0;  // [size][size][input channel][output channel]
  int bias_offset = 0;    // [output channel]
};

// A named run of weights, for priors that treat parts differently. The names:
// "scale<i>.down1|down2|skip|merge3|merge1" and "output", each followed by
// ".weight" or ".bias"; scale0 is the finest.
struct WeightBlock {
  std::string name;
  int offset;
  int size;
  bool is_bias;
  bool is_output;  // of the last layer
  int fan_in;      // inputs of one output value, the bias not counted
};

struct UnetPlan {
  // Scales in use: the most, up to options.scales, for which every halved
  // map is exact (even width and height before), with width even after (the
  // shift by half a turn over the pole) and at least 2 rows after.
  int scales = 0;
  int num_weights = 0;
  std::vector<UnetTensor> tensors;  // [0]: the noise; back(): log-radiance
  std::vector<UnetStep> steps;      // in order of evaluation
  std::vector<WeightBlock> blocks;  // in order, covering all weights

  int InputChannels(const UnetStep& step) const;
};

UnetPlan MakeUnetPlan(const IlluminationUnetOptions& options);

// The texel that (row, column) names on the sphere: columns wrap; a row beyond
// a pole (row >= -height and < 2 height) is the mirrored row half a turn away,
// as the great circle goes on.
struct UnetTexelIndex {
  int row;
  int column;
};
inline UnetTexelIndex UnetTexel(int row, int column, int height, int width) {
  if (row < 0 || row >= height) {
    row = row < 0 ? -1 - row : 2 * height - 1 - row;
    column += width / 2;
  }
  column %= width;
  return {row, column < 0 ? column + width : column};
}

}  // namespace ibrdf

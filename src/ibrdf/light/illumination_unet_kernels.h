// Inner loops of the illumination UNet, one table per instruction set.
//
// Feature maps lie channels-last: a texel is `stride` floats apart from the
// next, a multiple of kUnetChannelGroup, the channels beyond the map's own
// being zero or never read. Output channels are computed in whole vectors.
#pragma once
#include <cstdint>

#include "ibrdf/base/simd_dispatch.h"

namespace ibrdf {

// Channel counts in memory are rounded up to this: the widest vector.
constexpr int kUnetChannelGroup = 16;

// One kernel tap of one input of a convolution row.
struct UnetTap {
  const float* input;    // at output texel 0
  const float* weights;  // [channels][weight_stride]
  int channels;
  int input_stride;  // floats from the input of one output texel to the next
};

struct UnetKernels {
  // out[texel][o] = start[o] + sum over taps and channels; start null: adds to
  // what out holds. out_channels is rounded up to whole vectors.
  void (*convolve_row)(const UnetTap* taps, int num_taps, int weight_stride,
                       int out_channels, const float* start, float* out,
                       int out_stride, int texels);
  // gradient[i][o] += sum over a block of rows x columns texels of
  // input[texel][i] adjoint[texel][o]; channels is rounded up to
  // kUnetGradientGroup, out_channels to whole vectors.
  void (*weight_gradient)(const float* input, int64_t input_row, int input_step,
                          const float* adjoint, int64_t adjoint_row,
                          int adjoint_step, int rows, int columns, int channels,
                          int out_channels, float* gradient,
                          int gradient_stride);
  // sum[o] += sum over texels of adjoint[texel][o].
  void (*add_texels)(const float* adjoint, int stride, int texels,
                     int out_channels, float* sum);
  // sum[o] += sum over texels of x[texel][o] y[texel][o].
  void (*add_products)(const float* x, const float* y, int stride, int texels,
                       int out_channels, float* sum);
  // x = scale x + shift + slope y, each factor [stride], by channel.
  void (*combine)(float* x, const float* y, int stride, int texels,
                  const float* scale, const float* shift, const float* slope);
  // Activation in place (illumination_unet_activation.h) and its slope; count
  // is a multiple of kUnetChannelGroup here and below.
  void (*activate)(float* x, float* slope, int64_t count);
  void (*multiply)(float* x, const float* factor, int64_t count);
  // One row of bilinear upsampling: 3/4 near + 1/4 far, likewise along the row,
  // which needs texels -1 and `texels`; writes 2 texels of the output each.
  void (*upsample_row)(const float* near, const float* far, int stride,
                       int texels, float* out);
  // Its adjoint: one row of the coarse map from the fine rows 2r-1 ... 2r+2.
  void (*upsample_adjoint_row)(const float* const fine[4], int stride,
                               int texels, float* out);
};

// Input channels are taken in groups of this size by weight_gradient.
constexpr int kUnetGradientGroup = 8;

// level must be supported by this machine.
const UnetKernels& GetUnetKernels(SimdLevel level);

}  // namespace ibrdf

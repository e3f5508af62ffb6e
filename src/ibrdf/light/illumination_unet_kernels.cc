#include "ibrdf/light/illumination_unet_kernels.h"

#include "ibrdf/base/simd.h"
#include "ibrdf/light/illumination_unet_activation.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// Texels whose sums are held in registers at once: with two vectors of output
// channels each, 16 of 32 (AVX-512) or 8 of 16 registers.
constexpr int kTexelBlock = kLanes == 16 ? 8 : 4;

// kVectors vectors of output channels of kTexels texels.
template <int kVectors, int kTexels>
inline void ConvolveBlock(const UnetTap* taps, int num_taps, int weight_stride,
                          int first_texel, int first_channel,
                          const float* start, float* out, int out_stride) {
  out += static_cast<int64_t>(first_texel) * out_stride + first_channel;
  Vf sum[kTexels][kVectors];
  for (int t = 0; t < kTexels; ++t) {
    for (int v = 0; v < kVectors; ++v) {
      sum[t][v] = Load(start != nullptr ? start + first_channel + v * kLanes
                                        : out + t * out_stride + v * kLanes);
    }
  }
  for (int k = 0; k < num_taps; ++k) {
    const int64_t step = taps[k].input_stride;
    const float* x = taps[k].input + first_texel * step;
    const float* w = taps[k].weights + first_channel;
    const float* const end = x + taps[k].channels;
    for (; x != end; ++x, w += weight_stride) {
      Vf weight[kVectors];
      for (int v = 0; v < kVectors; ++v) weight[v] = Load(w + v * kLanes);
      for (int t = 0; t < kTexels; ++t) {
        const float value = x[t * step];
        for (int v = 0; v < kVectors; ++v) sum[t][v] += value * weight[v];
      }
    }
  }
  for (int t = 0; t < kTexels; ++t) {
    for (int v = 0; v < kVectors; ++v) {
      Store(out + t * out_stride + v * kLanes, sum[t][v]);
    }
  }
}

template <int kVectors>
void ConvolveChannels(const UnetTap* taps, int num_taps, int weight_stride,
                      int first_channel, const float* start, float* out,
                      int out_stride, int texels) {
  int t = 0;
  for (; t + kTexelBlock <= texels; t += kTexelBlock) {
    ConvolveBlock<kVectors, kTexelBlock>(taps, num_taps, weight_stride, t,
                                         first_channel, start, out, out_stride);
  }
  for (; t + 2 <= texels; t += 2) {
    ConvolveBlock<kVectors, 2>(taps, num_taps, weight_stride, t, first_channel,
                               start, out, out_stride);
  }
  for (; t < texels; ++t) {
    ConvolveBlock<kVectors, 1>(taps, num_taps, weight_stride, t, first_channel,
                               start, out, out_stride);
  }
}

void ConvolveRow(const UnetTap* taps, int num_taps, int weight_stride,
                 int out_channels, const float* start, float* out,
                 int out_stride, int texels) {
  int c = 0;
  for (; c + kLanes < out_channels; c += 2 * kLanes) {
    ConvolveChannels<2>(taps, num_taps, weight_stride, c, start, out,
                        out_stride, texels);
  }
  if (c < out_channels) {
    ConvolveChannels<1>(taps, num_taps, weight_stride, c, start, out,
                        out_stride, texels);
  }
}

// kVectors vectors of output channels of kInputs input channels.
template <int kVectors, int kInputs>
inline void GradientBlock(const float* input, int64_t input_row, int input_step,
                          const float* adjoint, int64_t adjoint_row,
                          int adjoint_step, int rows, int columns,
                          float* gradient, int gradient_stride) {
  Vf sum[kInputs][kVectors];
  for (int i = 0; i < kInputs; ++i) {
    for (int v = 0; v < kVectors; ++v) {
      sum[i][v] = Load(gradient + i * gradient_stride + v * kLanes);
    }
  }
  for (int r = 0; r < rows; ++r) {
    const float* x = input + r * input_row;
    const float* a = adjoint + r * adjoint_row;
    for (int c = 0; c < columns; ++c, x += input_step, a += adjoint_step) {
      Vf value[kVectors];
      for (int v = 0; v < kVectors; ++v) value[v] = Load(a + v * kLanes);
      for (int i = 0; i < kInputs; ++i) {
        for (int v = 0; v < kVectors; ++v) sum[i][v] += x[i] * value[v];
      }
    }
  }
  for (int i = 0; i < kInputs; ++i) {
    for (int v = 0; v < kVectors; ++v) {
      Store(gradient + i * gradient_stride + v * kLanes, sum[i][v]);
    }
  }
}

void WeightGradient(const float* input, int64_t input_row, int input_step,
                    const float* adjoint, int64_t adjoint_row, int adjoint_step,
                    int rows, int columns, int channels, int out_channels,
                    float* gradient, int gradient_stride) {
  constexpr int kInputs = kLanes == 16 ? 8 : 4;
  static_assert(kUnetGradientGroup % kInputs == 0, "whole blocks");
  for (int i = 0; i < channels; i += kInputs) {
    float* g = gradient + static_cast<int64_t>(i) * gradient_stride;
    int c = 0;
    for (; c + kLanes < out_channels; c += 2 * kLanes) {
      GradientBlock<2, kInputs>(input + i, input_row, input_step, adjoint + c,
                                adjoint_row, adjoint_step, rows, columns, g + c,
                                gradient_stride);
    }
    if (c < out_channels) {
      GradientBlock<1, kInputs>(input + i, input_row, input_step, adjoint + c,
                                adjoint_row, adjoint_step, rows, columns, g + c,
                                gradient_stride);
    }
  }
}

void AddTexels(const float* adjoint, int stride, int texels, int out_channels,
               float* sum) {
  for (int c = 0; c < out_channels; c += kLanes) {
    Vf total = Load(sum + c);
    for (int t = 0; t < texels; ++t) total += Load(adjoint + t * stride + c);
    Store(sum + c, total);
  }
}

void AddProducts(const float* x, const float* y, int stride, int texels,
                 int out_channels, float* sum) {
  for (int c = 0; c < out_channels; c += kLanes) {
    Vf total = Load(sum + c);
    for (int t = 0; t < texels; ++t) {
      total += Load(x + t * stride + c) * Load(y + t * stride + c);
    }
    Store(sum + c, total);
  }
}

void Combine(float* x, const float* y, int stride, int texels,
             const float* scale, const float* shift, const float* slope) {
  for (int c = 0; c < stride; c += kLanes) {
    const Vf a = Load(scale + c), b = Load(shift + c), s = Load(slope + c);
    for (int t = 0; t < texels; ++t) {
      float* to = x + t * stride + c;
      Store(to, a * Load(to) + (b + s * Load(y + t * stride + c)));
    }
  }
}

void Activate(float* x, float* slope, int64_t count) {
  const float ramp = 0.5f * (1.0f + kUnetLeak);
  const float bend = 0.5f * (1.0f - kUnetLeak);
  for (int64_t i = 0; i < count; i += kLanes) {
    const Vf value = Load(x + i);
    const Vf inside =
        Max(Min(value, Splat(kUnetSaturation)), Splat(-kUnetSaturation));
    const Vf root = Sqrt(inside * inside + kUnetCurvature * kUnetCurvature);
    const Vf s = ramp + bend * inside / root;
    Store(slope + i, Select(inside == value, s, Vf{}));
    Store(x + i, ramp * inside + bend * (root - kUnetCurvature));
  }
}

void Multiply(float* x, const float* factor, int64_t count) {
  for (int64_t i = 0; i < count; i += kLanes) {
    Store(x + i, Load(x + i) * Load(factor + i));
  }
}

void UpsampleRow(const float* near, const float* far, int stride, int texels,
                 float* out) {
  for (int c = 0; c < stride; c += kLanes) {
    const auto column = [&](int t) {
      const int64_t i = static_cast<int64_t>(t) * stride + c;
      return 0.75f * Load(near + i) + 0.25f * Load(far + i);
    };
    Vf left = column(-1);
    Vf centre = column(0);
    float* o = out + c;
    for (int t = 0; t < texels; ++t, o += 2 * stride) {
      const Vf right = column(t + 1);
      Store(o, 0.75f * centre + 0.25f * left);
      Store(o + stride, 0.75f * centre + 0.25f * right);
      left = centre;
      centre = right;
    }
  }
}

void UpsampleAdjointRow(const float* const fine[4], int stride, int texels,
                        float* out) {
  for (int c = 0; c < stride; c += kLanes) {
    const auto column = [&](int t) {
      const int64_t i = static_cast<int64_t>(t) * stride + c;
      return 0.25f * (Load(fine[0] + i) + Load(fine[3] + i)) +
             0.75f * (Load(fine[1] + i) + Load(fine[2] + i));
    };
    Vf before = column(-1);
    Vf first = column(0);
    for (int t = 0; t < texels; ++t) {
      const Vf second = column(2 * t + 1);
      const Vf after = column(2 * t + 2);
      Store(out + static_cast<int64_t>(t) * stride + c,
            0.25f * (before + after) + 0.75f * (first + second));
      before = second;
      first = after;
    }
  }
}

}  // namespace

const UnetKernels& IlluminationUnetKernels() {
  static constexpr UnetKernels kernels = {
      ConvolveRow, WeightGradient, AddTexels,   AddProducts,       Combine,
      Activate,    Multiply,       UpsampleRow, UpsampleAdjointRow};
  return kernels;
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf

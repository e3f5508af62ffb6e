#include "ibrdf/light/illumination_unet_engine.h"

#include <glog/logging.h>

#include <algorithm>
#include <atomic>

#include "ibrdf/base/parallel_for.h"

namespace ibrdf {
namespace {

// Steps of fewer multiply-adds run in one thread: waking others costs more.
constexpr int64_t kParallelWork = 300000;

// Texels per block of the weight gradient: its rows stay in the first cache.
constexpr int kGradientTexels = 128;

// Addresses are used again after an engine's end; these numbers are not.
uint64_t NextId() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

void CopyTexel(const UnetMap& map, int from_row, int from_column, int row,
               int column) {
  std::copy_n(map.At(from_row, from_column), map.stride, map.At(row, column));
}

void WrapColumns(const UnetMap& map) {
  for (int r = 0; r < map.height; ++r) {
    CopyTexel(map, r, map.width - 1, r, -1);
    CopyTexel(map, r, 0, r, map.width);
  }
}

// Fills the border as the map continues on the sphere.
void FillBorder(const UnetMap& map) {
  WrapColumns(map);
  for (const int row : {-1, map.height}) {
    for (int c = -1; c <= map.width; ++c) {
      const UnetTexelIndex from = UnetTexel(row, c, map.height, map.width);
      CopyTexel(map, from.row, from.column, row, c);
    }
  }
}

// Adjoint of the rows that FillBorder fills beyond the poles.
void FoldPoles(const UnetMap& map) {
  for (const int row : {-1, map.height}) {
    for (int c = 0; c < map.width; ++c) {
      const UnetTexelIndex to = UnetTexel(row, c, map.height, map.width);
      const float* from = map.At(row, c);
      float* sum = map.At(to.row, to.column);
      for (int k = 0; k < map.stride; ++k) sum[k] += from[k];
    }
  }
}

void ClearPoles(const UnetMap& map) {
  for (const int row : {-1, map.height}) {
    std::fill_n(map.At(row, -1), map.row_stride(), 0.0f);
  }
}

void FromPlanar(const float* planar, const UnetMap& map) {
  for (int c = 0; c < map.channels; ++c) {
    for (int row = 0; row < map.height; ++row) {
      float* to = map.At(row, 0) + c;
      for (int column = 0; column < map.width; ++column, to += map.stride) {
        *to = *planar++;
      }
    }
  }
}

void ToPlanar(const UnetMap& map, float* planar) {
  for (int c = 0; c < map.channels; ++c) {
    for (int row = 0; row < map.height; ++row) {
      const float* from = map.At(row, 0) + c;
      for (int column = 0; column < map.width; ++column, from += map.stride) {
        *planar++ = *from;
      }
    }
  }
}

// Appends the taps of one input for output row `row`.
void AddTaps(const UnetStep& step, const UnetMap& input, int row,
             const float* weights, int out_stride, std::vector<UnetTap>* taps) {
  const int before = step.before();
  for (int ky = 0; ky < step.size; ++ky) {
    for (int kx = 0; kx < step.size; ++kx) {
      taps->push_back({input.At(step.stride * row + ky - before, kx - before),
                       weights, input.channels, step.stride * input.stride});
      weights += static_cast<int64_t>(input.channels) * out_stride;
    }
  }
}

}  // namespace

UnetEngine::UnetEngine(const UnetPlan& plan, const std::vector<float>& noise,
                       int num_threads, const UnetKernels& kernels)
    : plan_(plan), kernels_(kernels), num_threads_(num_threads), id_(NextId()) {
  for (const UnetStep& step : plan_.steps) {
    Packing packing{};
    if (step.kind == UnetStep::kUpsampling) {
      packing_.push_back(packing);
      continue;
    }
    const int out = plan_.tensors[step.output].channels;
    const int taps = step.size * step.size;
    packing.bias = packed_size_;
    packed_size_ += PadUnetChannels(out);
    for (const int input : step.inputs) {
      const int in = plan_.tensors[input].channels;
      packing.weights.push_back(packed_size_);
      packed_size_ += static_cast<int64_t>(taps) * in * PadUnetChannels(out);
      packing.transposed.push_back(transposed_size_);
      transposed_size_ +=
          static_cast<int64_t>(taps) * out * PadUnetChannels(in);
      packing.gradient.push_back(gradient_size_);
      gradient_size_ += static_cast<int64_t>(taps) * PadUnetChannels(in) *
                        PadUnetChannels(out);
    }
    packing_.push_back(packing);
  }
  const UnetTensor& t = plan_.tensors[0];
  CHECK_EQ(static_cast<size_t>(t.channels) * t.height * t.width, noise.size());
  const int stride = PadUnetChannels(t.channels);
  noise_.resize(static_cast<size_t>(t.height + 2) * (t.width + 2) * stride);
  const UnetMap map{noise_.data(), t.channels, t.height, t.width, stride};
  FromPlanar(noise.data(), map);
  FillBorder(map);
}

UnetMap UnetEngine::MapOf(int tensor,
                          const std::vector<UnetBuffer>& maps) const {
  const UnetTensor& t = plan_.tensors[tensor];
  // The noise is shared and only read.
  const UnetBuffer& buffer = tensor == 0 ? noise_ : maps[tensor];
  return {const_cast<float*>(buffer.data()), t.channels, t.height, t.width,
          PadUnetChannels(t.channels)};
}

int UnetEngine::ThreadsFor(const UnetStep& step) const {
  const UnetTensor& out = plan_.tensors[step.output];
  const int64_t work = static_cast<int64_t>(out.height) * out.width *
                       out.channels * step.size * step.size *
                       plan_.InputChannels(step);
  return work < kParallelWork ? 1 : num_threads_;
}

void UnetEngine::Upsample(const UnetStep& step,
                          const std::vector<UnetBuffer>& maps) const {
  const UnetMap in = MapOf(step.inputs[0], maps);
  const UnetMap out = MapOf(step.output, maps);
  for (int row = 0; row < out.height; ++row) {
    const int near = row / 2;
    const int far = row % 2 == 0 ? near - 1 : near + 1;
    kernels_.upsample_row(in.At(near, 0), in.At(far, 0), in.stride, in.width,
                          out.At(row, 0));
  }
}

void UnetEngine::Forward(const float* weights, UnetBuffers* forward,
                         float* log_radiance) const {
  Size(forward);
  PackWeights(weights, &forward->weights);
  const float* packed = forward->weights.data();
  for (size_t s = 0; s < plan_.steps.size(); ++s) {
    const UnetStep& step = plan_.steps[s];
    const UnetMap out = MapOf(step.output, forward->maps);
    if (step.kind == UnetStep::kUpsampling) {
      Upsample(step, forward->maps);
      FillBorder(out);
      continue;
    }
    UnetBuffer& slopes = forward->slopes[s];
    const UnetMap slope{slopes.data(), out.channels, out.height, out.width,
                        out.stride};
    const UnetBuffer zero(out.stride, 0.0f);
    const float* start =
        step.normalize ? zero.data() : packed + packing_[s].bias;
    ParallelFor(out.height, ThreadsFor(step), [&](int64_t r, int) {
      const int row = static_cast<int>(r);
      std::vector<UnetTap> taps;
      taps.reserve(18);
      for (size_t k = 0; k < step.inputs.size(); ++k) {
        AddTaps(step, MapOf(step.inputs[k], forward->maps), row,
                packed + packing_[s].weights[k], out.stride, &taps);
      }
      kernels_.convolve_row(taps.data(), static_cast<int>(taps.size()),
                            out.stride, out.channels, start, out.At(row, 0),
                            out.stride, out.width);
    });
    if (step.normalize) {
      NormalizeAndActivate(static_cast<int>(s), forward);
    } else if (step.activate) {
      for (int row = 0; row < out.height; ++row) {
        kernels_.activate(out.At(row, 0), slope.At(row, 0),
                          static_cast<int64_t>(out.width) * out.stride);
      }
    }
    FillBorder(out);
  }
  ToPlanar(MapOf(plan_.steps.back().output, forward->maps), log_radiance);
}

void UnetEngine::Jvp(const float* tangent, const UnetBuffers& forward,
                     UnetBuffers* scratch, float* d_log_radiance) const {
  CHECK(forward.owner == id_) << "no Forward before";
  Size(scratch);
  PackWeights(tangent, &scratch->weights);
  const float* packed = forward.weights.data();
  const float* d_packed = scratch->weights.data();
  for (size_t s = 0; s < plan_.steps.size(); ++s) {
    const UnetStep& step = plan_.steps[s];
    const UnetMap out = MapOf(step.output, scratch->maps);
    if (step.kind == UnetStep::kUpsampling) {
      Upsample(step, scratch->maps);
      FillBorder(out);
      continue;
    }
    const UnetMap slope{const_cast<float*>(forward.slopes[s].data()),
                        out.channels, out.height, out.width, out.stride};
    const UnetBuffer zero(out.stride, 0.0f);
    const float* bias = d_packed + packing_[s].bias;
    const float* start = step.normalize ? zero.data() : bias;
    ParallelFor(out.height, ThreadsFor(step), [&](int64_t r, int) {
      const int row = static_cast<int>(r);
      std::vector<UnetTap> taps;
      taps.reserve(36);
      for (size_t k = 0; k < step.inputs.size(); ++k) {
        AddTaps(step, MapOf(step.inputs[k], forward.maps), row,
                d_packed + packing_[s].weights[k], out.stride, &taps);
        if (step.inputs[k] == 0) continue;  // the noise has no tangent
        AddTaps(step, MapOf(step.inputs[k], scratch->maps), row,
                packed + packing_[s].weights[k], out.stride, &taps);
      }
      kernels_.convolve_row(taps.data(), static_cast<int>(taps.size()),
                            out.stride, out.channels, start, out.At(row, 0),
                            out.stride, out.width);
    });
    if (step.normalize) {
      ApplyNormJacobian(static_cast<int>(s), forward, bias, out);
    }
    for (int row = 0; step.activate && row < out.height; ++row) {
      kernels_.multiply(out.At(row, 0), slope.At(row, 0),
                        static_cast<int64_t>(out.width) * out.stride);
    }
    FillBorder(out);
  }
  ToPlanar(MapOf(plan_.steps.back().output, scratch->maps), d_log_radiance);
}

// The adjoint of a convolution is a convolution of the output's adjoint: an
// input texel (row, column), rows beyond the poles included, gathers from the
// output texels that saw it, which for stride 2 depends on its parity.
void UnetEngine::PropagateToInput(
    int step_index, size_t input, bool overwrite, const UnetBuffer& transposed,
    const std::vector<UnetBuffer>& adjoints) const {
  const UnetStep& step = plan_.steps[step_index];
  const UnetMap in = MapOf(step.inputs[input], adjoints);
  const UnetMap out = MapOf(step.output, adjoints);
  const UnetBuffer zero(in.stride, 0.0f);
  const int before = step.before();
  const int64_t tap_size = static_cast<int64_t>(out.channels) * in.stride;
  const float* weights =
      transposed.data() + packing_[step_index].transposed[input];
  ParallelFor(
      in.height + 2 * before, ThreadsFor(step), [&](int64_t index, int) {
        const int row = static_cast<int>(index) - before;
        const bool beyond_pole = row < 0 || row >= in.height;
        const float* start = overwrite && !beyond_pole ? zero.data() : nullptr;
        std::vector<UnetTap> taps;
        for (int parity = 0; parity < step.stride; ++parity) {
          taps.clear();
          for (int ky = 0; ky < step.size; ++ky) {
            const int y = row - (ky - before);
            if (y < 0 || y % step.stride != 0 ||
                y / step.stride >= out.height) {
              continue;
            }
            for (int kx = 0; kx < step.size; ++kx) {
              const int x = parity - (kx - before);
              if (x % step.stride != 0) continue;
              taps.push_back({out.At(y / step.stride, x / step.stride),
                              weights + (ky * step.size + kx) * tap_size,
                              out.channels, out.stride});
            }
          }
          kernels_.convolve_row(taps.data(), static_cast<int>(taps.size()),
                                in.stride, in.channels, start,
                                in.At(row, parity), step.stride * in.stride,
                                in.width / step.stride);
        }
      });
}

void UnetEngine::AddWeightGradient(int step_index,
                                   const std::vector<UnetBuffer>& maps,
                                   const std::vector<UnetBuffer>& adjoints,
                                   UnetBuffer* gradient) const {
  const UnetStep& step = plan_.steps[step_index];
  const UnetMap out = MapOf(step.output, adjoints);
  const int before = step.before();
  const int taps = step.size * step.size;
  const int items = taps * static_cast<int>(step.inputs.size());
  const int band = std::max(1, kGradientTexels / out.width);
  // Every sum runs over the bands in order, whichever thread takes it.
  int threads = ThreadsFor(step);
  if (threads <= 0) threads = HardwareThreads();
  const int chunks = std::min(threads, items);
  ParallelFor(chunks, threads, [&](int64_t chunk, int) {
    for (int row = 0; row < out.height; row += band) {
      const int rows = std::min(band, out.height - row);
      for (int item = static_cast<int>(chunk); item < items; item += chunks) {
        const int tap = item % taps;
        const size_t k = item / taps;
        const UnetMap in = MapOf(step.inputs[k], maps);
        const int64_t tap_size = static_cast<int64_t>(in.stride) * out.stride;
        kernels_.weight_gradient(
            in.At(step.stride * row + tap / step.size - before,
                  tap % step.size - before),
            step.stride * in.row_stride(), step.stride * in.stride,
            out.At(row, 0), out.row_stride(), out.stride, rows, out.width,
            in.channels, out.channels,
            gradient->data() + packing_[step_index].gradient[k] +
                tap * tap_size,
            out.stride);
      }
    }
  });
}

void UnetEngine::Vjp(const float* adjoint, const UnetBuffers& forward,
                     UnetBuffers* scratch, float* weight_gradient) const {
  CHECK(forward.owner == id_) << "no Forward before";
  Size(scratch);
  PackTransposed(forward.weights, &scratch->transposed);
  std::fill(scratch->gradient.begin(), scratch->gradient.end(), 0.0f);
  for (size_t i = 1; i < plan_.tensors.size(); ++i) {
    ClearPoles(MapOf(static_cast<int>(i), scratch->maps));
  }
  std::vector<bool> written(plan_.tensors.size(), false);
  FromPlanar(adjoint, MapOf(plan_.steps.back().output, scratch->maps));
  for (int s = static_cast<int>(plan_.steps.size()) - 1; s >= 0; --s) {
    const UnetStep& step = plan_.steps[s];
    const UnetMap out = MapOf(step.output, scratch->maps);
    FoldPoles(out);
    if (step.kind == UnetStep::kUpsampling) {
      // Its weights are symmetric: the adjoint continues as the map does.
      FillBorder(out);
      const UnetMap in = MapOf(step.inputs[0], scratch->maps);
      CHECK(!written[step.inputs[0]]) << "a coarse map has one reader";
      for (int row = 0; row < in.height; ++row) {
        const float* const fine[4] = {
            out.At(2 * row - 1, 0), out.At(2 * row, 0), out.At(2 * row + 1, 0),
            out.At(2 * row + 2, 0)};
        kernels_.upsample_adjoint_row(fine, in.stride, in.width, in.At(row, 0));
      }
      written[step.inputs[0]] = true;
      continue;
    }
    const UnetMap slope{const_cast<float*>(forward.slopes[s].data()),
                        out.channels, out.height, out.width, out.stride};
    UnetBuffer bias(out.stride, 0.0f);
    for (int row = 0; row < out.height; ++row) {
      if (step.activate) {
        kernels_.multiply(out.At(row, 0), slope.At(row, 0),
                          static_cast<int64_t>(out.width) * out.stride);
      }
      kernels_.add_texels(out.At(row, 0), out.stride, out.width, out.channels,
                          bias.data());
    }
    std::copy_n(bias.data(), out.channels, weight_gradient + step.bias_offset);
    if (step.normalize) {
      const UnetBuffer zero(out.stride, 0.0f);
      ApplyNormJacobian(s, forward, zero.data(), out);
    }
    WrapColumns(out);
    AddWeightGradient(s, forward.maps, scratch->maps, &scratch->gradient);
    for (size_t k = 0; k < step.inputs.size(); ++k) {
      const int input = step.inputs[k];
      if (input == 0) continue;  // the noise is fixed
      PropagateToInput(s, k, !written[input], scratch->transposed,
                       scratch->maps);
      written[input] = true;
    }
  }
  UnpackGradient(scratch->gradient, weight_gradient);
}

}  // namespace ibrdf

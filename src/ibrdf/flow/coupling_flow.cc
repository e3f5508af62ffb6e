#include "ibrdf/flow/coupling_flow.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/base/parallel_for.h"

namespace ibrdf {
namespace {

constexpr int kP = kFlowBlock;
// The start's last layer, relative to He scaling: near the identity, yet with
// enough signal for the hidden layers' first gradients.
constexpr float kLastLayerScale = 0.1f;

// Copies points [begin, begin + n) of a [rows][count] array into [rows][64],
// repeating the last one to fill the block.
void Gather(const float* from, int rows, int64_t count, int64_t begin, int n,
            float* to) {
  for (int r = 0; r < rows; ++r) {
    for (int p = 0; p < kP; ++p) {
      to[r * kP + p] = from[r * count + begin + std::min(p, n - 1)];
    }
  }
}

void Scatter(const float* from, int rows, int64_t count, int64_t begin, int n,
             float* to) {
  for (int r = 0; r < rows; ++r) {
    std::copy(from + r * kP, from + r * kP + n, to + r * count + begin);
  }
}

int64_t NumBlocks(int64_t count) { return (count + kP - 1) / kP; }

}  // namespace

const FlowKernels& GetFlowKernels(SimdLevel level) {
#if defined(IBRDF_HAVE_X86_KERNELS)
  if (level == SimdLevel::kAvx512) return avx512::kFlowKernels;
  if (level == SimdLevel::kAvx2) return avx2::kFlowKernels;
#endif
  (void)level;
  return portable::kFlowKernels;
}

std::vector<float> InitialFlowWeights(const FlowShape& shape, uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<float> normal;
  std::vector<float> weights(shape.NumWeights(), 0.0f);
  const std::vector<DenseLayer> dense = shape.DenseLayers();
  for (int l = 0; l < shape.layers; ++l) {
    float* w = weights.data() + l * shape.WeightsPerLayer();
    for (size_t i = 0; i < dense.size(); ++i) {
      const DenseLayer& d = dense[i];
      float scale = std::sqrt(2.0f / static_cast<float>(d.in_count));
      if (i == 0) scale = 1.0f;
      if (i + 1 == dense.size()) scale *= kLastLayerScale;
      for (int k = 0; k < d.in_count * d.out_count; ++k) {
        w[d.weight_offset + k] = scale * normal(rng);
      }
      if (i == 0) {
        for (int o = 0; o < d.out_count; ++o) {
          w[d.bias_offset + o] = normal(rng);
        }
        for (int k = 0; k < d.out_count * shape.code_size; ++k) {
          w[shape.CodeWeightOffset() + k] = normal(rng);
        }
      }
    }
  }
  return weights;
}

CouplingFlow::CouplingFlow(const FlowShape& shape,
                           const std::vector<float>& weights, SimdLevel level)
    : shape_(shape), kernels_(&GetFlowKernels(level)) {
  CHECK(shape.Validate().empty()) << shape.Validate();
  for (const DenseLayer& d : shape.DenseLayers()) {
    dense_.push_back({d.in, d.in_count, d.out, d.out_count, d.activation,
                      d.weight_offset, d.bias_offset, padded_per_layer_});
    padded_per_layer_ +=
        static_cast<size_t>(d.out_count) * PaddedCount(d.in_count);
  }
  SetWeights(weights);
}

void CouplingFlow::SetWeights(const std::vector<float>& weights) {
  CHECK_EQ(shape_.NumWeights(), weights.size());
  weights_ = weights;
}

FlowView CouplingFlow::View(const float* first_bias) const {
  FlowView v;
  v.layers = shape_.layers;
  v.bins = shape_.bins;
  v.code_size = shape_.code_size;
  v.rows = shape_.ActivationRows();
  v.output_row = shape_.OutputRow();
  v.num_dense = static_cast<int>(dense_.size());
  v.dense = dense_.data();
  v.weights = weights_.data();
  v.weights_per_layer = shape_.WeightsPerLayer();
  v.code_offset = shape_.CodeWeightOffset();
  v.padded_per_layer = padded_per_layer_;
  v.first_bias = first_bias;
  return v;
}

// The code enters the first dense layer alone: a bias per code.
std::vector<float> CouplingFlow::FirstBias(const float* code) const {
  const int w0 = shape_.widths[0];
  std::vector<float> bias(static_cast<size_t>(shape_.layers) * w0);
  for (int l = 0; l < shape_.layers; ++l) {
    const float* w = weights_.data() + l * shape_.WeightsPerLayer();
    for (int o = 0; o < w0; ++o) {
      float sum = w[dense_[0].bias_offset + o];
      const float* wz = w + shape_.CodeWeightOffset() +
                        static_cast<size_t>(o) * shape_.code_size;
      for (int k = 0; k < shape_.code_size; ++k) sum += wz[k] * code[k];
      bias[static_cast<size_t>(l) * w0 + o] = sum;
    }
  }
  return bias;
}

void CouplingFlow::LogDensity(const float* x, int64_t count, const float* code,
                              int num_threads, float* log_density,
                              float* latent) const {
  const std::vector<float> bias = FirstBias(code);
  const FlowView v = View(bias.data());
  if (num_threads <= 0) num_threads = HardwareThreads();
  std::vector<std::vector<float>> tapes(num_threads);
  ParallelFor(NumBlocks(count), num_threads, [&](int64_t block, int worker) {
    tapes[worker].resize(FlowTapeFloats(v));
    const int64_t begin = block * kP;
    const int n = static_cast<int>(std::min<int64_t>(kP, count - begin));
    float points[3 * kP], u[3 * kP], value[kP];
    Gather(x, 3, count, begin, n, points);
    kernels_->forward(v, points, tapes[worker].data(), u, value);
    Scatter(value, 1, count, begin, n, log_density);
    if (latent != nullptr) Scatter(u, 3, count, begin, n, latent);
  });
}

void CouplingFlow::LogDensityWithGradient(const float* x, int64_t count,
                                          const float* code, int num_threads,
                                          float* log_density, float* dcode,
                                          float* dx) const {
  const std::vector<float> bias = FirstBias(code);
  const FlowView v = View(bias.data());
  if (num_threads <= 0) num_threads = HardwareThreads();
  struct Worker {
    std::vector<float> tape, scratch, dcode;
  };
  std::vector<Worker> workers(num_threads);
  ParallelFor(NumBlocks(count), num_threads, [&](int64_t block, int worker) {
    Worker& w = workers[worker];
    w.tape.resize(FlowTapeFloats(v));
    w.scratch.resize(FlowScratchFloats(v.rows));
    w.dcode.resize(static_cast<size_t>(v.code_size) * kP);
    const int64_t begin = block * kP;
    const int n = static_cast<int>(std::min<int64_t>(kP, count - begin));
    float points[3 * kP], u[3 * kP], value[kP], gx[3 * kP], ones[kP];
    std::fill(ones, ones + kP, 1.0f);
    Gather(x, 3, count, begin, n, points);
    kernels_->forward(v, points, w.tape.data(), u, value);
    kernels_->backward(v, w.tape.data(), ones, w.scratch.data(), nullptr,
                       nullptr, dcode != nullptr ? w.dcode.data() : nullptr,
                       dx != nullptr ? gx : nullptr);
    Scatter(value, 1, count, begin, n, log_density);
    if (dcode != nullptr) {
      Scatter(w.dcode.data(), v.code_size, count, begin, n, dcode);
    }
    if (dx != nullptr) Scatter(gx, 3, count, begin, n, dx);
  });
}

void CouplingFlow::Inverse(const float* latent, int64_t count,
                           const float* code, int num_threads, float* x,
                           float* log_density) const {
  const std::vector<float> bias = FirstBias(code);
  const FlowView v = View(bias.data());
  if (num_threads <= 0) num_threads = HardwareThreads();
  std::vector<std::vector<float>> scratch(num_threads);
  ParallelFor(NumBlocks(count), num_threads, [&](int64_t block, int worker) {
    scratch[worker].resize(static_cast<size_t>(v.rows) * kP);
    const int64_t begin = block * kP;
    const int n = static_cast<int>(std::min<int64_t>(kP, count - begin));
    float u[3 * kP], points[3 * kP], value[kP];
    Gather(latent, 3, count, begin, n, u);
    kernels_->inverse(v, u, scratch[worker].data(), points, value);
    Scatter(points, 3, count, begin, n, x);
    if (log_density != nullptr) {
      Scatter(value, 1, count, begin, n, log_density);
    }
  });
}

CouplingFlow::TrainingPass::TrainingPass(const CouplingFlow& flow)
    : flow_(flow), latent_(3 * kP) {
  const FlowView v = flow.View(nullptr);
  tape_.resize(FlowTapeFloats(v));
  scratch_.resize(FlowScratchFloats(v.rows));
  bias_.resize(static_cast<size_t>(v.layers) * v.rows);
}

void CouplingFlow::TrainingPass::Forward(const float* x, const float* code,
                                         float* log_density) {
  code_.assign(code, code + flow_.shape_.code_size);
  first_bias_ = flow_.FirstBias(code);
  flow_.kernels_->forward(flow_.View(first_bias_.data()), x, tape_.data(),
                          latent_.data(), log_density);
}

size_t CouplingFlow::PaddedGradientSize() const {
  // Weights, then biases as activation rows, then the code's weights.
  return shape_.layers *
         (padded_per_layer_ + shape_.ActivationRows() +
          static_cast<size_t>(shape_.widths[0]) * shape_.code_size);
}

void CouplingFlow::TrainingPass::Backward(const float* adjoint, float* gradient,
                                          float* code_gradient) {
  const FlowShape& shape = flow_.shape_;
  const FlowView v = flow_.View(first_bias_.data());
  std::fill(bias_.begin(), bias_.end(), 0.0f);
  flow_.kernels_->backward(v, tape_.data(), adjoint, scratch_.data(), gradient,
                           bias_.data(), nullptr, nullptr);
  float* biases = gradient + v.layers * v.padded_per_layer;
  float* codes = biases + bias_.size();
  for (size_t i = 0; i < bias_.size(); ++i) biases[i] += bias_[i];
  const FlowDense& first = flow_.dense_[0];
  for (int l = 0; l < shape.layers; ++l) {
    const float* w = flow_.weights_.data() + l * shape.WeightsPerLayer() +
                     shape.CodeWeightOffset();
    for (int o = 0; o < first.out_count; ++o) {
      const float g = bias_[static_cast<size_t>(l) * v.rows + first.out + o];
      const size_t row = static_cast<size_t>(o) * shape.code_size;
      float* gw = codes +
                  l * static_cast<size_t>(first.out_count) * shape.code_size +
                  row;
      for (int k = 0; k < shape.code_size; ++k) {
        gw[k] += g * code_[k];
        code_gradient[k] += g * w[row + k];
      }
    }
  }
}

void CouplingFlow::UnpadGradient(const float* padded, float* gradient) const {
  const int rows = shape_.ActivationRows();
  const float* biases = padded + shape_.layers * padded_per_layer_;
  const float* codes = biases + static_cast<size_t>(shape_.layers) * rows;
  const size_t code_part =
      static_cast<size_t>(shape_.widths[0]) * shape_.code_size;
  for (int l = 0; l < shape_.layers; ++l) {
    float* g = gradient + l * shape_.WeightsPerLayer();
    const float* pg = padded + l * padded_per_layer_;
    for (const FlowDense& d : dense_) {
      for (int o = 0; o < d.out_count; ++o) {
        for (int k = 0; k < d.in_count; ++k) {
          g[d.weight_offset + static_cast<size_t>(o) * d.in_count + k] +=
              pg[d.padded_offset +
                 static_cast<size_t>(o) * PaddedCount(d.in_count) + k];
        }
        g[d.bias_offset + o] +=
            biases[static_cast<size_t>(l) * rows + d.out + o];
      }
    }
    for (size_t k = 0; k < code_part; ++k) {
      g[shape_.CodeWeightOffset() + k] += codes[l * code_part + k];
    }
  }
}

}  // namespace ibrdf

#include "ibrdf/flow/coupling_flow.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/base/parallel_for.h"

namespace ibrdf {
namespace {

constexpr int kP = kCouplingBlock;

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

template <typename T>
void Scatter(const float* from, int rows, int64_t count, int64_t begin, int n,
             T* to) {
  for (int r = 0; r < rows; ++r) {
    std::copy(from + r * kP, from + r * kP + n, to + r * count + begin);
  }
}

int64_t NumPointBlocks(int64_t count) { return (count + kP - 1) / kP; }

}  // namespace

const CouplingKernels& GetCouplingKernels(SimdLevel level) {
#if defined(IBRDF_HAVE_X86_KERNELS)
  if (level == SimdLevel::kAvx512) return avx512::kCouplingKernels;
  if (level == SimdLevel::kAvx2) return avx2::kCouplingKernels;
#endif
  (void)level;
  return portable::kCouplingKernels;
}

std::vector<float> InitialCouplingWeights(const CouplingShape& shape,
                                          uint64_t seed) {
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

CouplingFlow::CouplingFlow(const CouplingShape& shape,
                           const std::vector<float>& weights, SimdLevel level)
    : shape_(shape), kernels_(&GetCouplingKernels(level)) {
  CHECK(shape.Validate().empty()) << shape.Validate();
  dense_ = shape.DenseLayers();
  padded_per_layer_ = dense_.back().padded_offset +
                      static_cast<size_t>(dense_.back().out_count) *
                          PaddedCount(dense_.back().in_count);
  SetWeights(weights);
}

void CouplingFlow::SetWeights(const std::vector<float>& weights) {
  CHECK_EQ(shape_.NumWeights(), weights.size());
  weights_ = weights;
}

CouplingView CouplingFlow::View(const float* first_bias) const {
  CouplingView v;
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
                              int num_threads, float* log_density, float* dcode,
                              float* dx) const {
  const std::vector<float> bias = FirstBias(code);
  const CouplingView v = View(bias.data());
  if (num_threads <= 0) num_threads = HardwareThreads();
  struct Worker {
    std::vector<float> tape, scratch, dcode;
  };
  std::vector<Worker> workers(num_threads);
  ParallelFor(
      NumPointBlocks(count), num_threads, [&](int64_t block, int worker) {
        Worker& w = workers[worker];
        w.tape.resize(CouplingTapeFloats(v));
        const int64_t begin = block * kP;
        const int n = static_cast<int>(std::min<int64_t>(kP, count - begin));
        float points[3 * kP], u[3 * kP], value[kP], gx[3 * kP], ones[kP];
        Gather(x, 3, count, begin, n, points);
        kernels_->forward(v, points, w.tape.data(), u, value);
        Scatter(value, 1, count, begin, n, log_density);
        if (dcode == nullptr && dx == nullptr) return;
        w.scratch.resize(CouplingScratchFloats(v.rows));
        w.dcode.resize(static_cast<size_t>(v.code_size) * kP);
        std::fill(ones, ones + kP, 1.0f);
        kernels_->backward(v, w.tape.data(), ones, w.scratch.data(), nullptr,
                           nullptr, dcode != nullptr ? w.dcode.data() : nullptr,
                           dx != nullptr ? gx : nullptr);
        if (dcode != nullptr) {
          Scatter(w.dcode.data(), v.code_size, count, begin, n, dcode);
        }
        if (dx != nullptr) Scatter(gx, 3, count, begin, n, dx);
      });
}

void CouplingFlow::LogDensityOnColumns(const FlowColumns& x, const float* code,
                                       int num_threads, float* log_density,
                                       float* dcode) const {
  const int64_t count = x.num_points();
  std::vector<float> points(x.x_h);
  points.resize(3 * count);
  for (int i = 0; i < x.points; ++i) {
    const int64_t at = static_cast<int64_t>(i) * x.columns;
    std::copy(x.x_d.begin(), x.x_d.end(), points.begin() + count + at);
    std::copy(x.x_p.begin(), x.x_p.end(), points.begin() + 2 * count + at);
  }
  LogDensity(points.data(), count, code, num_threads, log_density, dcode,
             nullptr);
}

void CouplingFlow::Latent(const double* x, int64_t count, const float* code,
                          int num_threads, double* latent) const {
  const std::vector<float> bias = FirstBias(code);
  const CouplingView v = View(bias.data());
  const std::vector<float> from(x, x + 3 * count);
  ParallelFor(NumPointBlocks(count), num_threads, [&](int64_t block, int) {
    std::vector<float> tape(CouplingTapeFloats(v));
    const int64_t begin = block * kP;
    const int n = static_cast<int>(std::min<int64_t>(kP, count - begin));
    float points[3 * kP], u[3 * kP], value[kP];
    Gather(from.data(), 3, count, begin, n, points);
    kernels_->forward(v, points, tape.data(), u, value);
    Scatter(u, 3, count, begin, n, latent);
  });
}

void CouplingFlow::Inverse(const double* latent, int64_t count,
                           const float* code, int num_threads,
                           double* x) const {
  const std::vector<float> bias = FirstBias(code);
  const CouplingView v = View(bias.data());
  const std::vector<float> from(latent, latent + 3 * count);
  ParallelFor(NumPointBlocks(count), num_threads, [&](int64_t block, int) {
    std::vector<float> scratch(static_cast<size_t>(v.rows) * kP);
    const int64_t begin = block * kP;
    const int n = static_cast<int>(std::min<int64_t>(kP, count - begin));
    float u[3 * kP], points[3 * kP], value[kP];
    Gather(from.data(), 3, count, begin, n, u);
    kernels_->inverse(v, u, scratch.data(), points, value);
    Scatter(points, 3, count, begin, n, x);
  });
}

class CouplingFlow::Pass final : public BrdfFlow::TrainingPass {
 public:
  explicit Pass(const CouplingFlow& flow)
      : flow_(flow),
        scratch_(CouplingScratchFloats(flow.View(nullptr).rows)),
        bias_(static_cast<size_t>(flow.shape_.layers) *
              flow.View(nullptr).rows) {}

  void Forward(const FlowColumns& x, int num_codes, const float* codes,
               float* log_density) override {
    const int size = flow_.shape_.code_size;
    columns_ = x.columns;
    per_code_ = x.columns / num_codes;
    num_codes_ = num_codes;
    points_ = x.points;
    CHECK_EQ(0, per_code_ * points_ % kP);
    codes_.assign(codes, codes + static_cast<size_t>(num_codes) * size);
    const int blocks = per_code_ * points_ / kP;
    tapes_.resize(static_cast<size_t>(num_codes) * blocks);
    for (int c = 0; c < num_codes; ++c) {
      const std::vector<float> first_bias = flow_.FirstBias(codes + c * size);
      const CouplingView v = flow_.View(first_bias.data());
      for (int b = 0; b < blocks; ++b) {
        float point[3 * kP], u[3 * kP], value[kP];
        for (int p = 0; p < kP; ++p) {
          const size_t at = At(c, b * kP + p);
          const size_t column = at % x.columns;
          point[p] = x.x_h[at];
          point[kP + p] = x.x_d[column];
          point[2 * kP + p] = x.x_p[column];
        }
        std::vector<float>& tape = tapes_[c * blocks + b];
        tape.resize(CouplingTapeFloats(v));
        flow_.kernels_->forward(v, point, tape.data(), u, value);
        for (int p = 0; p < kP; ++p) log_density[At(c, b * kP + p)] = value[p];
      }
    }
  }

  void Backward(const float* adjoint, float* gradient,
                float* code_gradient) override {
    const CouplingShape& shape = flow_.shape_;
    const int blocks = per_code_ * points_ / kP, size = shape.code_size;
    for (int c = 0; c < num_codes_; ++c) {
      const float* code = codes_.data() + static_cast<size_t>(c) * size;
      const std::vector<float> first_bias = flow_.FirstBias(code);
      const CouplingView v = flow_.View(first_bias.data());
      std::fill(bias_.begin(), bias_.end(), 0.0f);
      for (int b = 0; b < blocks; ++b) {
        float g[kP];
        for (int p = 0; p < kP; ++p) g[p] = adjoint[At(c, b * kP + p)];
        flow_.kernels_->backward(v, tapes_[c * blocks + b].data(), g,
                                 scratch_.data(), gradient, bias_.data(),
                                 nullptr, nullptr);
      }
      AddCodeGradient(v, code, gradient, code_gradient + c * size);
    }
  }

 private:
  // Index [points][columns] of the k-th point of a code.
  size_t At(int code, int k) const {
    return static_cast<size_t>(k / per_code_) * columns_ +
           static_cast<size_t>(code) * per_code_ + k % per_code_;
  }

  // The code's weights see the sums of the biases' gradients.
  void AddCodeGradient(const CouplingView& v, const float* code,
                       float* gradient, float* code_gradient) const {
    const CouplingShape& shape = flow_.shape_;
    float* biases = gradient + v.layers * v.padded_per_layer;
    float* codes = biases + bias_.size();
    for (size_t i = 0; i < bias_.size(); ++i) biases[i] += bias_[i];
    const DenseLayer& first = flow_.dense_[0];
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
          gw[k] += g * code[k];
          code_gradient[k] += g * w[row + k];
        }
      }
    }
  }

  const CouplingFlow& flow_;
  int columns_ = 0, per_code_ = 1, num_codes_ = 0, points_ = 0;
  std::vector<std::vector<float>> tapes_;
  std::vector<float> codes_, scratch_, bias_;
};

std::unique_ptr<BrdfFlow::TrainingPass> CouplingFlow::NewTrainingPass() const {
  return std::make_unique<Pass>(*this);
}

size_t CouplingFlow::GradientSize() const {
  // Weights, then biases as activation rows, then the code's weights.
  return shape_.layers *
         (padded_per_layer_ + shape_.ActivationRows() +
          static_cast<size_t>(shape_.widths[0]) * shape_.code_size);
}

void CouplingFlow::AddGradient(const float* padded, float* gradient) const {
  const int rows = shape_.ActivationRows();
  const float* biases = padded + shape_.layers * padded_per_layer_;
  const float* codes = biases + static_cast<size_t>(shape_.layers) * rows;
  const size_t code_part =
      static_cast<size_t>(shape_.widths[0]) * shape_.code_size;
  for (int l = 0; l < shape_.layers; ++l) {
    float* g = gradient + l * shape_.WeightsPerLayer();
    const float* pg = padded + l * padded_per_layer_;
    for (const DenseLayer& d : dense_) {
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

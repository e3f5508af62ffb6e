#include "ibrdf/flow/triangular_flow.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/flow/log_linear_spline.h"

namespace ibrdf {
namespace {

constexpr int kB = kColumnBlock;

int64_t NumColumnBlocks(int64_t count) { return (count + kB - 1) / kB; }

// [begin, begin + n) of an array into a block, the last one repeated.
template <typename T>
void Gather(const T* from, int64_t begin, int n, float* to) {
  for (int i = 0; i < kB; ++i) {
    to[i] = static_cast<float>(from[begin + std::min(i, n - 1)]);
  }
}

// Size of one conditioner's part of a gradient buffer: weights, biases as
// activation rows, the code's weights.
size_t PartSize(const ConditionerShape& c, int code_size) {
  return c.padded_weights + c.rows +
         static_cast<size_t>(c.dense[0].out_count) * PaddedCount(code_size);
}

}  // namespace

const TriangularKernels& GetTriangularKernels(SimdLevel level) {
#if defined(IBRDF_HAVE_X86_KERNELS)
  if (level == SimdLevel::kAvx512) return avx512::kTriangularKernels;
  if (level == SimdLevel::kAvx2) return avx2::kTriangularKernels;
#endif
  (void)level;
  return portable::kTriangularKernels;
}

std::vector<float> InitialTriangularWeights(const TriangularShape& shape,
                                            uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<float> normal;
  std::vector<float> weights(shape.NumWeights(), 0.0f);
  float* w = weights.data();
  for (const ConditionerShape& c : shape.Conditioners()) {
    for (size_t i = 0; i < c.dense.size(); ++i) {
      const DenseLayer& d = c.dense[i];
      const int inputs = d.in_count + (i == 0 ? shape.code_size : 0);
      float scale = std::sqrt(2.0f / static_cast<float>(inputs));
      if (i + 1 == c.dense.size()) scale *= kLastLayerScale;
      for (int k = 0; k < d.in_count * d.out_count; ++k) {
        w[d.weight_offset + k] = scale * normal(rng);
      }
      if (i == 0) {
        for (int k = 0; k < d.out_count * shape.code_size; ++k) {
          w[c.code_offset + k] = scale * normal(rng);
        }
      }
    }
    w += c.num_weights;
  }
  return weights;
}

// The code enters the first layer of each conditioner alone: a bias per code.
struct TriangularFlow::CodeViews {
  std::array<std::vector<float>, 3> bias;
  std::array<ConditionerView, 3> view;
};

struct TriangularFlow::Block {
  std::array<std::vector<float>, 3> rows, grows;
  std::vector<float> scratch, pieces, dcode;

  explicit Block(const std::array<ConditionerShape, 3>& conditioners) {
    for (int i = 0; i < 3; ++i) {
      rows[i].resize(static_cast<size_t>(conditioners[i].rows) * kB);
    }
  }
  // features: [kColumnFeatures][kB].
  void SetFeatures(const float* features) {
    for (int dim = 0; dim < 2; ++dim) {
      const float* from = features + kFirstFeature[dim] * kB;
      std::copy(from, from + kNumFeatures[dim] * kB, rows[dim].data());
    }
  }
  void SetFeatures(const FlowColumns& x, int64_t begin, int n) {
    float features[kColumnFeatures * kB];
    for (int i = 0; i < kColumnFeatures; ++i) {
      Gather(x.features.data() + static_cast<size_t>(i) * x.columns, begin, n,
             features + i * kB);
    }
    SetFeatures(features);
  }
};

TriangularFlow::TriangularFlow(const TriangularShape& shape,
                               const std::vector<float>& weights,
                               SimdLevel level)
    : shape_(shape), kernels_(&GetTriangularKernels(level)) {
  CHECK(shape.Validate().empty()) << shape.Validate();
  conditioners_ = shape.Conditioners();
  size_t weights_end = 0, gradient_end = 0;
  for (int i = 0; i < 3; ++i) {
    weights_begin_[i] = weights_end;
    gradient_begin_[i] = gradient_end;
    weights_end += conditioners_[i].num_weights;
    gradient_end += PartSize(conditioners_[i], shape.code_size);
  }
  SetWeights(weights);
}

void TriangularFlow::SetWeights(const std::vector<float>& weights) {
  CHECK_EQ(shape_.NumWeights(), weights.size());
  weights_ = weights;
}

ConditionerView TriangularFlow::View(int dim) const {
  const ConditionerShape& c = conditioners_[dim];
  ConditionerView v;
  v.bins = c.bins;
  v.heights = c.NumHeights();
  v.rows = c.rows;
  v.output_row = c.output_row;
  v.num_dense = static_cast<int>(c.dense.size());
  v.code_size = shape_.code_size;
  v.dense = c.dense.data();
  v.weights = weights_.data() + weights_begin_[dim];
  v.code_offset = c.code_offset;
  v.first_bias = nullptr;
  v.codes = nullptr;
  return v;
}

TriangularFlow::CodeViews TriangularFlow::Views(const float* code) const {
  CodeViews views;
  for (int dim = 0; dim < 3; ++dim) {
    const ConditionerShape& c = conditioners_[dim];
    ConditionerView& v = views.view[dim];
    v = View(dim);
    std::vector<float>& bias = views.bias[dim];
    bias.resize(c.dense[0].out_count);
    for (size_t o = 0; o < bias.size(); ++o) {
      float sum = v.weights[c.dense[0].bias_offset + o];
      const float* wz = v.weights + c.code_offset + o * shape_.code_size;
      for (int k = 0; k < shape_.code_size; ++k) sum += wz[k] * code[k];
      bias[o] = sum;
    }
    v.first_bias = bias.data();
  }
  return views;
}

template <typename Body>
void TriangularFlow::ForBlocks(int64_t count, int num_threads,
                               const Body& body) const {
  if (num_threads <= 0) num_threads = HardwareThreads();
  std::vector<Block> blocks(num_threads, Block(conditioners_));
  ParallelFor(
      NumColumnBlocks(count), num_threads, [&](int64_t index, int worker) {
        const int64_t begin = index * kB;
        body(begin, static_cast<int>(std::min<int64_t>(kB, count - begin)),
             &blocks[worker]);
      });
}

// A block of points, each with what its column's features depend on.
struct TriangularFlow::PointBlock {
  float points[3][kB];
  double by_d[kB][kColumnFeatures], by_p[kB][kColumnFeatures];

  // Also sets the block's features.
  PointBlock(const float* x, int64_t count, int64_t begin, int n,
             Block* block) {
    for (int i = 0; i < 3; ++i) Gather(x + i * count, begin, n, points[i]);
    float features[kColumnFeatures * kB];
    for (int i = 0; i < kB; ++i) {
      double f[kColumnFeatures];
      ColumnFeatures<double>(points[1][i], points[2][i], f, by_d[i], by_p[i]);
      for (int k = 0; k < kColumnFeatures; ++k) {
        features[k * kB + i] = static_cast<float>(f[k]);
      }
    }
    block->SetFeatures(features);
  }
};

void TriangularFlow::LogDensity(const float* x, int64_t count,
                                const float* code, int num_threads,
                                float* log_density, float* dcode,
                                float* dx) const {
  const CodeViews views = Views(code);
  ForBlocks(count, num_threads, [&](int64_t begin, int n, Block* block) {
    Block& b = *block;
    const PointBlock at(x, count, begin, n, &b);
    float value[kB] = {};
    for (int dim = 2; dim >= 0; --dim) {
      float* rows = b.rows[dim].data();
      kernels_->condition(views.view[dim], rows);
      kernels_->evaluate(views.view[dim], rows, at.points[dim], 1, value,
                         value);
    }
    std::copy(value, value + n, log_density + begin);
    if (dcode == nullptr && dx == nullptr) return;
    float gx[3][kB] = {};
    BlockGradient(views, at, &b, gx);
    for (int i = 0; i < 3 && dx != nullptr; ++i) {
      std::copy(gx[i], gx[i] + n, dx + i * count + begin);
    }
    for (int k = 0; k < shape_.code_size && dcode != nullptr; ++k) {
      std::copy(b.dcode.data() + k * kB, b.dcode.data() + k * kB + n,
                dcode + k * count + begin);
    }
  });
}

void TriangularFlow::BlockGradient(const CodeViews& views, const PointBlock& at,
                                   Block* block, float gx[3][kB]) const {
  Block& b = *block;
  float ones[kB], dspline[kB];
  std::fill(ones, ones + kB, 1.0f);
  b.dcode.assign(static_cast<size_t>(shape_.code_size) * kB, 0.0f);
  for (int dim = 0; dim < 3; ++dim) {
    const ConditionerView& v = views.view[dim];
    b.grows[dim].assign(b.rows[dim].size(), 0.0f);
    float* grows = b.grows[dim].data();
    kernels_->adjoint(v, b.rows[dim].data(), at.points[dim], 1, ones, grows,
                      dspline);
    kernels_->backward(v, b.rows[dim].data(), grows, nullptr, nullptr, nullptr,
                       nullptr, b.dcode.data(), true);
    for (int i = 0; i < kB; ++i) {
      double sum_d = 0.0, sum_p = 0.0;
      for (int k = 0; k < kNumFeatures[dim]; ++k) {
        sum_d += grows[k * kB + i] * at.by_d[i][kFirstFeature[dim] + k];
        sum_p += grows[k * kB + i] * at.by_p[i][kFirstFeature[dim] + k];
      }
      gx[dim][i] += dspline[i];
      gx[1][i] += static_cast<float>(sum_d);
      gx[2][i] += static_cast<float>(sum_p);
    }
  }
}

// What all columns share, for they have the same x_p conditioner.
struct TriangularFlow::ColumnPass {
  const CodeViews& views;
  std::vector<float> last;         // activation rows of x_p's spline
  std::vector<float> last_pieces;  // their code pieces
  size_t pieces_size = 0, scratch_size = 0;
};

void TriangularFlow::LogDensityOnColumns(const FlowColumns& x,
                                         const float* code, int num_threads,
                                         float* log_density,
                                         float* dcode) const {
  const CodeViews views = Views(code);
  const ColumnPass pass = PrepareColumns(views, dcode != nullptr);
  ForBlocks(x.columns, num_threads, [&](int64_t begin, int n, Block* block) {
    const std::vector<float> x_h =
        EvaluateColumns(pass, x, begin, n, block, log_density);
    if (dcode != nullptr) {
      ColumnGradient(pass, x, begin, n, x_h, block, dcode);
    }
  });
}

TriangularFlow::ColumnPass TriangularFlow::PrepareColumns(
    const CodeViews& views, bool gradient) const {
  int widest = 0, most_bins = 0;
  for (const ConditionerShape& c : conditioners_) {
    most_bins = std::max(most_bins, c.bins);
    for (const DenseLayer& d : c.dense) widest = std::max(widest, d.out_count);
  }
  const auto codes = static_cast<size_t>(shape_.code_size);
  ColumnPass pass = {
      views, {}, {}, 2 * most_bins * codes * kB, 2 * codes * kB * widest};
  // x_p's spline is the same for all columns.
  Block block(conditioners_);
  kernels_->condition(views.view[2], block.rows[2].data());
  pass.last = block.rows[2];
  if (gradient) {
    pass.last_pieces.resize(pass.pieces_size);
    block.scratch.resize(pass.scratch_size);
    kernels_->code_pieces(views.view[2], pass.last.data(), block.scratch.data(),
                          pass.last_pieces.data());
  }
  return pass;
}

std::vector<float> TriangularFlow::EvaluateColumns(const ColumnPass& pass,
                                                   const FlowColumns& x,
                                                   int64_t begin, int n,
                                                   Block* block,
                                                   float* log_density) const {
  const std::array<ConditionerView, 3>& view = pass.views.view;
  Block& b = *block;
  float x_d[kB], x_p[kB], base[kB];
  Gather(x.x_d.data(), begin, n, x_d);
  Gather(x.x_p.data(), begin, n, x_p);
  b.SetFeatures(x, begin, n);
  kernels_->evaluate(view[2], pass.last.data(), x_p, 1, nullptr, base);
  kernels_->condition(view[1], b.rows[1].data());
  kernels_->evaluate(view[1], b.rows[1].data(), x_d, 1, base, base);
  kernels_->condition(view[0], b.rows[0].data());
  std::vector<float> x_h(static_cast<size_t>(x.points) * kB);
  for (int i = 0; i < x.points; ++i) {
    Gather(x.x_h.data() + static_cast<size_t>(i) * x.columns, begin, n,
           x_h.data() + static_cast<size_t>(i) * kB);
  }
  std::vector<float> value(x_h.size());
  kernels_->evaluate(view[0], b.rows[0].data(), x_h.data(), x.points, base,
                     value.data());
  for (int i = 0; i < x.points; ++i) {
    std::copy(value.data() + static_cast<size_t>(i) * kB,
              value.data() + static_cast<size_t>(i) * kB + n,
              log_density + static_cast<size_t>(i) * x.columns + begin);
  }
  return x_h;
}

void TriangularFlow::ColumnGradient(const ColumnPass& pass,
                                    const FlowColumns& x, int64_t begin, int n,
                                    const std::vector<float>& x_h, Block* block,
                                    float* dcode) const {
  const std::array<ConditionerView, 3>& view = pass.views.view;
  Block& b = *block;
  float x_d[kB], x_p[kB];
  Gather(x.x_d.data(), begin, n, x_d);
  Gather(x.x_p.data(), begin, n, x_p);
  b.pieces.resize(pass.pieces_size);
  b.scratch.resize(pass.scratch_size);
  b.dcode.resize(static_cast<size_t>(shape_.code_size) * kB);
  kernels_->code_gradient(view[2], pass.last.data(), pass.last_pieces.data(),
                          x_p, 1, nullptr, kB, kB, 0, b.dcode.data());
  const float* rows = b.rows[1].data();
  kernels_->code_pieces(view[1], rows, b.scratch.data(), b.pieces.data());
  kernels_->code_gradient(view[1], rows, b.pieces.data(), x_d, 1,
                          b.dcode.data(), kB, kB, 0, b.dcode.data());
  rows = b.rows[0].data();
  kernels_->code_pieces(view[0], rows, b.scratch.data(), b.pieces.data());
  kernels_->code_gradient(view[0], rows, b.pieces.data(), x_h.data(), x.points,
                          b.dcode.data(), n, x.num_points(), x.columns,
                          dcode + begin);
}

template <bool kForward>
void TriangularFlow::Transform(const double* from, int64_t count,
                               const float* code, int num_threads,
                               double* to) const {
  const CodeViews views = Views(code);
  ForBlocks(count, num_threads, [&](int64_t begin, int n, Block* block) {
    Block& b = *block;
    // The coordinates of x, which the conditioners read: x_p first.
    const double* x = kForward ? from : to;
    float features[kColumnFeatures * kB] = {};
    for (int dim = 2; dim >= 0; --dim) {
      for (int i = 0; i < n && dim < 2; ++i) {
        // x_d's conditioner sees no feature that depends on x_d. Rounded to
        // float first: a coordinate that comes back a double's rounding
        // away then makes the same features, and the way back is exact.
        const double x_d =
            dim == 0 ? static_cast<float>(x[count + begin + i]) : 0.0;
        const double x_p = static_cast<float>(x[2 * count + begin + i]);
        double f[kColumnFeatures];
        ColumnFeatures<double>(x_d, x_p, f, nullptr, nullptr);
        for (int k = 0; k < kColumnFeatures; ++k) {
          features[k * kB + i] = static_cast<float>(f[k]);
        }
      }
      b.SetFeatures(features);
      const ConditionerView& v = views.view[dim];
      float* rows = b.rows[dim].data();
      kernels_->condition(v, rows);
      std::vector<double> parameters(v.rows - v.output_row);
      for (int i = 0; i < n; ++i) {
        for (size_t k = 0; k < parameters.size(); ++k) {
          parameters[k] = rows[(v.output_row + k) * kB + i];
        }
        const LogLinearSpline<double> spline(parameters.data(), v.bins,
                                             v.heights == v.bins);
        const int64_t at = dim * count + begin + i;
        to[at] = kForward ? spline.Integral(from[at])
                          : spline.InverseIntegral(from[at]);
      }
    }
  });
}

void TriangularFlow::Latent(const double* x, int64_t count, const float* code,
                            int num_threads, double* latent) const {
  Transform<true>(x, count, code, num_threads, latent);
}

void TriangularFlow::Inverse(const double* latent, int64_t count,
                             const float* code, int num_threads,
                             double* x) const {
  Transform<false>(latent, count, code, num_threads, x);
}

class TriangularFlow::Pass final : public BrdfFlow::TrainingPass {
 public:
  explicit Pass(const TriangularFlow& flow) : flow_(flow) {}

  void Forward(const FlowColumns& x, int num_codes, const float* codes,
               float* log_density) override {
    CHECK_EQ(0, x.columns % (num_codes * flow_.TrainingColumns()));
    x_ = &x;
    columns_per_code_ = x.columns / num_codes;
    blocks_.resize(NumColumnBlocks(x.columns), PassBlock(flow_));
    for (size_t index = 0; index < blocks_.size(); ++index) {
      PassBlock& b = blocks_[index];
      const int64_t begin = static_cast<int64_t>(index) * kB;
      const int n = static_cast<int>(std::min<int64_t>(kB, x.columns - begin));
      float base[kB];
      b.x[1].resize(kB);
      Gather(x.x_d.data(), begin, n, b.x[1].data());
      b.x[2].resize(kB);
      Gather(x.x_p.data(), begin, n, b.x[2].data());
      b.x[0].resize(static_cast<size_t>(x.points) * kB);
      for (int i = 0; i < x.points; ++i) {
        Gather(x.x_h.data() + static_cast<size_t>(i) * x.columns, begin, n,
               b.x[0].data() + static_cast<size_t>(i) * kB);
      }
      const int size = flow_.shape_.code_size;
      for (int i = 0; i < kB; ++i) {
        const float* code = codes + CodeOf(begin + std::min(i, n - 1)) * size;
        for (int k = 0; k < size; ++k) b.codes[k * kB + i] = code[k];
      }
      b.block.SetFeatures(x, begin, n);
      b.value.resize(b.x[0].size());
      for (int dim = 2; dim >= 0; --dim) {
        ConditionerView v = flow_.View(dim);
        v.codes = b.codes.data();
        float* rows = b.block.rows[dim].data();
        flow_.kernels_->condition(v, rows);
        flow_.kernels_->evaluate(
            v, rows, b.x[dim].data(), dim == 0 ? x.points : 1,
            dim == 2 ? nullptr : base, dim == 0 ? b.value.data() : base);
      }
      for (int i = 0; i < x.points; ++i) {
        std::copy(b.value.data() + static_cast<size_t>(i) * kB,
                  b.value.data() + static_cast<size_t>(i) * kB + n,
                  log_density + static_cast<size_t>(i) * x.columns + begin);
      }
    }
  }

  void Backward(const float* adjoint, float* gradient,
                float* code_gradient) override {
    const int size = flow_.shape_.code_size, points = x_->points;
    for (size_t index = 0; index < blocks_.size(); ++index) {
      PassBlock& b = blocks_[index];
      const int64_t begin = static_cast<int64_t>(index) * kB;
      const int n =
          static_cast<int>(std::min<int64_t>(kB, x_->columns - begin));
      // Lanes beyond the last column have no adjoint.
      float sum[kB] = {};
      std::fill(b.value.begin(), b.value.end(), 0.0f);
      for (int i = 0; i < points; ++i) {
        const float* a = adjoint + static_cast<size_t>(i) * x_->columns + begin;
        for (int l = 0; l < n; ++l) {
          b.value[i * kB + l] = a[l];
          sum[l] += a[l];
        }
      }
      dcode_.assign(static_cast<size_t>(size) * kB, 0.0f);
      for (int dim = 0; dim < 3; ++dim) {
        const ConditionerShape& c = flow_.conditioners_[dim];
        ConditionerView v = flow_.View(dim);
        v.codes = b.codes.data();
        const float* rows = b.block.rows[dim].data();
        grows_.assign(static_cast<size_t>(c.rows) * kB, 0.0f);
        scratch_.resize(
            static_cast<size_t>(PaddedCount(std::max(c.rows, size))) * kB);
        flow_.kernels_->adjoint(v, rows, b.x[dim].data(), dim == 0 ? points : 1,
                                dim == 0 ? b.value.data() : sum, grows_.data(),
                                nullptr);
        float* part = gradient + flow_.gradient_begin_[dim];
        flow_.kernels_->backward(v, rows, grows_.data(), scratch_.data(), part,
                                 part + c.padded_weights,
                                 part + c.padded_weights + c.rows,
                                 dcode_.data(), false);
      }
      for (int l = 0; l < n; ++l) {
        float* g = code_gradient + CodeOf(begin + l) * size;
        for (int k = 0; k < size; ++k) g[k] += dcode_[k * kB + l];
      }
    }
  }

 private:
  struct PassBlock {
    Block block;
    std::vector<float> codes, value;
    std::array<std::vector<float>, 3> x;

    explicit PassBlock(const TriangularFlow& flow)
        : block(flow.conditioners_),
          codes(static_cast<size_t>(flow.shape_.code_size) * kB) {}
  };
  int64_t CodeOf(int64_t column) const { return column / columns_per_code_; }

  const TriangularFlow& flow_;
  const FlowColumns* x_ = nullptr;
  int columns_per_code_ = 1;
  std::vector<PassBlock> blocks_;
  std::vector<float> grows_, scratch_, dcode_;
};

std::unique_ptr<BrdfFlow::TrainingPass> TriangularFlow::NewTrainingPass()
    const {
  return std::make_unique<Pass>(*this);
}

size_t TriangularFlow::GradientSize() const {
  return gradient_begin_[2] + PartSize(conditioners_[2], shape_.code_size);
}

void TriangularFlow::AddGradient(const float* buffer, float* weights) const {
  for (int dim = 0; dim < 3; ++dim) {
    const ConditionerShape& c = conditioners_[dim];
    const float* from = buffer + gradient_begin_[dim];
    const float* biases = from + c.padded_weights;
    const float* codes = biases + c.rows;
    float* to = weights + weights_begin_[dim];
    for (const DenseLayer& d : c.dense) {
      for (int o = 0; o < d.out_count; ++o) {
        for (int k = 0; k < d.in_count; ++k) {
          to[d.weight_offset + static_cast<size_t>(o) * d.in_count + k] +=
              from[d.padded_offset +
                   static_cast<size_t>(o) * PaddedCount(d.in_count) + k];
        }
        to[d.bias_offset + o] += biases[d.out + o];
      }
    }
    for (int o = 0; o < c.dense[0].out_count; ++o) {
      for (int k = 0; k < shape_.code_size; ++k) {
        to[c.code_offset + static_cast<size_t>(o) * shape_.code_size + k] +=
            codes[static_cast<size_t>(o) * PaddedCount(shape_.code_size) + k];
      }
    }
  }
}

}  // namespace ibrdf

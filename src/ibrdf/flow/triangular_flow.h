// The flow in the triangular order, in float on many points (see
// triangular_shape.h).
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/triangular_kernels.h"

namespace ibrdf {

std::vector<float> InitialTriangularWeights(const TriangularShape& shape,
                                            uint64_t seed);

class TriangularFlow final : public BrdfFlow {
 public:
  TriangularFlow(const TriangularShape& shape,
                 const std::vector<float>& weights,
                 SimdLevel level = ActiveSimdLevel());

  const TriangularShape& shape() const { return shape_; }
  const std::vector<float>& weights() const { return weights_; }

  void SetWeights(const std::vector<float>& weights) override;
  void LogDensity(const float* x, int64_t count, const float* code,
                  int num_threads, float* log_density, float* dcode,
                  float* dx) const override;
  void LogDensityOnColumns(const FlowColumns& x, const float* code,
                           int num_threads, float* log_density,
                           float* dcode) const override;
  void Latent(const double* x, int64_t count, const float* code,
              int num_threads, double* latent) const override;
  void Inverse(const double* latent, int64_t count, const float* code,
               int num_threads, double* x) const override;
  std::unique_ptr<TrainingPass> NewTrainingPass() const override;
  int TrainingColumns() const override { return 16; }
  size_t GradientSize() const override;
  void AddGradient(const float* buffer, float* weights) const override;

 private:
  class Pass;
  struct CodeViews;  // the conditioners of one code
  struct Block;      // activations of one block of columns
  CodeViews Views(const float* code) const;
  ConditionerView View(int dim) const;
  template <bool kForward>
  void Transform(const double* from, int64_t count, const float* code,
                 int num_threads, double* to) const;

  TriangularShape shape_;
  std::array<ConditionerShape, 3> conditioners_;
  std::array<size_t, 3> weights_begin_, gradient_begin_;
  std::vector<float> weights_;
  const TriangularKernels* kernels_;
};

}  // namespace ibrdf

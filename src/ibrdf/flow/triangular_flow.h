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
  struct Block;      // activations of one block of kColumnBlock columns
  struct PointBlock;
  struct ColumnPass;
  CodeViews Views(const float* code) const;
  // Calls body(begin, n, block) for every kColumnBlock of `count` columns, each
  // thread with a block of its own; n of the last one may be less.
  template <typename Body>
  void ForBlocks(int64_t count, int num_threads, const Body& body) const;
  ConditionerView View(int dim) const;
  // Gradients of a block that has been evaluated: in x, and, in block->dcode,
  // in the code.
  void BlockGradient(const CodeViews& views, const PointBlock& at, Block* block,
                     float gx[3][kColumnBlock]) const;
  // LogDensityOnColumns: what all columns share; n columns from `begin` on,
  // whose x_h [points][kColumnBlock] it returns; their dcode.
  ColumnPass PrepareColumns(const CodeViews& views, bool gradient) const;
  std::vector<float> EvaluateColumns(const ColumnPass& pass,
                                     const FlowColumns& x, int64_t begin, int n,
                                     Block* block, float* log_density) const;
  void ColumnGradient(const ColumnPass& pass, const FlowColumns& x,
                      int64_t begin, int n, const std::vector<float>& x_h,
                      Block* block, float* dcode) const;
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

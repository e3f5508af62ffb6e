// The alternating stack of coupling layers (Chen et al. 2020, Sec. 4.2), in
// float on many points.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/coupling_kernels.h"

namespace ibrdf {

std::vector<float> InitialCouplingWeights(const CouplingShape& shape,
                                          uint64_t seed);

class CouplingFlow final : public BrdfFlow {
 public:
  CouplingFlow(const CouplingShape& shape, const std::vector<float>& weights,
               SimdLevel level = ActiveSimdLevel());

  void SetWeights(const std::vector<float>& weights) override;
  void LogDensity(const float* x, int64_t count, const float* code,
                  int num_threads, float* log_density, float* dcode,
                  float* dx) const override;
  void LogDensityOnColumns(const FlowColumns& x, const float* code,
                           int num_threads, float* log_density,
                           float* dcode) const override;
  // In float inside: layers feed each other.
  void Latent(const double* x, int64_t count, const float* code,
              int num_threads, double* latent) const override;
  void Inverse(const double* latent, int64_t count, const float* code,
               int num_threads, double* x) const override;
  std::unique_ptr<TrainingPass> NewTrainingPass() const override;
  // With a number of points that is a multiple of 4.
  int TrainingColumns() const override { return 16; }
  size_t GradientSize() const override;
  void AddGradient(const float* buffer, float* weights) const override;

 private:
  class Pass;
  CouplingView View(const float* first_bias) const;
  std::vector<float> FirstBias(const float* code) const;

  CouplingShape shape_;
  std::vector<float> weights_;
  std::vector<DenseLayer> dense_;
  size_t padded_per_layer_ = 0;
  const CouplingKernels* kernels_;
};

}  // namespace ibrdf

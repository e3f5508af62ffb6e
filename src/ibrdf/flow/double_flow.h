// A flow whose tables are made in double precision (SimdLevel::kDouble).
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/reference_flow.h"

namespace ibrdf {

// LogDensityOnColumns, which is all that a solve asks of a flow, by the plain
// reference; codes, points and results are floats. The rest is that of
// `kernels`, a flow of the same shape.
class DoubleFlow final : public BrdfFlow {
 public:
  DoubleFlow(const FlowShape& shape, const std::vector<float>& weights,
             std::unique_ptr<BrdfFlow> kernels);

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
  int TrainingColumns() const override;
  size_t GradientSize() const override;
  void AddGradient(const float* buffer, float* weights) const override;

 private:
  const FlowShape shape_;
  const std::unique_ptr<BrdfFlow> kernels_;
  std::unique_ptr<const ReferenceFlow> reference_;
};

}  // namespace ibrdf

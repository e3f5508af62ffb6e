#include "ibrdf/flow/double_flow.h"

#include <utility>

#include "ibrdf/base/parallel_for.h"

namespace ibrdf {

DoubleFlow::DoubleFlow(const FlowShape& shape,
                       const std::vector<float>& weights,
                       std::unique_ptr<BrdfFlow> kernels)
    : shape_(shape),
      kernels_(std::move(kernels)),
      reference_(std::make_unique<ReferenceFlow>(shape, weights)) {}

void DoubleFlow::SetWeights(const std::vector<float>& weights) {
  kernels_->SetWeights(weights);
  reference_ = std::make_unique<ReferenceFlow>(shape_, weights);
}

void DoubleFlow::LogDensityOnColumns(const FlowColumns& x, const float* code,
                                     int num_threads, float* log_density,
                                     float* dcode) const {
  const std::vector<double> z(code, code + shape_.code_size());
  ParallelFor(x.columns, num_threads, [&](int64_t c, int) {
    reference_->LogDensityOnColumn(x.x_d[c], x.x_p[c], &x.x_h[c], x.points,
                                   x.columns, z.data(), log_density + c,
                                   dcode == nullptr ? nullptr : dcode + c,
                                   x.num_points());
  });
}

void DoubleFlow::LogDensity(const float* x, int64_t count, const float* code,
                            int num_threads, float* log_density, float* dcode,
                            float* dx) const {
  kernels_->LogDensity(x, count, code, num_threads, log_density, dcode, dx);
}
void DoubleFlow::Latent(const double* x, int64_t count, const float* code,
                        int num_threads, double* latent) const {
  kernels_->Latent(x, count, code, num_threads, latent);
}
void DoubleFlow::Inverse(const double* latent, int64_t count, const float* code,
                         int num_threads, double* x) const {
  kernels_->Inverse(latent, count, code, num_threads, x);
}
std::unique_ptr<BrdfFlow::TrainingPass> DoubleFlow::NewTrainingPass() const {
  return kernels_->NewTrainingPass();
}
int DoubleFlow::TrainingColumns() const { return kernels_->TrainingColumns(); }
size_t DoubleFlow::GradientSize() const { return kernels_->GradientSize(); }
void DoubleFlow::AddGradient(const float* buffer, float* weights) const {
  kernels_->AddGradient(buffer, weights);
}

}  // namespace ibrdf

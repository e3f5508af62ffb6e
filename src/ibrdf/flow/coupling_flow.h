// The invertible network: a normalizing flow on the unit cube conditioned on an
// embedding code (Chen et al. 2020, Sec. 4.2 and 4.3).
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/flow/flow_kernels.h"
#include "ibrdf/flow/flow_shape.h"

namespace ibrdf {

// Random weights, He-scaled; the last dense layer of every conditioner is
// scaled down so that the flow starts near the identity. float [NumWeights()].
std::vector<float> InitialFlowWeights(const FlowShape& shape, uint64_t seed);

// Evaluation in float on many points. Points are structures of arrays:
// x [3][count], each coordinate in [0, 1]; codes are [code_size]. Values are
// log densities in nats with respect to the volume of the cube. All methods
// give the same bits for any number of threads; const methods are thread-safe.
class CouplingFlow {
 public:
  // weights: [shape.NumWeights()], copied. level: kernels to use.
  CouplingFlow(const FlowShape& shape, const std::vector<float>& weights,
               SimdLevel level = ActiveSimdLevel());

  const FlowShape& shape() const { return shape_; }
  const std::vector<float>& weights() const { return weights_; }
  void SetWeights(const std::vector<float>& weights);

  // log_density [count]; latent [3][count] may be null.
  void LogDensity(const float* x, int64_t count, const float* code,
                  int num_threads, float* log_density, float* latent) const;

  // Also d log density / d code as [code_size][count] and / d x as [3][count];
  // either may be null.
  void LogDensityWithGradient(const float* x, int64_t count, const float* code,
                              int num_threads, float* log_density, float* dcode,
                              float* dx) const;

  // Samples: x = F^-1(latent) with its log density (may be null).
  void Inverse(const float* latent, int64_t count, const float* code,
               int num_threads, float* x, float* log_density) const;

  // The trainer's pass over one block of kFlowBlock points that share a code.
  // Forward() first; Backward() then adds the gradient of
  // sum_p adjoint[p] log_density[p] to the buffers.
  class TrainingPass {
   public:
    explicit TrainingPass(const CouplingFlow& flow);
    void Forward(const float* x, const float* code, float* log_density);
    // gradient: [PaddedGradientSize()]; code_gradient: [code_size].
    void Backward(const float* adjoint, float* gradient, float* code_gradient);

   private:
    const CouplingFlow& flow_;
    std::vector<float> code_, first_bias_, tape_, latent_, scratch_, bias_;
  };
  size_t PaddedGradientSize() const;
  // Padded buffer -> the order of weights(), added to gradient.
  void UnpadGradient(const float* padded, float* gradient) const;

 private:
  FlowView View(const float* first_bias) const;
  std::vector<float> FirstBias(const float* code) const;

  FlowShape shape_;
  std::vector<float> weights_;
  std::vector<FlowDense> dense_;
  size_t padded_per_layer_ = 0;
  const FlowKernels* kernels_;
};

}  // namespace ibrdf

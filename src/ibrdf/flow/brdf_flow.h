// The invertible network behind one interface: a normalised density on the unit
// cube x = (x_h, x_d, x_p) (see brdf_grid.h), conditioned on an embedding code
// (Chen et al. 2020, Sec. 4.2 and 4.3).
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/flow/flow_shape.h"

namespace ibrdf {

// Points of the cube in columns of constant (x_d, x_p), each with the same
// number of x_h: how tables are laid out, and cheap to evaluate.
struct FlowColumns {
  int columns = 0;
  int points = 0;               // x_h of each column
  std::vector<float> x_d;       // [columns]
  std::vector<float> x_p;       // [columns]
  std::vector<float> features;  // [kColumnFeatures][columns]
  std::vector<float> x_h;       // [points][columns]

  FlowColumns() = default;
  FlowColumns(int num_columns, int num_points);
  // Sets x_d, x_p and what follows from them.
  void SetColumn(int column, double xd, double xp);
  // The same from a column of `other`, without trigonometry.
  void CopyColumn(int column, const FlowColumns& other, int from);
  int64_t num_points() const { return static_cast<int64_t>(columns) * points; }
};

// Log densities are in nats with respect to the volume of the cube. Methods
// give the same bits for any number of threads; const methods are thread-safe.
class BrdfFlow {
 public:
  virtual ~BrdfFlow() = default;

  // weights: [shape.NumWeights()], copied. level: kernels to use.
  static std::unique_ptr<BrdfFlow> Create(const FlowShape& shape,
                                          const std::vector<float>& weights,
                                          SimdLevel level = ActiveSimdLevel());

  virtual void SetWeights(const std::vector<float>& weights) = 0;

  // At points [3][count], each coordinate in [0, 1]: log_density [count] and,
  // where not null, its gradients dcode [code_size][count] and dx [3][count].
  virtual void LogDensity(const float* x, int64_t count, const float* code,
                          int num_threads, float* log_density, float* dcode,
                          float* dx) const = 0;

  // At columns: log_density [points][columns] and, where not null, dcode
  // [code_size][points][columns].
  virtual void LogDensityOnColumns(const FlowColumns& x, const float* code,
                                   int num_threads, float* log_density,
                                   float* dcode) const = 0;

  // The flow itself, [3][count]: x -> latent, uniform if x has the density, and
  // back. No program calls the two: they are what makes the density one of an
  // invertible map, and tests hold the flow to that promise (inverse of forward
  // is the identity over the closed cube; the inverse of uniform numbers has
  // the density).
  virtual void Latent(const double* x, int64_t count, const float* code,
                      int num_threads, double* latent) const = 0;
  virtual void Inverse(const double* latent, int64_t count, const float* code,
                       int num_threads, double* x) const = 0;

  // The trainer's pass over a group of codes. Column c belongs to code
  // c / (columns / num_codes).
  class TrainingPass {
   public:
    virtual ~TrainingPass() = default;
    // codes: [num_codes][code_size]; log_density: [points][columns].
    virtual void Forward(const FlowColumns& x, int num_codes,
                         const float* codes, float* log_density) = 0;
    // Adds the gradient of sum adjoint * log_density, adjoint
    // [points][columns], to gradient [GradientSize()] and to code_gradient
    // [num_codes][code_size].
    virtual void Backward(const float* adjoint, float* gradient,
                          float* code_gradient) = 0;
  };
  // `*this` must outlive the pass.
  virtual std::unique_ptr<TrainingPass> NewTrainingPass() const = 0;
  // Columns of a code in a pass are a multiple of this.
  virtual int TrainingColumns() const = 0;
  // The size of the buffers of Backward, whose layout is the kernels' own.
  // AddGradient adds one to weights in their order.
  virtual size_t GradientSize() const = 0;
  virtual void AddGradient(const float* buffer, float* weights) const = 0;
};

// Random weights, He-scaled; the last layer of every conditioner is scaled down
// so that the flow starts near the identity. float [shape.NumWeights()].
std::vector<float> InitialFlowWeights(const FlowShape& shape, uint64_t seed);

}  // namespace ibrdf

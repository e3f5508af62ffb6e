// Reflectance of a model's lobes at any angles, by the flow itself.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/geometry/half_diff.h"

namespace ibrdf {

// BRDF in 1/sr at many angles at once; as many values as angles.
using BrdfBatch = std::function<std::vector<Eigen::Array3d>(
    const std::vector<HalfDiff>& angles)>;

// A function taken one by one.
BrdfBatch BatchOf(BrdfFunction brdf);

// The parameters of a LobeMixture of three lobes that stand for a material of
// the embedding: one lobe a channel, of its own code, with no colour in the
// others. first_code: that of the red channel.
std::vector<double> MaterialLobes(const NeuralBrdfModel& model, int first_code);

// Immutable; safe to share between threads.
class FlowBrdf {
 public:
  // parameters: of a LobeMixture of num_lobes, copied.
  FlowBrdf(const NeuralBrdfModel& model, const double* parameters,
           int num_lobes, int num_threads);

  std::vector<Eigen::Array3d> Evaluate(
      const std::vector<HalfDiff>& angles) const;

  // *this as a function; it shares what it needs.
  BrdfBatch Batch() const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace ibrdf

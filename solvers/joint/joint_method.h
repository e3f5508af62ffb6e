// The solvers of the joint estimate behind one call, all on one objective.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/joint/joint_objective.h"

namespace ibrdf {

enum class JointMethod {
  // Gauss-Newton on the light, Ceres' trust region on the lobes, in turns.
  kAlternating,
  // Both blocks at once: matrix-free Gauss-Newton with damping, its steps by
  // conjugate gradients through illumination model and transport,
  // preconditioned by the lobes' dense block and the light's prior variances.
  kGaussNewton,
  // Ceres' line search with L-BFGS, whitened by the priors.
  kLbfgs,
  // The reference: Adam in turns (Chen et al. 2020).
  kAdam,
  // Ceres' trust region on the dense Jacobian in an exactly compressed block;
  // small problems only, see CheckJointMethod.
  kTrustRegion,
};

// One line of progress.
struct JointIteration {
  int iteration = 0;     // from 1
  double seconds = 0.0;  // since the call
  JointCost cost;        // of the best state so far
};

struct JointMethodOptions {
  // Steps of Gauss-Newton or the trust region; rounds of kAlternating; L-BFGS
  // takes max_cg_iterations times as many, as many gradients as Gauss-Newton
  // would take products. Not of Adam.
  int max_iterations = 50;
  int max_cg_iterations = 20;
  // Share of the squared preconditioned residual that conjugate gradients stop
  // at. A tenth of the residual is enough of an inexact Newton step on one
  // block; on both, whose levels and colours make up for each other, the steps
  // that leaves stay along such directions short (experiments/pareto).
  double cg_forcing = 1e-2;
  // Whether Gauss-Newton's steps take the light's preconditioner, where its
  // model has one, and come near their limit.
  bool precondition_light = false;
  double tolerance = 1e-4;  // relative decrease of the cost to stop at
  double seconds = 1e9;     // wall clock, checked between iterations
  std::function<bool()> should_stop;  // likewise; may be empty
  std::function<void(const JointIteration&)> callback;  // may be empty

  // Steps of a round of kAlternating.
  int light_iterations = 3;
  int lobe_iterations = 5;

  // Adam: rounds of light_steps, then lobe_steps. Steps are in the parameters'
  // own units: log radiance (free texels, biases) or weights of a network whose
  // features have variance 1; codes in the unit ball and log colours.
  int adam_rounds = 10;
  int adam_light_steps = 300;
  int adam_lobe_steps = 100;
  double adam_light_rate = 1e-2;
  double adam_lobe_rate = 1e-2;
};

struct JointSummary {
  JointCost start, end;  // as JointObjective::Evaluate has them
  int iterations = 0;
  double seconds = 0.0;
  bool stopped = false;  // by seconds or should_stop
};

// kInvalidInput, with the field solver.method, where the method refuses the
// objective: kTrustRegion with more than kMaxTrustRegionParameters in the free
// blocks or kMaxTrustRegionEntries in the Jacobian.
inline constexpr int kMaxTrustRegionParameters = 2048;
inline constexpr int64_t kMaxTrustRegionEntries = int64_t{1} << 25;  // 256 MB
Status CheckJointMethod(JointMethod method, const JointObjective& objective);
// The same of the objective's size() and num_residuals().
Status CheckJointMethod(JointMethod method, int64_t unknowns,
                        int64_t residuals);

// Lowers the objective over its free blocks, in place. The cost never rises:
// the best iterate is returned. A method that CheckJointMethod refuses is a bug
// of the caller.
JointSummary MinimiseJoint(JointMethod method, JointObjective* objective,
                           JointState* state,
                           const JointMethodOptions& options);

}  // namespace ibrdf

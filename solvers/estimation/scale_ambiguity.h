// The scale between reflectance and light, (s R, L / s) per channel, which
// leaves the image as it is: no image tells it, so that something else must.
//
//   where                          what says the scale
//   light integrated out           the level: the materials' mean (LevelGauge);
//                                  the hue: the posterior
//   joint maximum                  the priors of colours and light, after every
//                                  outer iteration (SettleScale)
//   solver.gauge, at the end       the light's mean radiance (SetGauge)
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// A reflectance's mean log over the angles is put where that of the prior's
// materials is on average.
//
// A Gaussian of codes and colours says less: shapes between those of the
// materials are far out along its colours too, where the level that it deems
// most probable may be twenty times off.
class LevelGauge {
 public:
  // The prior's materials, at least one, are tabulated here, once.
  LevelGauge(const NeuralBrdfModel& model, const MaterialPrior& prior,
             int num_threads);

  // Adds the same to the log colours of all lobes and channels of `parameters`
  // [lobes * (code + 3)] and returns it; finite for any finite parameters.
  double Fix(double* parameters) const;
  // The same by a level of the caller's, for materials one after the other.
  void Shift(double level, int num_materials, double* parameters) const;

 private:
  double MeanLog(const double* parameters) const;

  const FlowLobes lobes_;
  double mean_ = 0.0;
};

// Minimises, over shifts d_c of the lobes' log colours (and -d_c of the map's
// log radiance), the prior of the colours plus
// 1/2 sum_{c != green} ((m_c - d_c) - (m_green - d_green))^2 / light_std^2,
// m_c the map's mean log radiance: natural light is nearly grey. Returns d.
std::vector<double> GaugeShift(const LobeModel& lobes, const LobePrior& prior,
                               const std::vector<double>& parameters,
                               const double* mean_log_radiance,
                               double light_std);

// Moves GaugeShift's scale from the light of an iterate, and from the mean of
// its prior, to its lobes. Nothing where either is known.
void SettleScale(const SolveSetup& setup, Iterate* iterate);

// Log scales d by channel: with exp(d) R and exp(-d) L in the places of R and L
// the gauge holds (problem.h). `map`: L, as the priors have it. 0 where its
// mean radiance is not positive and finite in every channel.
Eigen::Array3d LightGaugeShift(SolverGauge gauge, const Image& map);

// Moves that from the map of a joint estimate to its reflectances: lobes, of
// codes of this size, tables, slices and alternatives.
void SetGauge(SolverGauge gauge, int code_size, Solution* solution);

}  // namespace ibrdf

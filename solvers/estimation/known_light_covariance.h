// How well a reflectance is known under known light.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/solvers/costs/log_likelihood.h"
#include "ibrdf/solvers/priors/material_prior.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

// What each of so many observed points counts: a joint estimate has some 200
// bins, and the errors of more points than that are alike in neighbours.
double IndependentShare(int num_points);

// Laplace's covariance of the lobes' parameters at an optimum, as LobeModel has
// them: the inverse of the Gauss-Newton Hessian,
//   (G^T D^-1 G + K^-1)^-1,  G = d log L_o / d parameters,
// K the prior's covariance and D that of log radiance: the noise, of Laplacian
// scale b, and what no lobes can render, by which the joint estimate's bins
// deviate (ReflectanceSearchOptions::sigma). That error is alike in neighbours:
// of more points than a joint estimate has bins, each counts for less. Empty
// where it is not finite.
//
// transport: of the observed points; likelihood: its scale is b.
Eigen::MatrixXd KnownLightCovariance(const Transport& transport,
                                     const LobeModel& lobes,
                                     const MaterialPrior& prior,
                                     const std::vector<float>& map,
                                     const Observations& observed,
                                     const RobustLogLikelihood& likelihood,
                                     const std::vector<double>& parameters);

}  // namespace ibrdf

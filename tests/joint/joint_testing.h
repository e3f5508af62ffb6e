// A small joint problem shared by the tests of solvers/joint.
#pragma once
#include <memory>
#include <random>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/joint/joint_method.h"
#include "ibrdf/solvers/joint/joint_objective.h"
#include "ibrdf/solvers/priors/process_prior.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace testing {

inline const char* JointMethodName(JointMethod method) {
  switch (method) {
    case JointMethod::kAlternating:
      return "alternating";
    case JointMethod::kGaussNewton:
      return "gauss_newton";
    case JointMethod::kLbfgs:
      return "lbfgs";
    case JointMethod::kAdam:
      return "adam";
    case JointMethod::kTrustRegion:
      return "trust_region";
  }
  return "";
}

// So few weights that dense matrices of them take no time.
inline IlluminationUnetOptions TiniestUnetOptions() {
  IlluminationUnetOptions options = TinyUnetOptions();
  options.channels = 2;
  options.skip_channels = 1;
  return options;
}

// A sphere of some 100 points, two lobes, a map of 16x8 of a tiny UNet or of
// free texels; observations without noise of the scene's lobes under SmoothMap.
struct JointScene {
  explicit JointScene(bool unet, int size = 12, bool lambertian = false)
      : points(SpherePoints(size)),
        transport(points, 8, 16, TinyTransportOptions()),
        light(unet ? MakeUnetIllumination(TiniestUnetOptions())
                   : MakeFreeIllumination(16, 8)) {
    truth = TinyScene().Parameters();
    if (lambertian) {
      lobes_with.emplace(model, lobes.layout().WithLambertian(),
                         TinyTransportOptions().grid, 1);
      truth.insert(truth.end(), {3.0, 3.5, 2.5});
    }
    grid = Lobes().Grid(truth.data());
    std::vector<double> L_o(3 * points.size());
    transport.Render(grid, SmoothMap(8, 16).rgb.data(), L_o.data());
    observed = MakeObservations(L_o);
    const double zero[3] = {0, 0, 0};
    mean = light->ConstantMap(zero);
  }

  JointTerms Terms(bool with_process = true) {
    JointTerms terms;
    terms.observed = &observed;
    terms.likelihood.scale = 0.1;
    terms.transport = &transport;
    terms.lobes = &Lobes();
    for (double& m : terms.lobe_prior.colour_mean) m = 4.0;
    terms.illumination = light.get();
    terms.light_mean = mean;
    if (with_process) terms.light_priors = {&process};
    return terms;
  }
  JointTerms KnownLight() {
    JointTerms terms = Terms();
    terms.illumination = nullptr;
    terms.light_priors.clear();
    terms.known_map = SmoothMap(8, 16).rgb;
    return terms;
  }
  JointTerms KnownBrdf() {
    known = std::make_unique<LightOperator>(transport.ByLight(grid));
    JointTerms terms = Terms();
    terms.lobes = nullptr;
    terms.known_brdf = known.get();
    return terms;
  }

  const FlowLobes& Lobes() const { return lobes_with ? *lobes_with : lobes; }

  // The lobes that made the image, off by `away`; light by as many standard
  // deviations from the constant map.
  JointState State(double away, unsigned seed = 3) const {
    JointState state{truth, mean};
    std::mt19937 rng(seed);
    std::normal_distribution<double> gauss;
    for (double& p : state.lobes) p += 0.5 * away * gauss(rng);
    const std::vector<float> std = light->PriorStd();
    for (size_t i = 0; i < mean.size(); ++i) {
      // The biases of a map's level have a wide prior: less of it.
      const double s = std::min(std[i], 3.0f);
      state.light[i] += static_cast<float>(away * s * gauss(rng));
    }
    return state;
  }

  const std::vector<ShadingPoint> points;
  const Transport transport;
  const NeuralBrdfModel model = SmoothTinyModel(2);
  const FlowLobes lobes{model, 2, TinyTransportOptions().grid, 1};
  std::optional<FlowLobes> lobes_with;  // a Lambertian one
  const std::unique_ptr<IlluminationModel> light;
  ProcessPrior process{8, 16, LightProcess(), LightHyperparameters::Average(),
                       0.0};
  std::vector<double> truth;
  BrdfGrid grid;
  Observations observed;
  std::vector<float> mean;
  std::unique_ptr<LightOperator> known;
};

// Standard normal, whitened by the objective's prior metric.
inline Eigen::VectorXd RandomDirection(const JointObjective& objective,
                                       unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> gauss;
  const Eigen::VectorXd d = objective.InverseVariance();
  Eigen::VectorXd v(d.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    v[i] = gauss(rng) * std::min(1.0 / std::sqrt(d[i]), 1.0);
  }
  return v;
}

}  // namespace testing
}  // namespace ibrdf

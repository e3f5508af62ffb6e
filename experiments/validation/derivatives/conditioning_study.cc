#include "experiments/validation/derivatives/conditioning_study.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/marginal/marginal_descent.h"
#include "ibrdf/solvers/marginal/marginal_objective.h"
#include "ibrdf/solvers/optim/conditioning.h"
#include "ibrdf/solvers/priors/material_prior_cost.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace derivatives {
namespace {

constexpr double kCodeSigma = 0.5;
// The tolerance of the light's mode, nats: what is left of it enters
// differences of gradients by its root.
constexpr double kModeTolerance = 1e-9;

Eigen::MatrixXd NormalMatrix(const ceres::CostFunction& cost,
                             const Eigen::VectorXd& x) {
  using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::VectorXd r(cost.num_residuals());
  RowMajor J(cost.num_residuals(), x.size());
  const double* block[] = {x.data()};
  double* jacobians[] = {J.data()};
  CHECK(cost.Evaluate(block, r.data(), jacobians));
  return J.transpose() * J;
}

Eigen::VectorXd ParametersOf(const MaterialPrior& prior,
                             const std::string& name) {
  const MaterialPrior::Material* material = prior.Find(name);
  CHECK(material != nullptr) << "no material " << name;
  return material->parameters;
}

// At the minimum that the descent finds from x, by central differences of the
// gradient, in whitened coordinates.
void StudyMarginalHessian(const NeuralBrdfModel& model,
                          const MaterialPrior& prior,
                          const std::vector<ShadingPoint>& points,
                          const std::vector<double>& radiance,
                          const Eigen::VectorXd& x, ConditioningRow* row) {
  MarginalResolution resolution;
  resolution.bins = {8, 4, 0.2};
  resolution.map_width = 16;
  resolution.map_height = 8;
  const MarginalReflectance reflectance(
      FlowLobes::Factory(model, prior.layout(), 1), points,
      MakeObservations(radiance), LightProcess(), resolution, 0);
  const DataErrors errors = {
      Eigen::VectorXd::Constant(3 * reflectance.bins().num_bins(), 0.0025), {}};
  LightMode mode;
  reflectance.Evaluate(x.data(), errors, {}, 1e-9, &mode, nullptr);
  const MarginalObjective whitened(&reflectance, &prior, errors, &mode,
                                   kModeTolerance);
  std::vector<double> y = whitened.Whitened(x, {});
  MarginalDescentOptions o;
  o.max_iterations = 200;
  o.least_gain = 1e-6;
  CHECK(Descend(whitened, o, &y).ok);
  const auto n = static_cast<Eigen::Index>(y.size());
  Eigen::MatrixXd hessian(n, n);
  ParallelFor(n, 0, [&](int64_t i, int) {
    constexpr double kStep = 0.02;
    Eigen::VectorXd side[2];
    for (int s = 0; s < 2; ++s) {
      std::vector<double> at = y;
      at[i] += s == 0 ? kStep : -kStep;
      LightMode start = mode;
      const MarginalObjective objective(&reflectance, &prior, errors, &start,
                                        kModeTolerance);
      double cost = 0.0;
      side[s].resize(n);
      CHECK(objective.Evaluate(at.data(), &cost, side[s].data()));
    }
    hessian.col(i) = (side[0] - side[1]) / (2 * kStep);
  });
  hessian = (0.5 * (hessian + hessian.transpose())).eval();
  row->marginal = ScaledCondition(hessian);
  const Eigen::LLT<Eigen::MatrixXd> llt(hessian);
  if (llt.info() != Eigen::Success) return;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd exact = llt.solve(identity).diagonal();
  Eigen::VectorXd ratio =
      whitened.Information(y.data()).llt().solve(identity).diagonal();
  ratio = ratio.cwiseQuotient(exact).cwiseSqrt();
  std::sort(ratio.data(), ratio.data() + n);
  row->smallest_ratio = ratio[0];
  row->median_ratio = ratio[n / 2];
  row->largest_ratio = ratio[n - 1];
}

}  // namespace

std::vector<ConditioningRow> StudyConditioning(const NeuralBrdfModel& model,
                                               bool marginal) {
  const MaterialPrior one = JointMaterialPrior(model, 1, kCodeSigma);
  const MaterialPrior two = JointMaterialPrior(model, 2, kCodeSigma);
  const std::vector<ShadingPoint> points = testing::SpherePoints(24);
  const Image map = testing::SmoothMap(32, 64);
  const TransportOptions options;
  const Transport transport(points, map.height, map.width, options);
  std::vector<ConditioningRow> rows;
  for (const char* name : {"white-fabric", "red-plastic", "chrome"}) {
    const Eigen::VectorXd both = ParametersOf(two, name);
    Eigen::VectorXd same = both;
    const LobeLayout layout = two.layout();
    const MutableLobeMixture lobes_of_same(layout, same.data());
    lobes_of_same.lobe(1) = lobes_of_same.lobe(0);
    const struct {
      const char* lobes;
      const MaterialPrior* prior;
      Eigen::VectorXd x;
    } cases[] = {{"1", &one, ParametersOf(one, name)},
                 {"2", &two, both},
                 {"2 that coincide", &two, same}};
    for (const auto& c : cases) {
      const FlowLobes lobes(model, c.prior->layout(), options.grid, 0);
      std::vector<double> L_o;
      CHECK(RenderLobeModel(transport, lobes, c.x.data(), map.rgb.data(), &L_o,
                            nullptr));
      const Observations observed = MakeObservations(L_o);
      RobustLogLikelihood likelihood;
      double mean = 0.0;
      for (const double e : L_o) mean += e / static_cast<double>(L_o.size());
      likelihood.epsilon = 1e-5 * mean;
      const LobeRadianceCost cost(&transport, &lobes, map.rgb, &observed,
                                  likelihood);
      const MaterialPriorCost prior(c.prior);
      const Eigen::MatrixXd image = NormalMatrix(cost, c.x);
      ConditioningRow row;
      row.material = name;
      row.lobes = c.lobes;
      row.image = ScaledCondition(image);
      row.with_prior = ScaledCondition(image + NormalMatrix(prior, c.x));
      row.marginal = row.smallest_ratio = row.median_ratio = row.largest_ratio =
          std::numeric_limits<double>::quiet_NaN();
      if (marginal) {
        StudyMarginalHessian(model, *c.prior, points, L_o, c.x, &row);
      }
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace derivatives
}  // namespace ibrdf

// The robust likelihood by radiance, and the priors.
#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/reference_scene.h"
#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/solvers/costs/log_likelihood.h"
#include "ibrdf/solvers/priors/material_prior_cost.h"
#include "ibrdf/solvers/priors/prior_costs.h"
#include "ibrdf/solvers/priors/process_prior.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

// One value of L_o beside one of I, with the slope of the cost, of the residual
// and the weight of the reweighted squares.
void AddLikelihood(const std::string& kind, double L_o, double observed,
                   const RobustLogLikelihood& l, ErrorTable* table) {
  const Observations o = MakeObservations({observed, observed, observed});
  LikelihoodDerivatives d;
  EvaluateLikelihood({L_o, L_o, L_o}, o, l, &d);
  const Real e = L_o + Real(l.epsilon), delta = l.delta, b = l.scale;
  const Real t = (std::log(e) - std::log(observed + Real(l.epsilon))) / b;
  const Real root = std::sqrt(t * t + delta * delta);
  const std::string where =
      "E, I, epsilon, b " + Coordinates({L_o, observed, l.epsilon, l.scale});
  const std::string name = "likelihood: ";
  table->Add(name + "residual by radiance", kind, where, {d.d_residual[0]},
             {ResidualSlope(L_o, observed, l)});
  table->Add(name + "cost by radiance", kind, where,
             {d.residual[0] * d.d_residual[0]}, {t / root / (b * e)});
  table->Add(name + "weight", kind, where, {d.weight[0]},
             {1 / (b * e * b * e) / root});
}

void StudyLikelihood(int count, std::mt19937_64* rng, ErrorTable* table) {
  std::uniform_real_distribution<double> power(-30.0, 30.0), unit(-1.0, 1.0);
  const auto random = [&] { return std::pow(10.0, power(*rng)); };
  for (int i = 0; i < count; ++i) {
    RobustLogLikelihood l;
    l.scale = std::pow(10.0, -2 + unit(*rng));
    const double epsilons[] = {0.0, 1e-30, 1e-6, 1.0, 1e30};
    l.epsilon = epsilons[i % 5];
    AddLikelihood("1e-30 to 1e30", random(), random(), l, table);
    const double I = std::pow(10.0, unit(*rng));
    AddLikelihood("like an image", I * std::exp(0.1 * unit(*rng)), I,
                  RobustLogLikelihood(), table);
    AddLikelihood("E = I (1 + 1e-9)", I * (1 + 1e-9), I, RobustLogLikelihood(),
                  table);
  }
  RobustLogLikelihood l;
  const double float_denormal = std::numeric_limits<float>::denorm_min();
  for (const double observed : {float_denormal, 1.0, 1e30}) {
    AddLikelihood("E = 0", 0.0, observed, l, table);
    for (const double epsilon : {0.0, 1e-6}) {
      l.epsilon = epsilon;
      AddLikelihood("E a denormal float", float_denormal, observed, l, table);
      AddLikelihood("E = 1e30", 1e30, observed, l, table);
    }
  }
}

// Rows of a Jacobian [rows][columns].
void AddRows(const std::string& name, const std::string& kind,
             const std::string& where, const std::vector<double>& J,
             const std::vector<Real>& exact, size_t columns,
             ErrorTable* table) {
  for (size_t r = 0; r < J.size() / columns; ++r) {
    const auto begin = static_cast<std::ptrdiff_t>(r * columns);
    const auto end = begin + static_cast<std::ptrdiff_t>(columns);
    table->Add(name, kind, where + ", row " + std::to_string(r),
               {J.begin() + begin, J.begin() + end},
               {exact.begin() + begin, exact.begin() + end});
  }
}

std::vector<double> JacobianOf(const ceres::CostFunction& cost,
                               const std::vector<double>& x,
                               std::vector<double>* residuals) {
  residuals->resize(cost.num_residuals());
  std::vector<double> J(residuals->size() * x.size());
  const double* block[] = {x.data()};
  double* jacobians[] = {J.data()};
  CHECK(cost.Evaluate(block, residuals->data(), jacobians));
  return J;
}

// Where the wall begins, wall * max(0, |z| - 1).
void AddWall(const std::vector<double>& x, size_t first, int size, Real wall,
             Real* row, Real* residual) {
  Real square = 0;
  for (int d = 0; d < size; ++d) square += Real(x[first + d]) * x[first + d];
  const Real norm = std::sqrt(square);
  *residual = norm > 1 ? wall * (norm - 1) : 0;
  for (int d = 0; d < size && norm > 1; ++d) {
    row[first + d] = wall * x[first + d] / norm;
  }
}

// A prior's residuals and their Jacobian [residuals][parameters].
struct ExactPrior {
  ExactPrior(size_t residuals, size_t parameters)
      : values(residuals, 0), J(residuals * parameters, 0) {}
  std::vector<Real> values, J;
};

ExactPrior ExactBallPrior(const LobePrior& prior, const LobeLayout& layout,
                          const std::vector<double>& x) {
  const int size = layout.code_size;
  const size_t n = x.size(), rows = layout.lobe_size() + 1;  // of a lobe
  ExactPrior exact(layout.num_lobes * rows, n);
  for (int k = 0; k < layout.num_lobes; ++k) {
    const size_t first = layout.code(k), row = k * rows;
    for (int d = 0; d < size; ++d) {
      exact.J[(row + d) * n + first + d] = 1 / Real(prior.sigma);
      exact.values[row + d] = x[first + d] / Real(prior.sigma);
    }
    AddWall(x, first, size, prior.wall, &exact.J[(row + size) * n],
            &exact.values[row + size]);
    for (int c = 0; c < 3; ++c) {
      const size_t at = row + size + 1 + c, colour = layout.log_colour(k) + c;
      exact.J[at * n + colour] = 1 / Real(prior.colour_sigma);
      exact.values[at] =
          (x[colour] - Real(prior.colour_mean[c])) / Real(prior.colour_sigma);
    }
  }
  return exact;
}

using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

// precision_root: factor^-1.
ExactPrior ExactJointPrior(const MaterialPrior& prior,
                           const RealMatrix& precision_root,
                           const std::vector<double>& x) {
  const LobeLayout layout = prior.layout();
  const size_t n = x.size();
  ExactPrior exact(n + layout.num_lobes, n);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      exact.J[i * n + j] = precision_root(i, j);
      exact.values[i] += precision_root(i, j) * (x[j] - Real(prior.mean[j]));
    }
  }
  for (int k = 0; k < layout.num_lobes; ++k) {
    AddWall(x, layout.code(k), layout.code_size, prior.wall,
            &exact.J[(n + k) * n], &exact.values[n + k]);
  }
  return exact;
}

// The rows of the Jacobian, and the gradient of half the squares.
void AddPrior(const std::string& name, const std::string& kind,
              const ceres::CostFunction& cost, const std::vector<double>& x,
              const ExactPrior& exact, ErrorTable* table) {
  const size_t n = x.size();
  const std::string where = Coordinates(x, 4);
  std::vector<double> r;
  const std::vector<double> J = JacobianOf(cost, x, &r);
  AddRows(name, kind, where, J, exact.J, n, table);
  std::vector<double> gradient(n, 0.0);
  std::vector<Real> right(n, 0);
  for (size_t i = 0; i < r.size(); ++i) {
    for (size_t j = 0; j < n; ++j) {
      gradient[j] += r[i] * J[i * n + j];
      right[j] += exact.values[i] * exact.J[i * n + j];
    }
  }
  table->Add(name + ", gradient", kind, where, gradient, right);
}

// Random parameters whose codes have this norm; a negative one leaves them as
// they are drawn.
std::vector<double> RandomLobes(const LobeLayout& layout, double norm,
                                std::mt19937_64* rng) {
  std::normal_distribution<double> normal;
  std::vector<double> x(layout.num_parameters());
  for (double& v : x) v = normal(*rng);
  for (int k = 0; k < layout.num_lobes && norm >= 0.0; ++k) {
    double* const code = &x[layout.code(k)];
    double square = 0.0;
    for (int d = 0; d < layout.code_size; ++d) square += code[d] * code[d];
    for (int d = 0; d < layout.code_size; ++d) {
      code[d] *= norm / std::sqrt(square);
    }
  }
  return x;
}

void StudyLobePriors(int count, std::mt19937_64* rng, ErrorTable* table) {
  const NeuralBrdfModel model = TinyModel(8);
  const LobeLayout layout = {2, model.shape.code_size()};
  LobePrior ball;
  for (double& m : ball.colour_mean) m = 4.0;
  const LobePriorCost ball_cost(layout, ball);
  const MaterialPrior joint = JointMaterialPrior(model, layout.num_lobes, 0.5);
  const MaterialPriorCost joint_cost(&joint);
  const Eigen::Index n = joint.num_parameters();
  const RealMatrix precision_root =
      joint.factor.cast<Real>().triangularView<Eigen::Lower>().solve(
          RealMatrix::Identity(n, n));
  for (int i = 0; i < count; ++i) {
    for (const double norm :
         {-1.0, 0.0, 1 - 1e-9, 1.0, 1 + 1e-9, 1 + 1e-3, 3.0, 10.0}) {
      const std::vector<double> x = RandomLobes(layout, norm, rng);
      char kind[32] = "random";
      if (norm >= 0.0) {
        std::snprintf(kind, sizeof(kind), "codes of norm %.10g", norm);
      }
      AddPrior("ball prior", kind, ball_cost, x,
               ExactBallPrior(ball, layout, x), table);
      AddPrior("materials' prior", kind, joint_cost, x,
               ExactJointPrior(joint, precision_root, x), table);
    }
  }
}

void StudyWeightPrior(std::mt19937_64* rng, ErrorTable* table) {
  std::normal_distribution<double> normal;
  std::vector<float> mean(20), std(20);
  std::vector<double> x(20);
  std::vector<Real> exact(400, 0);
  for (size_t i = 0; i < x.size(); ++i) {
    mean[i] = static_cast<float>(normal(*rng));
    std[i] = static_cast<float>(std::exp(normal(*rng)));
    x[i] = normal(*rng);
    exact[i * 21] = 1 / (Real(0.7) * std[i]);
  }
  std::vector<double> r;
  const WeightPriorCost weights(mean, std, 0.7);
  AddRows("weights' prior", "random", "", JacobianOf(weights, x, &r), exact, 20,
          table);
}

// Quadratic: its central differences are exact whatever the step.
void StudyProcessPrior(std::mt19937_64* rng, ErrorTable* table) {
  constexpr int kHeight = 8, kWidth = 16;
  constexpr float kStep = 0.5f;
  ProcessPrior prior(kHeight, kWidth, LightProcess(), {0.25}, 0.4);
  std::normal_distribution<float> normal;
  for (const float scale : {1.0f, 1e-3f, 60.0f}) {
    LogMap map({kWidth, kHeight}), gradient(map.size());
    // Steps of 1/1024, so that sums with kStep are exact.
    const size_t values = map.values().size();
    for (size_t i = 0; i < values; ++i) {
      map.data()[i] = std::round(1024 * scale * normal(*rng)) / 1024;
    }
    prior.Evaluate(map, &gradient);
    std::vector<Real> exact;
    for (size_t i = 0; i < values; ++i) {
      float& v = map.data()[i];
      const float middle = v;
      v = middle + kStep;
      const Real up = prior.Evaluate(map, nullptr);
      v = middle - kStep;
      exact.push_back((up - prior.Evaluate(map, nullptr)) / (2 * kStep));
      v = middle;
    }
    table->Add("process prior by log radiance",
               "log radiance x " + Coordinates({scale}), "",
               ToDoubles(gradient.values()), exact);
  }
}

}  // namespace

void StudyCosts(const StudyOptions& options, ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  StudyLikelihood(5 * options.points, &rng, table);
  StudyLobePriors(std::max(options.points / 10, 2), &rng, table);
  StudyWeightPrior(&rng, table);
  StudyProcessPrior(&rng, table);
}

}  // namespace derivatives
}  // namespace ibrdf

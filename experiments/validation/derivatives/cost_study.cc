// The robust likelihood by radiance, and the priors.
#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
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

void StudyPriors(int count, std::mt19937_64* rng, ErrorTable* table) {
  const NeuralBrdfModel model = TinyModel(8);
  const int lobes = 2, size = model.shape.code_size();
  const size_t lobe_size = size + 3, n = lobes * lobe_size;
  const MaterialPrior joint = JointMaterialPrior(model, lobes, 0.5);
  LobePrior ball;
  for (double& m : ball.colour_mean) m = 4.0;
  const LobePriorCost ball_cost({lobes, size}, ball);
  const MaterialPriorCost joint_cost(&joint);
  using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  const RealMatrix precision_root =
      joint.factor.cast<Real>().triangularView<Eigen::Lower>().solve(
          RealMatrix::Identity(n, n));
  std::normal_distribution<double> normal;

  const auto add = [&](const std::string& kind, const std::vector<double>& x) {
    const std::string where = Coordinates(x, 4);
    std::vector<double> r;
    std::vector<double> J = JacobianOf(ball_cost, x, &r);
    std::vector<Real> exact(J.size(), 0), values(r.size());
    for (int k = 0; k < lobes; ++k) {
      const size_t first = k * lobe_size, row = k * (lobe_size + 1);
      for (int d = 0; d < size; ++d) {
        exact[(row + d) * n + first + d] = 1 / Real(ball.sigma);
        values[row + d] = x[first + d] / Real(ball.sigma);
      }
      AddWall(x, first, size, ball.wall, &exact[(row + size) * n],
              &values[row + size]);
      for (int c = 0; c < 3; ++c) {
        const size_t at = row + size + 1 + c;
        exact[at * n + first + size + c] = 1 / Real(ball.colour_sigma);
        values[at] = (x[first + size + c] - Real(4)) / Real(ball.colour_sigma);
      }
    }
    const auto add_gradient = [&](const std::string& name) {
      std::vector<double> g(n, 0.0);
      std::vector<Real> right(n, 0);
      for (size_t i = 0; i < r.size(); ++i) {
        for (size_t j = 0; j < n; ++j) {
          g[j] += r[i] * J[i * n + j];
          right[j] += values[i] * exact[i * n + j];
        }
      }
      table->Add(name + ", gradient", kind, where, g, right);
    };
    AddRows("ball prior", kind, where, J, exact, n, table);
    add_gradient("ball prior");

    J = JacobianOf(joint_cost, x, &r);
    exact.assign(J.size(), 0);
    values.assign(r.size(), 0);
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j < n; ++j) {
        exact[i * n + j] = precision_root(i, j);
        values[i] += precision_root(i, j) * (x[j] - Real(joint.mean[j]));
      }
    }
    for (int k = 0; k < lobes; ++k) {
      AddWall(x, k * lobe_size, size, joint.wall, &exact[(n + k) * n],
              &values[n + k]);
    }
    AddRows("materials' prior", kind, where, J, exact, n, table);
    add_gradient("materials' prior");
  };
  for (int i = 0; i < count; ++i) {
    for (const double norm :
         {-1.0, 0.0, 1 - 1e-9, 1.0, 1 + 1e-9, 1 + 1e-3, 3.0, 10.0}) {
      std::vector<double> x(n);
      for (double& v : x) v = normal(*rng);
      for (size_t k = 0; k < lobes && norm >= 0.0; ++k) {
        double square = 0.0;
        for (int d = 0; d < size; ++d) {
          square += x[k * lobe_size + d] * x[k * lobe_size + d];
        }
        for (int d = 0; d < size; ++d) {
          x[k * lobe_size + d] *= norm / std::sqrt(square);
        }
      }
      char kind[32];
      std::snprintf(kind, sizeof(kind), "codes of norm %.10g", norm);
      add(norm < 0.0 ? "random" : kind, x);
    }
  }

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
  StudyPriors(std::max(options.points / 10, 2), &rng, table);
  StudyProcessPrior(&rng, table);
}

}  // namespace derivatives
}  // namespace ibrdf

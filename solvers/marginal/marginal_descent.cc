#include "ibrdf/solvers/marginal/marginal_descent.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <utility>

#include "ibrdf/solvers/optim/line_search.h"

namespace ibrdf {
namespace {

// A step must bring this share of the gain that the slope promises.
constexpr double kSufficientGain = 1e-3;
constexpr double kSmallestStep = 1e-3;
// A gain below options.least_gain is the end of a descent only where the slope
// promises no more than so many times that: in a curved valley steps are short.
constexpr double kPromise = 10.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Newton's direction by the information, or downhill where there is none.
Eigen::VectorXd Direction(const MarginalObjective& objective,
                          const std::vector<double>& y,
                          const Eigen::VectorXd& gradient) {
  const Eigen::MatrixXd information = objective.Information(y.data());
  if (information.size() > 0) {
    const Eigen::LLT<Eigen::MatrixXd> llt(information);
    if (llt.info() == Eigen::Success) return -llt.solve(gradient);
  }
  return -gradient / std::max(1.0, gradient.norm());
}

}  // namespace

MarginalDescent Descend(const MarginalObjective& objective,
                        const MarginalDescentOptions& options,
                        std::vector<double>* y) {
  CHECK(options.max_iterations >= 0 && options.least_gain >= 0.0);
  MarginalDescent descent;
  const auto n = static_cast<Eigen::Index>(y->size());
  Eigen::VectorXd gradient(n);
  descent.ok = objective.Evaluate(y->data(), &descent.cost, gradient.data());
  if (!descent.ok) return descent;
  double longest = 1.0;
  int small_gains = 0;
  while (descent.iterations < options.max_iterations && small_gains < 2) {
    if (options.should_stop && options.should_stop()) break;
    const Eigen::VectorXd direction = Direction(objective, *y, gradient);
    const double slope = -gradient.dot(direction);
    if (!(slope > 0.0)) break;
    std::vector<double> next(n);
    double cost = 0.0;
    const double step =
        LineSearch(longest, kSmallestStep, slope, [&](double length) {
          Eigen::Map<Eigen::VectorXd>(next.data(), n) =
              Eigen::Map<const Eigen::VectorXd>(y->data(), n) +
              length * direction;
          LineSearchTrial trial;
          const bool ok = objective.Evaluate(next.data(), &cost, nullptr);
          trial.gain = ok ? descent.cost - cost : -kInfinity;
          trial.accepted = trial.gain >= kSufficientGain * length * slope;
          return trial;
        });
    if (step == 0.0) break;
    const double before = descent.cost;
    Eigen::VectorXd at_next(n);
    if (!objective.Evaluate(next.data(), &cost, at_next.data())) break;
    *y = std::move(next);
    gradient = std::move(at_next);
    descent.cost = cost;
    ++descent.iterations;
    longest = std::min(1.0, 2.0 * step);
    const bool settled = before - cost < options.least_gain &&
                         0.5 * slope < kPromise * options.least_gain;
    small_gains = settled ? small_gains + 1 : 0;
  }
  return descent;
}

}  // namespace ibrdf

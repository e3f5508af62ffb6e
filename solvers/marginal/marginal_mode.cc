// The search for the most probable light: Newton's method, whose steps are
// found by conjugate gradients in the space of representers, preconditioned by
// the normal equations.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "ibrdf/solvers/marginal/marginal_likelihood.h"
#include "ibrdf/solvers/optim/line_search.h"

namespace ibrdf {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kSmallestStepLength = 1e-4;
constexpr double kLongestStep = 6.0;
// After so many steps of Newton's method they are damped.
constexpr int kUndampedIterations = 20;
constexpr double kMostDamping = 1e6, kLeastDamping = 0.1;
// A step must bring this share of the gain that its quadratic model promises.
constexpr double kPromisedShare = 0.1;
// What rounding hides of the cost, of its size: a step that promises less
// cannot be tested.
constexpr double kRounding = 1e-14;
// Conjugate gradients with the Hessian: steps, and the square of the error,
// relative, in the Hessian's norm, for Newton's steps.
constexpr int kMaxHessianSteps = 30;
constexpr double kNewtonTolerance = 1e-3;
// A linearisation is made anew where log radiance has moved so far since, or
// less and conjugate gradients take more than so many steps.
constexpr double kFar = 1.0, kFarIfSlow = 0.1;
constexpr int kSlow = 15;

// Levenberg and Marquardt's, by the share of the last step that was taken and
// the largest change of log radiance that it proposed.
double NextDamping(double damping, double taken, double longest) {
  if (taken < 0.5) {
    return std::max({1.0, 4.0 * damping, longest / kLongestStep});
  }
  if (taken < 1.0) return damping;
  return damping < kLeastDamping ? 0.0 : 0.25 * damping;
}

}  // namespace

Eigen::VectorXd MarginalLikelihood::LightJacobianTimes(
    const Given& given, const Point& point, const Eigen::VectorXd& v) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  const Eigen::VectorXd dL = point.L.cwiseProduct(v.head(3 * n));
  Eigen::VectorXd out(3 * P);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * P, P) =
        MultiplyVector(given.matrices[c], dL.segment(c * n, n));
  }
  return out.cwiseQuotient(point.unpainted);
}

Eigen::VectorXd MarginalLikelihood::LightJacobianTransposedTimes(
    const Given& given, const Point& point, const Eigen::VectorXd& a) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  const Eigen::VectorXd dL_o = a.cwiseQuotient(point.unpainted);
  Eigen::VectorXd out(3 * n);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * n, n) =
        MultiplyTransposedVector(given.matrices[c], dL_o.segment(c * P, P));
  }
  return out.cwiseProduct(point.L);
}

// H = K^-1 + J^T W J + C; C is the light's alone, J_l its part of J:
// C = -sum_p slope_p (diag(J_l,p) - J_l,p J_l,p^T).
Eigen::VectorXd MarginalLikelihood::HessianTimes(
    const Given& given, const Point& point, const DataTerm& data,
    const Eigen::VectorXd& curvature, const Eigen::VectorXd& representers,
    const Eigen::VectorXd& p) const {
  const Eigen::Index sources = Eigen::Index{3} * num_sources();
  Eigen::VectorXd out = representers;
  const Eigen::VectorXd of_light = LightJacobianTimes(given, point, p);
  Eigen::VectorXd by_light =
      (data.curvature + data.slope).cwiseProduct(of_light);
  if (has_paint()) {
    const Eigen::VectorXd of_paint = given.matte_share.cwiseProduct(PaintOf(p));
    by_light += data.curvature.cwiseProduct(of_paint);
    out.tail(y_.size()) += given.matte_share.cwiseProduct(
        data.curvature.cwiseProduct(of_light + of_paint));
  }
  out.head(sources) -= curvature.cwiseProduct(p.head(sources));
  out.head(sources) += LightJacobianTransposedTimes(given, point, by_light);
  return out;
}

// Vectors come in pairs: x and, where x = K x', its representers x'.
Eigen::VectorXd MarginalLikelihood::SolveHessian(
    const Given& given, const Point& point, const DataTerm& data,
    const Linearisation& linear, double tolerance, const Eigen::VectorXd& x,
    int* iterations) const {
  const Eigen::VectorXd curvature =
      LightJacobianTransposedTimes(given, point, data.slope);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(x.size()), rest = x, p_representers,
                  p;
  double rho = 0.0, first_rho = 0.0;
  for (int k = 0; k < kMaxHessianSteps; ++k) {
    if (iterations != nullptr) *iterations = k + 1;
    const Eigen::VectorXd z_representers =
        SolveRepresenters(linear, given.light, rest);
    const Eigen::VectorXd z = ApplyCovariance(given.light, z_representers);
    const double next_rho = rest.dot(z);
    if (k == 0) first_rho = next_rho;
    if (!(next_rho > tolerance * first_rho)) break;
    const double beta = k == 0 ? 0.0 : next_rho / rho;
    p_representers =
        k == 0 ? z_representers
               : Eigen::VectorXd(z_representers + beta * p_representers);
    p = k == 0 ? z : Eigen::VectorXd(z + beta * p);
    rho = next_rho;
    const Eigen::VectorXd Hp =
        HessianTimes(given, point, data, curvature, p_representers, p) +
        linear.damping * p_representers;
    const double square = p.dot(Hp);
    if (!(square > 0.0)) {
      // Not convex here: the preconditioner's direction descends all the same.
      if (k == 0) w = z_representers;
      break;
    }
    w += rho / square * p_representers;
    rest -= rho / square * Hp;
  }
  return w;
}

MarginalLikelihood::Point MarginalLikelihood::FirstPoint(
    const Given& given, LightMode* mode) const {
  if (mode->l.size() == 0) {
    mode->level = LevelFor(given.matrices);
    mode->l = mode->representers = Eigen::VectorXd::Zero(num_latents());
  } else {
    mode->l = ApplyCovariance(given.light, mode->representers);
  }
  return At(given, mode->level, mode->l);
}

// The step's quadratic model of the cost promises `promise` / 2.
MarginalLikelihood::NewtonStep MarginalLikelihood::FindNewtonStep(
    const Given& given, const Linearisation& linear, const Point& point,
    const DataTerm& data, const LightMode& mode) const {
  Eigen::VectorXd slope = mode.representers;
  slope.head(Eigen::Index{3} * num_sources()) -=
      LightJacobianTransposedTimes(given, point, data.slope);
  if (has_paint()) {
    slope.tail(y_.size()) -= given.matte_share.cwiseProduct(data.slope);
  }
  NewtonStep step;
  step.representers = -SolveHessian(given, point, data, linear,
                                    kNewtonTolerance, slope, &step.iterations);
  step.l = ApplyCovariance(given.light, step.representers);
  step.promise = -slope.dot(step.l);
  return step;
}

double MarginalLikelihood::TakeStep(const Given& given, const NewtonStep& step,
                                    bool near_enough, Point* point,
                                    DataTerm* data, LightMode* mode) const {
  if (!(step.promise > 0.0)) return 0.0;
  const double cross = mode->representers.dot(step.l),
               square = step.representers.dot(step.l);
  const double size =
      std::abs(data->cost) + 0.5 * std::abs(mode->representers.dot(mode->l));
  const bool hidden = !near_enough && step.promise < kRounding * size;
  const auto try_step = [&](double s) {
    const Eigen::VectorXd l = mode->l + s * step.l;
    Point trial = At(given, mode->level, l);
    DataTerm trial_data = DataAt(given, trial);
    const double gain =
        data->cost - trial_data.cost - s * cross - 0.5 * s * s * square;
    const bool accepted =
        trial.Valid() &&
        (hidden || gain >= kPromisedShare * s * (1.0 - 0.5 * s) * step.promise);
    if (accepted) {
      mode->representers += s * step.representers;
      mode->l = l;
      *point = std::move(trial);
      *data = std::move(trial_data);
    }
    return LineSearchTrial{gain, accepted};
  };
  // From a wide start the whole step may leave the range of exp.
  const double longest =
      std::min(1.0, kLongestStep / step.l.lpNorm<Eigen::Infinity>());
  return LineSearch(longest, kSmallestStepLength, step.promise, try_step);
}

bool MarginalLikelihood::FindMode(const Given& given, double tolerance,
                                  Point* point, DataTerm* data,
                                  LightMode* mode) const {
  std::unique_ptr<const Linearisation> linear;
  double damping = 0.0, moved = 0.0;
  for (int k = 0; k < kMaxIterations; ++k) {
    if (linear == nullptr) {
      linear = LineariseRoughly(given, *point, *data, damping);
      if (linear == nullptr) return false;
    }
    const NewtonStep step =
        FindNewtonStep(given, *linear, *point, *data, *mode);
    if (!step.l.allFinite()) return false;
    const bool near_enough = 0.5 * (1.0 + damping) * step.promise < tolerance;
    const double taken = TakeStep(given, step, near_enough, point, data, mode);
    if (near_enough) break;
    const double longest = step.l.lpNorm<Eigen::Infinity>();
    if (k >= kUndampedIterations || taken == 0.0 || damping > 0.0) {
      damping = NextDamping(damping, taken, longest);
      if (damping > kMostDamping) break;
    }
    // Far from where it was made a linearisation is a poor preconditioner. To
    // make one takes as long as some 30 steps of conjugate gradients.
    moved += taken * longest;
    if (damping != linear->damping || moved > kFar ||
        (moved > kFarIfSlow && step.iterations > kSlow)) {
      linear = nullptr;
      moved = 0.0;
    }
  }
  return true;
}

// With the representers held log L_o moves by d, and where A is the same they
// move by -J^T A^-1 d.
void MarginalLikelihood::Predict(const Given& given, const Expansion& near,
                                 Point* point, DataTerm* data,
                                 LightMode* mode) const {
  const Linearisation& linear = *near.linear;
  Eigen::VectorXd a =
      linear.row_scale.cwiseProduct(point->log_L_o - near.point.log_L_o);
  SolveFactored(linear.factor, a.data());
  LightMode moved = *mode;
  moved.representers -=
      ApplyJacobianTransposed(linear, linear.row_scale.cwiseProduct(a));
  moved.l = ApplyCovariance(given.light, moved.representers);
  Point at = At(given, moved.level, moved.l);
  if (!at.Valid()) return;
  DataTerm data_there = DataAt(given, at);
  if (!(CostOf(data_there, moved) < CostOf(*data, *mode))) return;
  *mode = std::move(moved);
  *point = std::move(at);
  *data = std::move(data_there);
}

bool MarginalLikelihood::FindLight(const Given& given,
                                   const LightHyperparameters& hyperparameters,
                                   double tolerance, const Expansion* near,
                                   Point* point, DataTerm* data,
                                   LightMode* mode) const {
  if (!given.weight.allFinite() || !std::isfinite(given.light.amplitude) ||
      !Roughness(map_height_, hyperparameters).cwiseAbs2().allFinite()) {
    return false;
  }
  *point = FirstPoint(given, mode);
  // Nothing but black: no light explains an image of it.
  if (!point->Valid()) return false;
  *data = DataAt(given, *point);
  if (near != nullptr) Predict(given, *near, point, data, mode);
  return FindMode(given, tolerance, point, data, mode);
}

}  // namespace ibrdf

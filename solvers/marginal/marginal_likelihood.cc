#include "ibrdf/solvers/marginal/marginal_likelihood.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/costs/interval_likelihood.h"
#include "ibrdf/solvers/optim/line_search.h"

namespace ibrdf {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kSmallestStepLength = 1e-4;
constexpr double kLongestStep = 6.0;
// A step must bring this share of the gain that its quadratic model promises.
constexpr double kPromisedShare = 0.1;
constexpr double kSmallestRadiance = 1e-200;
// Conjugate gradients with the Hessian: steps, and the square of the error,
// relative, in the Hessian's norm, for Newton's steps.
constexpr int kMaxHessianSteps = 30;
constexpr double kNewtonTolerance = 1e-3;
// Deviations that FindNoise begins with, log radiance.
constexpr double kFirstSigma = 0.15;

}  // namespace

MarginalLikelihood::MarginalLikelihood(LogRadianceData data,
                                       const LightProcess& process,
                                       int map_height, int map_width,
                                       int num_directional_lights,
                                       int num_threads)
    : num_points_(static_cast<int>(data.value.size() / 3)),
      y_(ToEigen(data.value)),
      low_(ToEigen(data.low)),
      high_(ToEigen(data.high)),
      local_(process.Local()),
      level_(process.Level()),
      directional_light_(process.DirectionalLight()),
      spectrum_(map_height, map_width, process),
      roughness_weights_(RoughnessWeights(map_height)),
      horizon_(
          ByTexel(std::sqrt(process.horizon_share) * HorizonStep(map_height),
                  map_width)),
      map_height_(map_height),
      map_width_(map_width),
      num_directional_lights_(num_directional_lights),
      smooth_share_(process.smooth_share),
      rough_share_(process.rough_share),
      texel_variance_(process.VarianceWithin(180.0 / map_height)),
      num_threads_(num_threads) {
  CHECK_GT(num_points_, 0);
  CHECK_EQ(y_.size() % 3, 0);
  CHECK(low_.size() == high_.size());
  CHECK(low_.size() == 0 || low_.size() == y_.size());
}

MarginalLikelihood::Light MarginalLikelihood::LightAt(
    const LightHyperparameters& hyperparameters) const {
  return {std::exp(hyperparameters.log_amplitude),
          spectrum_.At(hyperparameters), spectrum_.RoughAt(hyperparameters)};
}

MarginalLikelihood::Given MarginalLikelihood::GivenBy(
    const std::array<RowMatrix, 3>& matrices, const Eigen::VectorXd& noise,
    const LightHyperparameters& hyperparameters) const {
  return {matrices, noise, noise.cwiseInverse(), LightAt(hyperparameters)};
}

double MarginalLikelihood::LevelFor(
    const std::array<RowMatrix, 3>& matrices) const {
  double sum = y_.sum();
  for (const RowMatrix& T : matrices) {
    for (Eigen::Index p = 0; p < T.rows(); ++p) {
      sum -= std::log(std::max(T.row(p).head(num_texels()).sum(), 1e-300));
    }
  }
  return sum / static_cast<double>(y_.size());
}

Eigen::VectorXd MarginalLikelihood::NoiseVariance(
    const std::array<RowMatrix, 3>& matrices, double sigma,
    const LightMode& mode) const {
  const Eigen::Index t = num_texels(), n = num_sources(), P = num_points_;
  const Point point = At(matrices, mode.level, mode.l);
  Eigen::VectorXd noise(3 * P);
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd power =
        texel_variance_ * point.L.segment(c * n, t).cwiseAbs2();
    for (Eigen::Index p = 0; p < P; ++p) {
      const double* T = matrices[c].row(p).data();
      double sum = 0.0;
      const auto add = [&](int a, int b) {
        const double difference = T[a] - T[b];
        sum += difference * difference * (power[a] + power[b]);
      };
      for (int r = 0; r < map_height_; ++r) {
        const int row = r * map_width_;
        for (int x = 0; x < map_width_; ++x) {
          add(row + x, row + (x + 1) % map_width_);
          if (r + 1 < map_height_) add(row + x, row + map_width_ + x);
        }
      }
      const double L_o = point.L_o[c * P + p];
      noise[c * P + p] = sigma * sigma + 0.125 * sum / (L_o * L_o);
    }
  }
  return noise;
}

Eigen::VectorXd MarginalLikelihood::FindNoise(
    const std::array<RowMatrix, 3>& matrices, double sigma,
    const LightHyperparameters& hyperparameters, double tolerance,
    LightMode* mode) const {
  const Eigen::VectorXd first =
      Eigen::VectorXd::Constant(y_.size(), kFirstSigma * kFirstSigma);
  Evaluate(matrices, first, hyperparameters, tolerance, mode, nullptr);
  return NoiseVariance(matrices, sigma, *mode);
}

Eigen::VectorXd MarginalLikelihood::ApplyLocal(const Light& light,
                                               const Eigen::VectorXd& g) const {
  const Eigen::Index t = num_texels(), n = num_sources();
  RowMatrix correlated;
  light.correlation.Multiply(
      Eigen::Map<const RowMatrix>(g.data(), 3, n).leftCols(t), &correlated);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(g.size());
  Eigen::Map<RowMatrix>(out.data(), 3, n).leftCols(t).noalias() =
      light.amplitude * local_ * correlated;
  return out;
}

Eigen::VectorXd MarginalLikelihood::ApplyHorizon(
    const Eigen::VectorXd& g) const {
  const Eigen::Index t = num_texels(), n = num_sources();
  const Eigen::Vector3d steps =
      Eigen::Map<const RowMatrix>(g.data(), 3, n).leftCols(t) * horizon_;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(g.size());
  Eigen::Map<RowMatrix>(out.data(), 3, n).leftCols(t).noalias() =
      local_ * steps * horizon_.transpose();
  return out;
}

Eigen::VectorXd MarginalLikelihood::ApplyCovariance(
    const Light& light, const Eigen::VectorXd& g) const {
  const Eigen::Index n = num_sources();
  Eigen::VectorXd out = ApplyLocal(light, g);
  const Eigen::Map<const RowMatrix> in(g.data(), 3, n);
  Eigen::Map<RowMatrix> by_channel(out.data(), 3, n);
  by_channel.rightCols(num_directional_lights_) +=
      directional_light_ * in.rightCols(num_directional_lights_);
  by_channel.colwise() += level_ * in.rowwise().sum();
  return out;
}

MarginalLikelihood::Point MarginalLikelihood::At(
    const std::array<RowMatrix, 3>& matrices, double level,
    const Eigen::VectorXd& l) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  Point point;
  point.L = (l.array() + level).min(kMaxLogRadianceInDouble).exp();
  point.L_o.resize(3 * P);
  for (int c = 0; c < 3; ++c) {
    point.L_o.segment(c * P, P) =
        MultiplyVector(matrices[c], point.L.segment(c * n, n));
  }
  point.L_o = point.L_o.cwiseMax(kSmallestRadiance);
  point.residual = y_ - point.L_o.array().log().matrix();
  for (Eigen::Index p = 0; p < low_.size(); ++p) {
    if (low_[p] == high_[p]) continue;
    const double log_L_o = std::log(point.L_o[p]);
    point.residual[p] = std::clamp(log_L_o, low_[p], high_[p]) - log_L_o;
  }
  return point;
}

MarginalLikelihood::DataTerm MarginalLikelihood::DataAt(
    const Given& given, const Point& point) const {
  DataTerm data;
  data.slope = given.weight.cwiseProduct(point.residual);
  data.curvature = given.weight;
  if (low_.size() == 0) {
    data.cost = 0.5 * point.residual.cwiseAbs2().dot(given.weight);
    return data;
  }
  data.curvature_slope = Eigen::VectorXd::Zero(low_.size());
  for (Eigen::Index p = 0; p < low_.size(); ++p) {
    if (low_[p] == high_[p]) {
      data.cost += 0.5 * point.residual[p] * data.slope[p];
      continue;
    }
    const IntervalLikelihood of = EvaluateInterval(
        low_[p], high_[p], std::log(point.L_o[p]), std::sqrt(given.noise[p]));
    data.cost += of.cost;
    data.slope[p] = of.slope;
    data.curvature[p] = of.curvature;
    data.curvature_slope[p] = of.third;
  }
  return data;
}

std::unique_ptr<const MarginalLikelihood::Linearisation>
MarginalLikelihood::Linearise(const Given& given, const Point& point,
                              const DataTerm& data) const {
  const Light& light = given.light;
  const Eigen::Index t = num_texels(), n = num_sources(), P = num_points_;
  auto linear = std::make_unique<Linearisation>();
  ParallelFor(3, num_threads_, [&](int64_t c, int) {
    linear->jacobian[c] =
        point.L_o.segment(c * P, P).cwiseInverse().asDiagonal() *
        given.matrices[c] * point.L.segment(c * n, n).asDiagonal();
    light.correlation.Multiply(linear->jacobian[c].leftCols(t), &linear->JC[c]);
  });
  linear->row_scale = Eigen::VectorXd::Ones(3 * P);
  linear->diagonal = given.noise;
  for (Eigen::Index p = 0; p < low_.size(); ++p) {
    if (low_[p] == high_[p]) continue;
    linear->row_scale[p] = std::sqrt(data.curvature[p]);
    linear->diagonal[p] = 1.0;
  }
  RowMatrix& A = linear->factor;
  A.setZero(3 * P, 3 * P);
  constexpr int kPairs[6][2] = {{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}};
  ParallelFor(6, num_threads_, [&](int64_t pair, int) {
    const int c = kPairs[pair][0], d = kPairs[pair][1];
    RowMatrix block;
    MultiplyTransposed(linear->JC[c], linear->jacobian[d].leftCols(t), &block);
    // The rows of a Jacobian sum to 1: a level moves log radiance as it is.
    block = (light.amplitude * local_(c, d) * block +
             DirectionalLightBlock(*linear, c, d))
                .array() +
            level_(c, d);
    ScaleBlock(*linear, c, d, &block);
    A.block(c * P, d * P, P, P) = block;
  });
  A.diagonal() += linear->diagonal;
  if (!A.allFinite() || !Factorise(&A)) return nullptr;
  return linear;
}

void MarginalLikelihood::ScaleBlock(const Linearisation& linear, int c, int d,
                                    RowMatrix* block) {
  const Eigen::Index P = block->rows();
  const auto rows = linear.row_scale.segment(c * P, P);
  const auto columns = linear.row_scale.segment(d * P, P);
  for (Eigen::Index p = 0; p < P; ++p) {
    block->row(p).array() *= rows[p] * columns.transpose().array();
  }
}

RowMatrix MarginalLikelihood::DirectionalLightBlock(const Linearisation& linear,
                                                    int c, int d) const {
  return directional_light_(c, d) *
         linear.jacobian[c].rightCols(num_directional_lights_) *
         linear.jacobian[d].rightCols(num_directional_lights_).transpose();
}

RowMatrix MarginalLikelihood::UnscaledBlock(const Linearisation& linear, int c,
                                            int d) const {
  const auto step = [&](int channel) -> Eigen::VectorXd {
    return linear.jacobian[channel].leftCols(num_texels()) * horizon_;
  };
  RowMatrix block = DirectionalLightBlock(linear, c, d);
  block.noalias() += local_(c, d) * step(c) * step(d).transpose();
  // The rows of a Jacobian sum to 1: a level moves log radiance as it is.
  return block.array() + level_(c, d);
}

Eigen::VectorXd MarginalLikelihood::ApplyJacobian(
    const Linearisation& linear, const Eigen::VectorXd& l) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  Eigen::VectorXd out(3 * P);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * P, P) =
        MultiplyVector(linear.jacobian[c], l.segment(c * n, n));
  }
  return out;
}

Eigen::VectorXd MarginalLikelihood::ApplyJacobianTransposed(
    const Linearisation& linear, const Eigen::VectorXd& a) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  Eigen::VectorXd out(3 * n);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * n, n) =
        MultiplyTransposedVector(linear.jacobian[c], a.segment(c * P, P));
  }
  return out;
}

Eigen::VectorXd MarginalLikelihood::SolveRepresenters(
    const Linearisation& linear, const Light& light,
    const Eigen::VectorXd& x) const {
  Eigen::VectorXd a = linear.row_scale.cwiseProduct(
      ApplyJacobian(linear, ApplyCovariance(light, x)));
  SolveFactored(linear.factor, a.data());
  return x - ApplyJacobianTransposed(linear, linear.row_scale.cwiseProduct(a));
}

Eigen::VectorXd MarginalLikelihood::JacobianTimes(
    const Given& given, const Point& point, const Eigen::VectorXd& v) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  const Eigen::VectorXd dL = point.L.cwiseProduct(v);
  Eigen::VectorXd out(3 * P);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * P, P) =
        MultiplyVector(given.matrices[c], dL.segment(c * n, n));
  }
  return out.cwiseQuotient(point.L_o);
}

Eigen::VectorXd MarginalLikelihood::JacobianTransposedTimes(
    const Given& given, const Point& point, const Eigen::VectorXd& a) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  const Eigen::VectorXd dL_o = a.cwiseQuotient(point.L_o);
  Eigen::VectorXd out(3 * n);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * n, n) =
        MultiplyTransposedVector(given.matrices[c], dL_o.segment(c * P, P));
  }
  return out.cwiseProduct(point.L);
}

// H = K^-1 + J^T W J + C, C = -sum_p slope_p (diag(J_p) - J_p J_p^T).
// Vectors come in pairs: x and, where x = K x', its representers x'.
Eigen::VectorXd MarginalLikelihood::SolveHessian(
    const Given& given, const Point& point, const DataTerm& data,
    const Linearisation& linear, double tolerance,
    const Eigen::VectorXd& x) const {
  const Eigen::VectorXd curvature =
      JacobianTransposedTimes(given, point, data.slope);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(x.size()), rest = x, p_representers,
                  p;
  double rho = 0.0, first_rho = 0.0;
  for (int k = 0; k < kMaxHessianSteps; ++k) {
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
    const Eigen::VectorXd Jp = JacobianTimes(given, point, p);
    const Eigen::VectorXd Hp =
        p_representers - curvature.cwiseProduct(p) +
        JacobianTransposedTimes(given, point,
                                (data.curvature + data.slope).cwiseProduct(Jp));
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
    mode->l = mode->representers = Eigen::VectorXd::Zero(3 * num_sources());
  } else {
    mode->l = ApplyCovariance(given.light, mode->representers);
  }
  return At(given.matrices, mode->level, mode->l);
}

// The step's quadratic model of the cost promises `promise` / 2.
MarginalLikelihood::NewtonStep MarginalLikelihood::FindNewtonStep(
    const Given& given, const Linearisation& linear, const Point& point,
    const DataTerm& data, const LightMode& mode) const {
  const Eigen::VectorXd slope =
      mode.representers - JacobianTransposedTimes(given, point, data.slope);
  NewtonStep step;
  step.representers =
      -SolveHessian(given, point, data, linear, kNewtonTolerance, slope);
  step.l = ApplyCovariance(given.light, step.representers);
  step.promise = -slope.dot(step.l);
  return step;
}

double MarginalLikelihood::TakeStep(const Given& given, const NewtonStep& step,
                                    Point* point, DataTerm* data,
                                    LightMode* mode) const {
  if (!(step.promise > 0.0)) return 0.0;
  const double cross = mode->representers.dot(step.l),
               square = step.representers.dot(step.l);
  const auto try_step = [&](double s) {
    const Eigen::VectorXd l = mode->l + s * step.l;
    Point trial = At(given.matrices, mode->level, l);
    DataTerm trial_data = DataAt(given, trial);
    const double gain =
        data->cost - trial_data.cost - s * cross - 0.5 * s * s * square;
    const bool accepted =
        trial.L_o.minCoeff() > kSmallestRadiance &&
        gain >= kPromisedShare * s * (1.0 - 0.5 * s) * step.promise;
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
  for (int k = 0; k < kMaxIterations; ++k) {
    if (linear == nullptr) {
      linear = Linearise(given, *point, *data);
      if (linear == nullptr) return false;
    }
    const NewtonStep step =
        FindNewtonStep(given, *linear, *point, *data, *mode);
    if (!step.l.allFinite()) return false;
    const double taken = TakeStep(given, step, point, data, mode);
    if (0.5 * step.promise < tolerance || taken == 0.0) break;
    // Far from where it was made a linearisation is a poor preconditioner.
    if (taken * step.l.lpNorm<Eigen::Infinity>() > 1.0) linear = nullptr;
  }
  return true;
}

MarginalValue MarginalLikelihood::Evaluate(
    const std::array<RowMatrix, 3>& matrices, const Eigen::VectorXd& noise,
    const LightHyperparameters& hyperparameters, double tolerance,
    LightMode* mode, MarginalGradient* gradient) const {
  MarginalValue value;
  const Given given = GivenBy(matrices, noise, hyperparameters);
  if (!given.weight.allFinite() || !std::isfinite(given.light.amplitude) ||
      !Roughness(map_height_, hyperparameters).cwiseAbs2().allFinite()) {
    return value;
  }
  Point point = FirstPoint(given, mode);
  // Nothing but black: no light explains an image of it.
  if (!point.residual.allFinite() ||
      !(point.L_o.minCoeff() > kSmallestRadiance)) {
    return value;
  }
  DataTerm data = DataAt(given, point);
  if (!FindMode(given, tolerance, &point, &data, mode)) return value;
  const auto linear = Linearise(given, point, data);
  if (linear == nullptr) return value;
  const double log_determinant =
      2.0 * linear->factor.diagonal().array().log().sum();
  value.cost =
      data.cost + 0.5 * mode->representers.dot(mode->l) + 0.5 * log_determinant;
  value.misfit = Misfit(point);
  value.ok = std::isfinite(value.cost);
  if (gradient != nullptr && value.ok) {
    AddGradient(given, *mode, point, data, *linear, gradient);
  }
  return value;
}

double MarginalLikelihood::Misfit(const Point& point) const {
  if (low_.size() == 0) return point.residual.cwiseAbs().mean();
  double sum = 0.0, count = 0.0;
  for (Eigen::Index p = 0; p < low_.size(); ++p) {
    const bool one_sided = std::isinf(low_[p]) || std::isinf(high_[p]);
    if (one_sided && point.residual[p] == 0.0) continue;
    sum += std::abs(point.residual[p]);
    count += 1.0;
  }
  return sum / std::max(count, 1.0);
}

Eigen::VectorXd MarginalLikelihood::BandWeights(int band) const {
  return ByTexel(roughness_weights_.row(band).transpose(), map_width_);
}

}  // namespace ibrdf

#include "ibrdf/solvers/marginal/marginal_likelihood.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
// After so many steps of Newton's method they are damped.
constexpr int kUndampedIterations = 20;
constexpr double kMostDamping = 1e6, kLeastDamping = 0.1;
// A step must bring this share of the gain that its quadratic model promises.
constexpr double kPromisedShare = 0.1;
// What rounding hides of the cost, of its size: a step that promises less
// cannot be tested.
constexpr double kRounding = 1e-14;
constexpr double kSmallestRadiance = 1e-200;
// Conjugate gradients with the Hessian: steps, and the square of the error,
// relative, in the Hessian's norm, for Newton's steps.
constexpr int kMaxHessianSteps = 30;
constexpr double kNewtonTolerance = 1e-3;
// A linearisation is made anew where log radiance has moved so far since, or
// less and conjugate gradients take more than so many steps.
constexpr double kFar = 1.0, kFarIfSlow = 0.1;
constexpr int kSlow = 15;
// Deviations that FindNoise begins with, log radiance.
constexpr double kFirstSigma = 0.15;

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

MarginalLikelihood::MarginalLikelihood(LogRadianceData data,
                                       const LightProcess& process,
                                       int map_height, int map_width,
                                       int num_directional_lights,
                                       int num_threads, Eigen::MatrixXd paint,
                                       Eigen::VectorXd mean_paint)
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
      paint_(std::move(paint)),
      mean_paint_(std::move(mean_paint)),
      num_threads_(num_threads) {
  CHECK_GT(num_points_, 0);
  CHECK(paint_.size() == 0 || paint_.rows() == 3 * num_points_);
  CHECK(mean_paint_.size() == 0 || mean_paint_.size() == paint_.rows());
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
    const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
    const LightHyperparameters& hyperparameters) const {
  CHECK_EQ(errors.noise.size(), y_.size());
  CHECK_EQ(errors.matte_share.size(), has_paint() ? y_.size() : 0);
  CHECK(errors.mean_paint.size() == 0 || has_paint());
  return {matrices,
          errors.noise,
          errors.matte_share,
          errors.mean_paint,
          errors.noise.cwiseInverse(),
          LightAt(hyperparameters)};
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
  const Eigen::VectorXd L = Radiance(mode.level, mode.l);
  const Eigen::VectorXd L_o = Transported(matrices, L);
  Eigen::VectorXd noise(3 * P);
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd power =
        texel_variance_ * L.segment(c * n, t).cwiseAbs2();
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
      const double of_point = L_o[c * P + p];
      noise[c * P + p] = sigma * sigma + 0.125 * sum / (of_point * of_point);
    }
  }
  return noise;
}

void MarginalLikelihood::SetPaint(const std::array<RowMatrix, 3>& matrices,
                                  const std::array<RowMatrix, 3>& matte,
                                  const LightMode& mode,
                                  DataErrors* errors) const {
  const Eigen::VectorXd L = Radiance(mode.level, mode.l);
  errors->matte_share =
      Transported(matte, L).cwiseQuotient(Transported(matrices, L));
  if (mean_paint_.size() == 0) return;
  const Eigen::ArrayXd share = errors->matte_share;
  const Eigen::ArrayXd painted =
      1.0 + share * (mean_paint_.array().exp() - 1.0);
  errors->mean_paint = painted.log();
  errors->matte_share = share * mean_paint_.array().exp() / painted;
}

DataErrors MarginalLikelihood::FindErrors(
    const std::array<RowMatrix, 3>& matrices,
    const std::array<RowMatrix, 3>& matte, double sigma,
    const LightHyperparameters& hyperparameters, double tolerance,
    LightMode* mode) const {
  DataErrors errors;
  errors.noise =
      Eigen::VectorXd::Constant(y_.size(), kFirstSigma * kFirstSigma);
  if (has_paint()) {
    LightMode constant;
    constant.l = Eigen::VectorXd::Zero(3 * num_sources());
    SetPaint(matrices, matte, constant, &errors);
  }
  Point point;
  DataTerm data;
  FindLight(GivenBy(matrices, errors, hyperparameters), hyperparameters,
            tolerance, nullptr, &point, &data, mode);
  errors.noise = NoiseVariance(matrices, sigma, *mode);
  if (has_paint()) SetPaint(matrices, matte, *mode, &errors);
  return errors;
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
  if (has_paint()) {
    out.tail(y_.size()).noalias() = paint_ * g.tail(y_.size());
  }
  return out;
}

Eigen::VectorXd MarginalLikelihood::PaintOf(const Eigen::VectorXd& l) const {
  return has_paint() ? Eigen::VectorXd(l.tail(y_.size())) : Eigen::VectorXd();
}

Eigen::VectorXd MarginalLikelihood::Radiance(double level,
                                             const Eigen::VectorXd& l) const {
  return (l.head(Eigen::Index{3} * num_sources()).array() + level)
      .min(kMaxLogRadianceInDouble)
      .exp();
}

Eigen::VectorXd MarginalLikelihood::Transported(
    const std::array<RowMatrix, 3>& matrices, const Eigen::VectorXd& L) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  Eigen::VectorXd L_o(3 * P);
  for (int c = 0; c < 3; ++c) {
    L_o.segment(c * P, P) = MultiplyVector(matrices[c], L.segment(c * n, n));
  }
  return L_o.cwiseMax(kSmallestRadiance);
}

MarginalLikelihood::Point MarginalLikelihood::At(
    const Given& given, double level, const Eigen::VectorXd& l) const {
  Point point;
  point.L = Radiance(level, l);
  point.unpainted = Transported(given.matrices, point.L);
  point.log_L_o = point.unpainted.array().log();
  if (has_paint()) {
    point.log_L_o += given.matte_share.cwiseProduct(PaintOf(l));
    if (given.mean_paint.size() > 0) point.log_L_o += given.mean_paint;
  }
  point.residual = y_ - point.log_L_o;
  for (Eigen::Index p = 0; p < low_.size(); ++p) {
    if (low_[p] == high_[p]) continue;
    point.residual[p] =
        std::clamp(point.log_L_o[p], low_[p], high_[p]) - point.log_L_o[p];
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
        low_[p], high_[p], point.log_L_o[p], std::sqrt(given.noise[p]));
    data.cost += of.cost;
    data.slope[p] = of.slope;
    data.curvature[p] = of.curvature;
    data.curvature_slope[p] = of.third;
  }
  return data;
}

template <typename Matrix>
std::unique_ptr<const MarginalLikelihood::Linearisation>
MarginalLikelihood::LineariseIn(const Given& given, const Point& point,
                                const DataTerm& data, double damping) const {
  using Number = typename Matrix::Scalar;
  const Light& light = given.light;
  const Eigen::Index t = num_texels(), n = num_sources(), P = num_points_;
  auto linear = std::make_unique<Linearisation>();
  std::array<Matrix, 3> of_texels, correlated;
  ParallelFor(3, num_threads_, [&](int64_t c, int) {
    linear->jacobian[c] =
        point.unpainted.segment(c * P, P).cwiseInverse().asDiagonal() *
        given.matrices[c] * point.L.segment(c * n, n).asDiagonal();
    of_texels[c] = linear->jacobian[c].leftCols(t).template cast<Number>();
    light.correlation.Multiply(linear->jacobian[c].leftCols(t), &linear->JC[c]);
    correlated[c] = linear->JC[c].template cast<Number>();
  });
  linear->matte_share = given.matte_share;
  linear->damping = damping;
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
    Matrix product;
    MultiplyTransposed(correlated[c], of_texels[d], &product);
    // The rows of a Jacobian sum to 1: a level moves log radiance as it is.
    RowMatrix block =
        (light.amplitude * local_(c, d) * product.template cast<double>() +
         DirectionalLightBlock(*linear, c, d))
            .array() +
        level_(c, d);
    AddPaintBlock(linear->matte_share, c, d, &block);
    ScaleBlock(*linear, c, d, &block);
    A.block(c * P, d * P, P, P) = block;
  });
  A.diagonal() += (1.0 + damping) * linear->diagonal;
  if (!A.allFinite() || !Factorise(&A)) return nullptr;
  return linear;
}

std::unique_ptr<const MarginalLikelihood::Linearisation>
MarginalLikelihood::Linearise(const Given& given, const Point& point,
                              const DataTerm& data) const {
  return LineariseIn<RowMatrix>(given, point, data, 0.0);
}

// Where rounding takes the equations' definiteness they are made again.
std::unique_ptr<const MarginalLikelihood::Linearisation>
MarginalLikelihood::LineariseRoughly(const Given& given, const Point& point,
                                     const DataTerm& data,
                                     double damping) const {
  auto linear = LineariseIn<FloatRowMatrix>(given, point, data, damping);
  return linear != nullptr
             ? std::move(linear)
             : LineariseIn<RowMatrix>(given, point, data, damping);
}

void MarginalLikelihood::AddPaintBlock(const Eigen::VectorXd& matte_share,
                                       int c, int d, RowMatrix* block) const {
  if (!has_paint()) return;
  const Eigen::Index P = num_points_;
  *block += matte_share.segment(c * P, P).asDiagonal() *
            paint_.block(c * P, d * P, P, P) *
            matte_share.segment(d * P, P).asDiagonal();
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
  block.array() += level_(c, d);
  AddPaintBlock(linear.matte_share, c, d, &block);
  return block;
}

Eigen::VectorXd MarginalLikelihood::ApplyJacobian(
    const Linearisation& linear, const Eigen::VectorXd& l) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  Eigen::VectorXd out(3 * P);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * P, P) =
        MultiplyVector(linear.jacobian[c], l.segment(c * n, n));
  }
  if (has_paint()) out += linear.matte_share.cwiseProduct(PaintOf(l));
  return out;
}

Eigen::VectorXd MarginalLikelihood::ApplyJacobianTransposed(
    const Linearisation& linear, const Eigen::VectorXd& a) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  Eigen::VectorXd out(num_latents());
  for (int c = 0; c < 3; ++c) {
    out.segment(c * n, n) =
        MultiplyTransposedVector(linear.jacobian[c], a.segment(c * P, P));
  }
  if (has_paint()) out.tail(3 * P) = linear.matte_share.cwiseProduct(a);
  return out;
}

Eigen::VectorXd MarginalLikelihood::SolveRepresenters(
    const Linearisation& linear, const Light& light,
    const Eigen::VectorXd& x) const {
  Eigen::VectorXd a = linear.row_scale.cwiseProduct(
      ApplyJacobian(linear, ApplyCovariance(light, x)));
  SolveFactored(linear.factor, a.data());
  return (x -
          ApplyJacobianTransposed(linear, linear.row_scale.cwiseProduct(a))) /
         (1.0 + linear.damping);
}

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
        trial.unpainted.minCoeff() > kSmallestRadiance &&
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

double MarginalLikelihood::CostOf(const DataTerm& data, const LightMode& mode) {
  return data.cost + 0.5 * mode.representers.dot(mode.l);
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
  if (!at.residual.allFinite() ||
      !(at.unpainted.minCoeff() > kSmallestRadiance)) {
    return;
  }
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
  if (!point->residual.allFinite() ||
      !(point->unpainted.minCoeff() > kSmallestRadiance)) {
    return false;
  }
  *data = DataAt(given, *point);
  if (near != nullptr) Predict(given, *near, point, data, mode);
  return FindMode(given, tolerance, point, data, mode);
}

MarginalValue MarginalLikelihood::Expand(
    std::array<RowMatrix, 3> matrices, DataErrors errors,
    const LightHyperparameters& hyperparameters, double tolerance,
    const Expansion* near, LightMode* mode,
    std::unique_ptr<const Expansion>* expansion) const {
  MarginalValue value;
  expansion->reset();
  auto at = std::make_unique<Expansion>(*this, std::move(matrices),
                                        std::move(errors), hyperparameters);
  if (!FindLight(at->given, hyperparameters, tolerance, near, &at->point,
                 &at->data, mode)) {
    return value;
  }
  at->mode = *mode;
  at->linear = Linearise(at->given, at->point, at->data);
  if (at->linear == nullptr) return value;
  const double log_determinant =
      2.0 * at->linear->factor.diagonal().array().log().sum();
  value.cost = CostOf(at->data, *mode) + 0.5 * log_determinant;
  value.misfit = Misfit(at->point);
  value.ok = std::isfinite(value.cost);
  if (value.ok) *expansion = std::move(at);
  return value;
}

MarginalValue MarginalLikelihood::Evaluate(
    const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, double tolerance,
    LightMode* mode, MarginalGradient* gradient) const {
  std::unique_ptr<const Expansion> at;
  const MarginalValue value =
      Expand(matrices, errors, hyperparameters, tolerance, nullptr, mode, &at);
  if (gradient != nullptr && value.ok) *gradient = Gradient(*at);
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

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

namespace ibrdf {
namespace {

constexpr double kSmallestRadiance = 1e-200;
// Deviations that FindErrors begins with, log radiance.
constexpr double kFirstSigma = 0.15;

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

bool MarginalLikelihood::Point::Valid() const {
  return residual.allFinite() && unpainted.minCoeff() > kSmallestRadiance;
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

double MarginalLikelihood::CostOf(const DataTerm& data, const LightMode& mode) {
  return data.cost + 0.5 * mode.representers.dot(mode.l);
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

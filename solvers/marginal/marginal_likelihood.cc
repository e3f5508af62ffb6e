#include "ibrdf/solvers/marginal/marginal_likelihood.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/optim/line_search.h"

namespace ibrdf {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kSmallestStep = 1e-4;
constexpr double kLongestStep = 6.0;
// Of the gain that a step's quadratic model promises, what it must bring.
constexpr double kSufficientGain = 0.1;
constexpr double kSmallestRadiance = 1e-200;
// Conjugate gradients with the Hessian: steps, and the square of the error,
// relative, in the Hessian's norm, for Newton's steps and for the motion of the
// mode.
constexpr int kMaxHessianSteps = 30;
constexpr double kNewtonTolerance = 1e-3;
constexpr double kMotionTolerance = 1e-10;
// Of FindNoise, log radiance.
constexpr double kFirstSigma = 0.15;
}  // namespace

MarginalLikelihood::MarginalLikelihood(std::vector<double> log_radiance,
                                       const LightProcess& process,
                                       int map_height, int map_width,
                                       int num_directional_lights,
                                       int num_threads)
    : num_points_(static_cast<int>(log_radiance.size() / 3)),
      y_(Eigen::Map<const Eigen::VectorXd>(
          log_radiance.data(), static_cast<Eigen::Index>(log_radiance.size()))),
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
  CHECK_EQ(log_radiance.size() % 3, 0u);
}

MarginalLikelihood::Light MarginalLikelihood::LightAt(
    const LightHyperparameters& hyperparameters) const {
  return {std::exp(hyperparameters.log_amplitude),
          spectrum_.At(hyperparameters), spectrum_.RoughAt(hyperparameters)};
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
  return point;
}

std::unique_ptr<const MarginalLikelihood::Linearisation>
MarginalLikelihood::Linearise(const std::array<RowMatrix, 3>& matrices,
                              const Eigen::VectorXd& noise, const Light& light,
                              const Point& point) const {
  const Eigen::Index t = num_texels(), n = num_sources(), P = num_points_;
  auto linear = std::make_unique<Linearisation>();
  ParallelFor(3, num_threads_, [&](int64_t c, int) {
    linear->jacobian[c] =
        point.L_o.segment(c * P, P).cwiseInverse().asDiagonal() * matrices[c] *
        point.L.segment(c * n, n).asDiagonal();
    light.correlation.Multiply(linear->jacobian[c].leftCols(t), &linear->JC[c]);
  });
  RowMatrix& A = linear->factor;
  A.setZero(3 * P, 3 * P);
  constexpr int kPairs[6][2] = {{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}};
  ParallelFor(6, num_threads_, [&](int64_t pair, int) {
    const int c = kPairs[pair][0], d = kPairs[pair][1];
    RowMatrix block;
    MultiplyTransposed(linear->JC[c], linear->jacobian[d].leftCols(t), &block);
    // The rows of a Jacobian sum to 1: a level moves log radiance as it is.
    A.block(c * P, d * P, P, P) = (light.amplitude * local_(c, d) * block +
                                   DirectionalLightBlock(*linear, c, d))
                                      .array() +
                                  level_(c, d);
  });
  A.diagonal() += noise;
  if (!A.allFinite() || !Factorise(&A)) return nullptr;
  return linear;
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
  Eigen::VectorXd a = ApplyJacobian(linear, ApplyCovariance(light, x));
  SolveFactored(linear.factor, a.data());
  return x - ApplyJacobianTransposed(linear, a);
}

Eigen::VectorXd MarginalLikelihood::JacobianTimes(
    const std::array<RowMatrix, 3>& matrices, const Point& point,
    const Eigen::VectorXd& v) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  const Eigen::VectorXd dL = point.L.cwiseProduct(v);
  Eigen::VectorXd out(3 * P);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * P, P) = MultiplyVector(matrices[c], dL.segment(c * n, n));
  }
  return out.cwiseQuotient(point.L_o);
}

Eigen::VectorXd MarginalLikelihood::JacobianTransposedTimes(
    const std::array<RowMatrix, 3>& matrices, const Point& point,
    const Eigen::VectorXd& a) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  const Eigen::VectorXd dL_o = a.cwiseQuotient(point.L_o);
  Eigen::VectorXd out(3 * n);
  for (int c = 0; c < 3; ++c) {
    out.segment(c * n, n) =
        MultiplyTransposedVector(matrices[c], dL_o.segment(c * P, P));
  }
  return out.cwiseProduct(point.L);
}

// H = K^-1 + J^T D^-1 J + C, C = -sum_p r_p / D_p (diag(J_p) - J_p J_p^T).
// Vectors come in pairs: x and, where x = K x', its representers x'.
Eigen::VectorXd MarginalLikelihood::SolveHessian(
    const std::array<RowMatrix, 3>& matrices, const Point& point,
    const Linearisation& linear, const Eigen::VectorXd& weight,
    const Light& light, double tolerance, const Eigen::VectorXd& x) const {
  const Eigen::VectorXd weighted = weight.cwiseProduct(point.residual);
  const Eigen::VectorXd curvature =
      JacobianTransposedTimes(matrices, point, weighted);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(x.size()), rest = x, p_representers,
                  p;
  double rho = 0.0, first_rho = 0.0;
  for (int k = 0; k < kMaxHessianSteps; ++k) {
    const Eigen::VectorXd z_representers =
        SolveRepresenters(linear, light, rest);
    const Eigen::VectorXd z = ApplyCovariance(light, z_representers);
    const double next_rho = rest.dot(z);
    if (k == 0) first_rho = next_rho;
    if (!(next_rho > tolerance * first_rho)) break;
    const double beta = k == 0 ? 0.0 : next_rho / rho;
    p_representers =
        k == 0 ? z_representers
               : Eigen::VectorXd(z_representers + beta * p_representers);
    p = k == 0 ? z : Eigen::VectorXd(z + beta * p);
    rho = next_rho;
    const Eigen::VectorXd Jp = JacobianTimes(matrices, point, p);
    const Eigen::VectorXd Hp =
        p_representers - curvature.cwiseProduct(p) +
        JacobianTransposedTimes(matrices, point,
                                (weight + weighted).cwiseProduct(Jp));
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

MarginalValue MarginalLikelihood::Evaluate(
    const std::array<RowMatrix, 3>& matrices, const Eigen::VectorXd& noise,
    const LightHyperparameters& hyperparameters, double tolerance,
    LightMode* mode, MarginalGradient* gradient) const {
  const Eigen::Index n = num_sources();
  const Eigen::VectorXd weight = noise.cwiseInverse();
  const auto likelihood_of = [&](const Point& at) {
    return 0.5 * at.residual.cwiseAbs2().dot(weight);
  };
  MarginalValue value;
  if (!weight.allFinite()) return value;
  const Light light = LightAt(hyperparameters);
  if (!std::isfinite(light.amplitude) ||
      !Roughness(map_height_, hyperparameters).cwiseAbs2().allFinite()) {
    return value;
  }
  if (mode->l.size() == 0) {
    mode->level = LevelFor(matrices);
    mode->l = mode->representers = Eigen::VectorXd::Zero(3 * n);
  } else {
    mode->l = ApplyCovariance(light, mode->representers);
  }
  Point point = At(matrices, mode->level, mode->l);
  // Nothing but black: no light explains an image of it.
  if (!point.residual.allFinite() ||
      !(point.L_o.minCoeff() > kSmallestRadiance)) {
    return value;
  }
  double likelihood = likelihood_of(point);
  std::unique_ptr<const Linearisation> linear;
  for (int k = 0; k < kMaxIterations; ++k) {
    if (linear == nullptr) {
      linear = Linearise(matrices, noise, light, point);
      if (linear == nullptr) return value;
    }
    const Eigen::VectorXd slope =
        mode->representers -
        JacobianTransposedTimes(matrices, point,
                                weight.cwiseProduct(point.residual));
    const Eigen::VectorXd d_representers = -SolveHessian(
        matrices, point, *linear, weight, light, kNewtonTolerance, slope);
    const Eigen::VectorXd dl = ApplyCovariance(light, d_representers);
    if (!dl.allFinite()) return value;
    const double promise = -slope.dot(dl);  // twice the model's gain
    const double cross = mode->representers.dot(dl),
                 square = d_representers.dot(dl);
    const auto try_step = [&](double s) {
      const Eigen::VectorXd l = mode->l + s * dl;
      Point trial = At(matrices, mode->level, l);
      const double trial_likelihood = likelihood_of(trial);
      const double gain =
          likelihood - trial_likelihood - s * cross - 0.5 * s * s * square;
      const bool accepted =
          trial.L_o.minCoeff() > kSmallestRadiance &&
          gain >= kSufficientGain * s * (1.0 - 0.5 * s) * promise;
      if (accepted) {
        mode->representers += s * d_representers;
        mode->l = l;
        point = std::move(trial);
        likelihood = trial_likelihood;
      }
      return LineSearchTrial{gain, accepted};
    };
    // From a wide start the whole step may leave the range of exp.
    const double longest =
        std::min(1.0, kLongestStep / dl.lpNorm<Eigen::Infinity>());
    const double taken =
        promise > 0.0 ? LineSearch(longest, kSmallestStep, promise, try_step)
                      : 0.0;
    if (0.5 * promise < tolerance || taken == 0.0) break;
    // Far from where it was made a linearisation is a poor preconditioner.
    if (taken * dl.lpNorm<Eigen::Infinity>() > 1.0) {
      linear = nullptr;
    }
  }
  linear = Linearise(matrices, noise, light, point);
  if (linear == nullptr) return value;
  const double log_determinant =
      2.0 * linear->factor.diagonal().array().log().sum();
  value.cost = likelihood + 0.5 * mode->representers.dot(mode->l) +
               0.5 * log_determinant;
  value.misfit = point.residual.cwiseAbs().mean();
  value.ok = std::isfinite(value.cost);
  if (gradient != nullptr && value.ok) {
    AddGradient(matrices, weight, light, *mode, point, *linear, gradient);
  }
  return value;
}

Eigen::VectorXd MarginalLikelihood::BandWeights(int band) const {
  return ByTexel(roughness_weights_.row(band).transpose(), map_width_);
}

// With F the cost, Phi its first two terms, l* the mode: dF = (partial of F at
// fixed l) - v . d(grad_l Phi), v = H^-1 q, H the Hessian of Phi and q the
// gradient of the log determinant in l.
void MarginalLikelihood::AddGradient(const std::array<RowMatrix, 3>& matrices,
                                     const Eigen::VectorXd& weight,
                                     const Light& light, const LightMode& mode,
                                     const Point& point,
                                     const Linearisation& linear,
                                     MarginalGradient* gradient) const {
  const Eigen::Index t = num_texels(), n = num_sources(), P = num_points_;
  const Eigen::VectorXd& r = point.residual;
  RowMatrix inverse = linear.factor;
  InvertFactored(&inverse);

  // G = A^-1 J K per channel; a constant along a row has no effect, as it only
  // meets differences of a Jacobian's rows. Then centred: G - sum_t G J.
  std::array<RowMatrix, 3> G;
  Eigen::VectorXd q(3 * n);
  // By texel, diag(J^T A^-1 J K_rough) / 2.
  Eigen::VectorXd rough_share = Eigen::VectorXd::Zero(t);
  for (int c = 0; c < 3; ++c) {
    RowMatrix sum = RowMatrix::Zero(P, t),
              directional_lights = RowMatrix::Zero(P, num_directional_lights_);
    RowMatrix product;
    for (int d = 0; d < 3; ++d) {
      MultiplyInTiles(inverse.block(c * P, d * P, P, P), linear.jacobian[d],
                      num_threads_, &product);
      sum += light.amplitude * local_(c, d) * product.leftCols(t);
      directional_lights +=
          directional_light_(c, d) * product.rightCols(num_directional_lights_);
    }
    light.rough.Multiply(sum, &product);
    rough_share += product.cwiseProduct(linear.jacobian[c].leftCols(t))
                       .colwise()
                       .sum()
                       .transpose();
    light.correlation.Multiply(sum, &product);
    G[c].resize(P, n);
    G[c] << product, directional_lights;
    const Eigen::VectorXd means =
        G[c].cwiseProduct(linear.jacobian[c]).rowwise().sum();
    G[c].colwise() -= means;
    q.segment(c * n, n) =
        G[c].cwiseProduct(linear.jacobian[c]).colwise().sum().transpose();
  }

  const Eigen::VectorXd weighted = weight.cwiseProduct(r);
  const Eigen::VectorXd w =
      SolveHessian(matrices, point, linear, weight, light, kMotionTolerance, q);
  const Eigen::VectorXd v = ApplyCovariance(light, w);
  const Eigen::VectorXd Jv = ApplyJacobian(linear, v);

  for (int c = 0; c < 3; ++c) {
    const auto L = point.L.segment(c * n, n);
    const Eigen::ArrayXd weighted_c = weighted.segment(c * P, P).array();
    const Eigen::ArrayXd weight_c = weight.segment(c * P, P).array();
    const Eigen::ArrayXd Jv_c = Jv.segment(c * P, P).array();
    const Eigen::ArrayXd inverse_E =
        point.L_o.segment(c * P, P).array().inverse();
    RowMatrix& out = gradient->matrices[c];
    out = std::move(G[c]);
    // d(grad_l Phi) . v in T is that of -(J v) . r / D.
    out.colwise() -=
        (weighted_c + Jv_c * weighted_c + Jv_c * weight_c).matrix();
    out.noalias() += weighted_c.matrix() * v.segment(c * n, n).transpose();
    out = inverse_E.matrix().asDiagonal() * out * L.asDiagonal();
  }

  // tr(A^-1 J K1 J^T), K1 what the amplitude scales: A less D and the
  // rest.
  double trace = 3.0 * static_cast<double>(P) -
                 inverse.diagonal().dot(weight.cwiseInverse());
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      trace -= UnscaledBlock(linear, c, d)
                   .cwiseProduct(inverse.block(c * P, d * P, P, P))
                   .sum();
    }
  }
  const auto by_scale = [&](const Eigen::VectorXd& K_dual, double its_trace) {
    return -0.5 * mode.representers.dot(K_dual) + w.dot(K_dual) +
           0.5 * its_trace;
  };
  gradient->hyperparameters[0] = by_scale(
      ApplyLocal(light, mode.representers) - ApplyHorizon(mode.representers),
      trace);
  // Of C, by the log roughness of a band with weights h along the texels:
  // diag(h) R + R diag(h), R the rough part.
  const Eigen::Map<const RowMatrix> representers(mode.representers.data(), 3,
                                                 n);
  RowMatrix rough_dual;
  light.rough.Multiply(representers.leftCols(t), &rough_dual);
  for (int b = 0; b < LightHyperparameters::kBands; ++b) {
    const Eigen::VectorXd h = BandWeights(b);
    RowMatrix other;
    light.rough.Multiply(representers.leftCols(t) * h.asDiagonal(), &other);
    RowMatrix moved = RowMatrix::Zero(3, n);
    moved.leftCols(t) =
        light.amplitude * local_ * (rough_dual * h.asDiagonal() + other);
    gradient->hyperparameters[1 + b] =
        by_scale(Eigen::Map<const Eigen::VectorXd>(moved.data(), 3 * n),
                 2.0 * h.dot(rough_share));
  }
}

}  // namespace ibrdf

// The gradient of the marginal likelihood.
//
// With F the cost, Phi its first two terms, l* the mode: dF = (partial of F at
// fixed l) - v . d(grad_l Phi), v = H^-1 q, H the Hessian of Phi and q the
// gradient of the log determinant in l.
#include <Eigen/Dense>
#include <utility>

#include "ibrdf/solvers/marginal/marginal_likelihood.h"

namespace ibrdf {
namespace {

// The square of the error of conjugate gradients with the Hessian, relative, in
// its norm, for the motion of the mode.
constexpr double kMotionTolerance = 1e-10;

}  // namespace

// G = A^-1 J K per channel; a constant along a row has no effect, as it only
// meets differences of a Jacobian's rows. Then centred: G - sum_t G J.
MarginalLikelihood::DeterminantGradient
MarginalLikelihood::GradientOfDeterminant(const Given& given,
                                          const DataTerm& data,
                                          const Linearisation& linear) const {
  const Light& light = given.light;
  const Eigen::Index t = num_texels(), n = num_sources(), P = num_points_;
  DeterminantGradient out;
  out.inverse = linear.factor;
  InvertFactored(&out.inverse);
  out.noise_share = NoiseShare(given, out.inverse);
  out.by_log_radiance = GradientThroughCurvature(data, out.inverse);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      RowMatrix block = out.inverse.block(c * P, d * P, P, P);
      ScaleBlock(linear, c, d, &block);
      out.inverse.block(c * P, d * P, P, P) = block;
    }
  }
  out.by_l.setZero(num_latents());
  out.rough_share = Eigen::VectorXd::Zero(t);
  for (int c = 0; c < 3; ++c) {
    RowMatrix sum = RowMatrix::Zero(P, t),
              directional_lights = RowMatrix::Zero(P, num_directional_lights_);
    RowMatrix product;
    for (int d = 0; d < 3; ++d) {
      MultiplyInTiles(out.inverse.block(c * P, d * P, P, P), linear.jacobian[d],
                      num_threads_, &product);
      sum += light.amplitude * local_(c, d) * product.leftCols(t);
      directional_lights +=
          directional_light_(c, d) * product.rightCols(num_directional_lights_);
    }
    light.rough.Multiply(sum, &product);
    out.rough_share += product.cwiseProduct(linear.jacobian[c].leftCols(t))
                           .colwise()
                           .sum()
                           .transpose();
    light.correlation.Multiply(sum, &product);
    RowMatrix& G = out.G[c];
    G.resize(P, n);
    G << product, directional_lights;
    const Eigen::VectorXd means =
        G.cwiseProduct(linear.jacobian[c]).rowwise().sum();
    G.colwise() -= means;
    out.by_l.segment(c * n, n) =
        G.cwiseProduct(linear.jacobian[c]).colwise().sum().transpose();
  }
  if (out.by_log_radiance.size() > 0) {
    out.by_l += ApplyJacobianTransposed(linear, out.by_log_radiance);
  }
  return out;
}

// With B = W^1/2 J K J^T W^1/2 and A = 1 + B the determinant by W_p is
// (B A^-1)_pp / (2 W_p) = (1 - (A^-1)_pp) / (2 W_p).
Eigen::VectorXd MarginalLikelihood::GradientThroughCurvature(
    const DataTerm& data, const RowMatrix& inverse) const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(low_.size());
  for (Eigen::Index p = 0; p < low_.size(); ++p) {
    if (low_[p] == high_[p] || data.curvature[p] == 0.0) continue;
    gradient[p] = 0.5 * data.curvature_slope[p] / data.curvature[p] *
                  (1.0 - inverse(p, p));
  }
  return gradient;
}

double MarginalLikelihood::NoiseShare(const Given& given,
                                      const RowMatrix& inverse) const {
  Eigen::VectorXd diagonal = given.weight.cwiseInverse();
  for (Eigen::Index p = 0; p < low_.size(); ++p) {
    if (low_[p] != high_[p]) diagonal[p] = 1.0;
  }
  return inverse.diagonal().dot(diagonal);
}

void MarginalLikelihood::GradientByMatrices(
    const Point& point, const DataTerm& data, const Eigen::VectorXd& v,
    const Eigen::VectorXd& Jv, const Eigen::VectorXd& Jv_light,
    DeterminantGradient* determinant,
    std::array<RowMatrix, 3>* gradient) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  for (int c = 0; c < 3; ++c) {
    const auto L = point.L.segment(c * n, n);
    const Eigen::ArrayXd slope = data.slope.segment(c * P, P).array();
    const Eigen::ArrayXd curvature = data.curvature.segment(c * P, P).array();
    const Eigen::ArrayXd Jv_c = Jv.segment(c * P, P).array();
    const Eigen::ArrayXd of_light = Jv_light.segment(c * P, P).array();
    const Eigen::ArrayXd inverse_L_o =
        point.unpainted.segment(c * P, P).array().inverse();
    RowMatrix& out = (*gradient)[c];
    out = std::move(determinant->G[c]);
    // d(grad_l Phi) . v in T is that of -(J v) . slope; T moves the light's
    // part of J alone.
    out.colwise() -= (slope + of_light * slope + Jv_c * curvature).matrix();
    if (determinant->by_log_radiance.size() > 0) {
      out.colwise() += determinant->by_log_radiance.segment(c * P, P);
    }
    out.noalias() += slope.matrix() * v.segment(c * n, n).transpose();
    out = inverse_L_o.matrix().asDiagonal() * out * L.asDiagonal();
  }
}

double MarginalLikelihood::TraceByAmplitude(
    const Linearisation& linear, const DeterminantGradient& determinant) const {
  const Eigen::Index P = num_points_;
  double trace = 3.0 * static_cast<double>(P) - determinant.noise_share;
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      trace -= UnscaledBlock(linear, c, d)
                   .cwiseProduct(determinant.inverse.block(c * P, d * P, P, P))
                   .sum();
    }
  }
  return trace;
}

Eigen::VectorXd MarginalLikelihood::ApplyBandDerivative(
    const Light& light, const Eigen::VectorXd& h, const Eigen::VectorXd& g,
    const RowMatrix& rough) const {
  const Eigen::Index t = num_texels(), n = num_sources();
  const Eigen::Map<const RowMatrix> in(g.data(), 3, n);
  RowMatrix other;
  light.rough.Multiply(in.leftCols(t) * h.asDiagonal(), &other);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(g.size());
  Eigen::Map<RowMatrix>(out.data(), 3, n).leftCols(t) =
      light.amplitude * local_ * (rough * h.asDiagonal() + other);
  return out;
}

MarginalGradient MarginalLikelihood::Gradient(const Expansion& at) const {
  const Given& given = at.given;
  const LightMode& mode = at.mode;
  const Linearisation& linear = *at.linear;
  MarginalGradient gradient;
  DeterminantGradient determinant =
      GradientOfDeterminant(given, at.data, linear);
  const Eigen::VectorXd w = SolveHessian(given, at.point, at.data, linear,
                                         kMotionTolerance, determinant.by_l);
  const Eigen::VectorXd v = ApplyCovariance(given.light, w);
  const Eigen::VectorXd Jv = ApplyJacobian(linear, v);
  GradientByMatrices(at.point, at.data, v, Jv,
                     has_paint() ? LightJacobianTimes(given, at.point, v) : Jv,
                     &determinant, &gradient.matrices);

  // K_a is what the covariance's derivative by a hyperparameter makes of the
  // representers; `trace` is tr(A^-1 J K_a J^T).
  const auto by_hyperparameter = [&](const Eigen::VectorXd& K_a, double trace) {
    return -0.5 * mode.representers.dot(K_a) + w.dot(K_a) + 0.5 * trace;
  };
  gradient.hyperparameters[0] =
      by_hyperparameter(ApplyLocal(given.light, mode.representers) -
                            ApplyHorizon(mode.representers),
                        TraceByAmplitude(linear, determinant));
  RowMatrix rough;
  given.light.rough.Multiply(
      Eigen::Map<const RowMatrix>(mode.representers.data(), 3, num_sources())
          .leftCols(num_texels()),
      &rough);
  for (int b = 0; b < LightHyperparameters::kBands; ++b) {
    const Eigen::VectorXd h = BandWeights(b);
    gradient.hyperparameters[1 + b] = by_hyperparameter(
        ApplyBandDerivative(given.light, h, mode.representers, rough),
        2.0 * h.dot(determinant.rough_share));
  }
  return gradient;
}

}  // namespace ibrdf

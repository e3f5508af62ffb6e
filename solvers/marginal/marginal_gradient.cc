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
                                          const Linearisation& linear) const {
  const Light& light = given.light;
  const Eigen::Index t = num_texels(), n = num_sources(), P = num_points_;
  DeterminantGradient out;
  out.inverse = linear.factor;
  InvertFactored(&out.inverse);
  out.by_l.resize(3 * n);
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
  return out;
}

void MarginalLikelihood::GradientByMatrices(
    const Given& given, const Point& point, const Eigen::VectorXd& v,
    const Eigen::VectorXd& Jv, DeterminantGradient* determinant,
    std::array<RowMatrix, 3>* gradient) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  const Eigen::VectorXd weighted = given.weight.cwiseProduct(point.residual);
  for (int c = 0; c < 3; ++c) {
    const auto L = point.L.segment(c * n, n);
    const Eigen::ArrayXd weighted_c = weighted.segment(c * P, P).array();
    const Eigen::ArrayXd weight_c = given.weight.segment(c * P, P).array();
    const Eigen::ArrayXd Jv_c = Jv.segment(c * P, P).array();
    const Eigen::ArrayXd inverse_L_o =
        point.L_o.segment(c * P, P).array().inverse();
    RowMatrix& out = (*gradient)[c];
    out = std::move(determinant->G[c]);
    // d(grad_l Phi) . v in T is that of -(J v) . r / D.
    out.colwise() -=
        (weighted_c + Jv_c * weighted_c + Jv_c * weight_c).matrix();
    out.noalias() += weighted_c.matrix() * v.segment(c * n, n).transpose();
    out = inverse_L_o.matrix().asDiagonal() * out * L.asDiagonal();
  }
}

double MarginalLikelihood::TraceByAmplitude(const Given& given,
                                            const Linearisation& linear,
                                            const RowMatrix& inverse) const {
  const Eigen::Index P = num_points_;
  double trace = 3.0 * static_cast<double>(P) -
                 inverse.diagonal().dot(given.weight.cwiseInverse());
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      trace -= UnscaledBlock(linear, c, d)
                   .cwiseProduct(inverse.block(c * P, d * P, P, P))
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

void MarginalLikelihood::AddGradient(const Given& given, const LightMode& mode,
                                     const Point& point,
                                     const Linearisation& linear,
                                     MarginalGradient* gradient) const {
  DeterminantGradient determinant = GradientOfDeterminant(given, linear);
  const Eigen::VectorXd w =
      SolveHessian(given, point, linear, kMotionTolerance, determinant.by_l);
  const Eigen::VectorXd v = ApplyCovariance(given.light, w);
  GradientByMatrices(given, point, v, ApplyJacobian(linear, v), &determinant,
                     &gradient->matrices);

  // K_a is what the covariance's derivative by a hyperparameter makes of the
  // representers; `trace` is tr(A^-1 J K_a J^T).
  const auto by_hyperparameter = [&](const Eigen::VectorXd& K_a, double trace) {
    return -0.5 * mode.representers.dot(K_a) + w.dot(K_a) + 0.5 * trace;
  };
  gradient->hyperparameters[0] =
      by_hyperparameter(ApplyLocal(given.light, mode.representers) -
                            ApplyHorizon(mode.representers),
                        TraceByAmplitude(given, linear, determinant.inverse));
  RowMatrix rough;
  given.light.rough.Multiply(
      Eigen::Map<const RowMatrix>(mode.representers.data(), 3, num_sources())
          .leftCols(num_texels()),
      &rough);
  for (int b = 0; b < LightHyperparameters::kBands; ++b) {
    const Eigen::VectorXd h = BandWeights(b);
    gradient->hyperparameters[1 + b] = by_hyperparameter(
        ApplyBandDerivative(given.light, h, mode.representers, rough),
        2.0 * h.dot(determinant.rough_share));
  }
}

}  // namespace ibrdf

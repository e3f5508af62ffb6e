// What the marginal likelihood says of parameters and light around its mode.
#include <glog/logging.h>

#include <Eigen/Dense>

#include "ibrdf/solvers/marginal/marginal_likelihood.h"

namespace ibrdf {

Eigen::MatrixXd MarginalLikelihood::InformationBy(
    const Light& light, const Linearisation& linear, const RowMatrix& G,
    Eigen::MatrixXd* of_hyperparameters) const {
  const Eigen::Index n = G.cols();
  constexpr int kCount = LightHyperparameters::kCount;
  CHECK_EQ(G.rows(), Eigen::Index{3} * num_points_);
  const RowMatrix whitened = linear.factor.triangularView<Eigen::Lower>().solve(
      RowMatrix(linear.row_scale.asDiagonal() * G));
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n + kCount, n + kCount);
  information.topLeftCorner(n, n).noalias() = whitened.transpose() * whitened;
  Eigen::MatrixXd block;
  if (of_hyperparameters == nullptr) of_hyperparameters = &block;
  if (of_hyperparameters->size() == 0) {
    *of_hyperparameters = HyperparameterInformation(light, linear);
  }
  information.bottomRightCorner(kCount, kCount) = *of_hyperparameters;
  return information;
}

Eigen::MatrixXd MarginalLikelihood::Information(
    const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, const LightMode& mode,
    const RowMatrix& G, Eigen::MatrixXd* of_hyperparameters) const {
  const Given given = GivenBy(matrices, errors, hyperparameters);
  const Point point = At(given, mode.level, mode.l);
  const auto linear = Linearise(given, point, DataAt(given, point));
  if (linear == nullptr) return {};
  return InformationBy(given.light, *linear, G, of_hyperparameters);
}

Eigen::MatrixXd MarginalLikelihood::Information(
    const Expansion& at, const RowMatrix& G,
    Eigen::MatrixXd* of_hyperparameters) const {
  return InformationBy(at.given.light, *at.linear, G, of_hyperparameters);
}

LinearPosterior MarginalLikelihood::Linearised(
    const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, const LightMode& mode,
    const RowMatrix& G) const {
  CHECK(!has_paint());
  CHECK_EQ(G.rows(), Eigen::Index{3} * num_points_);
  const Given given = GivenBy(matrices, errors, hyperparameters);
  const Point point = At(given, mode.level, mode.l);
  const auto linear = Linearise(given, point, DataAt(given, point));
  if (linear == nullptr) return {};
  // K, a column at a time.
  const Eigen::Index n = Eigen::Index{3} * num_sources(),
                     rows = Eigen::Index{3} * num_points_;
  LinearPosterior out;
  out.light_covariance.resize(n, n);
  RowMatrix transposed(n, rows);  // K J^T, columns scaled as rows of J
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd column =
        ApplyCovariance(given.light, Eigen::VectorXd::Unit(n, i));
    out.light_covariance.row(i) = column.transpose();
    transposed.row(i) =
        linear->row_scale.cwiseProduct(ApplyJacobian(*linear, column))
            .transpose();
  }
  // A = B B^T; JK and G times B^-1.
  const auto factor = linear->factor.triangularView<Eigen::Lower>();
  const RowMatrix JK = factor.solve(RowMatrix(transposed.transpose()));
  const RowMatrix whitened =
      factor.solve(RowMatrix(linear->row_scale.asDiagonal() * G));
  out.information.noalias() = whitened.transpose() * whitened;
  out.light_slope.noalias() = JK.transpose() * whitened;
  RowMatrix known;
  Multiply(RowMatrix(JK.transpose()), JK, &known);
  out.light_covariance -= known;
  return out;
}

std::array<RowMatrix, 3> MarginalLikelihood::LightJacobian(
    const std::array<RowMatrix, 3>& matrices, const LightMode& mode) const {
  const Eigen::Index n = num_sources(), P = num_points_;
  const Eigen::VectorXd L = Radiance(mode.level, mode.l);
  const Eigen::VectorXd L_o = Transported(matrices, L);
  std::array<RowMatrix, 3> jacobian;
  for (int c = 0; c < 3; ++c) {
    jacobian[c] = L_o.segment(c * P, P).cwiseInverse().asDiagonal() *
                  matrices[c] * L.segment(c * n, n).asDiagonal();
  }
  return jacobian;
}

RowMatrix MarginalLikelihood::CovarianceByBand(
    const Light& light, const Linearisation& linear,
    const std::array<RowMatrix, 3>& rough, int band) const {
  const Eigen::Index P = num_points_;
  // Only its rows of the map.
  int first = 0, last = map_height_;
  while (first < last && roughness_weights_(band, first) == 0.0) ++first;
  while (first < last && roughness_weights_(band, last - 1) == 0.0) --last;
  const Eigen::Index from = Eigen::Index{first} * map_width_;
  const Eigen::Index size = Eigen::Index{last - first} * map_width_;
  RowMatrix half = RowMatrix::Zero(3 * P, 3 * P);
  if (size == 0) return half;
  const Eigen::VectorXd h = BandWeights(band).segment(from, size);
  for (int c = 0; c < 3; ++c) {
    const RowMatrix weighted = rough[c].middleCols(from, size) * h.asDiagonal();
    for (int d = 0; d < 3; ++d) {
      RowMatrix product;
      MultiplyTransposed(weighted,
                         RowMatrix(linear.jacobian[d].middleCols(from, size)),
                         &product);
      product *= light.amplitude * local_(c, d);
      ScaleBlock(linear, c, d, &product);
      half.block(c * P, d * P, P, P) = product;
    }
  }
  return half + half.transpose();
}

Eigen::MatrixXd MarginalLikelihood::HyperparameterInformation(
    const Light& light, const Linearisation& linear) const {
  const Eigen::Index P = num_points_;
  constexpr int kCount = LightHyperparameters::kCount;
  RowMatrix exact_inverse = linear.factor;
  InvertFactored(&exact_inverse);
  const FloatRowMatrix inverse = exact_inverse.cast<float>();
  // A^-1 J K_a J^T of each scale. The amplitude's: I - A^-1 (D + what it does
  // not scale).
  std::array<FloatRowMatrix, kCount> by;
  RowMatrix unscaled(3 * P, 3 * P);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      RowMatrix block = UnscaledBlock(linear, c, d);
      ScaleBlock(linear, c, d, &block);
      unscaled.block(c * P, d * P, P, P) = block;
    }
  }
  unscaled.diagonal() += linear.diagonal;
  MultiplyInTiles(inverse, FloatRowMatrix(-unscaled.cast<float>()),
                  num_threads_, &by[0]);
  by[0].diagonal().array() += 1.0f;
  std::array<RowMatrix, 3> rough;
  for (int c = 0; c < 3; ++c) {
    light.rough.Multiply(linear.jacobian[c].leftCols(num_texels()), &rough[c]);
  }
  for (int b = 0; b < LightHyperparameters::kBands; ++b) {
    MultiplyInTiles(
        inverse,
        FloatRowMatrix(CovarianceByBand(light, linear, rough, b).cast<float>()),
        num_threads_, &by[1 + b]);
  }
  Eigen::MatrixXd information(kCount, kCount);
  for (int a = 0; a < kCount; ++a) {
    for (int b = 0; b <= a; ++b) {
      information(a, b) = information(b, a) =
          0.5 * by[a]
                    .cast<double>()
                    .cwiseProduct(by[b].transpose().cast<double>())
                    .sum();
    }
  }
  return information;
}

Eigen::VectorXd MarginalLikelihood::PriorLightVariance(
    const LightHyperparameters& hyperparameters) const {
  const Eigen::Index t = num_texels();
  const Light light = LightAt(hyperparameters);
  const Eigen::ArrayXd roughness =
      ByTexel(Roughness(map_height_, hyperparameters), map_width_);
  // The correlation of a texel with itself.
  const Eigen::ArrayXd correlation =
      smooth_share_ + rough_share_ * roughness.square() +
      horizon_.array().square() / light.amplitude;
  Eigen::VectorXd variance(3 * t);
  for (int c = 0; c < 3; ++c) {
    variance.segment(c * t, t) =
        light.amplitude * local_(c, c) * correlation + level_(c, c);
  }
  return variance;
}

Eigen::VectorXd MarginalLikelihood::LightVariance(
    const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, const LightMode& mode) const {
  const Eigen::Index t = num_texels(), P = num_points_;
  const Given given = GivenBy(matrices, errors, hyperparameters);
  const Light& light = given.light;
  const Point point = At(given, mode.level, mode.l);
  const auto linear = Linearise(given, point, DataAt(given, point));
  CHECK(linear != nullptr);
  RowMatrix inverse = linear->factor;
  InvertFactored(&inverse);
  // diag(K - K J^T A^-1 J K), row by row of J K.
  Eigen::VectorXd variance = PriorLightVariance(hyperparameters);
  for (int c = 0; c < 3; ++c) {
    RowMatrix JK(3 * P, t);  // cov(data, l_c)
    for (int d = 0; d < 3; ++d) {
      JK.middleRows(d * P, P) =
          (light.amplitude * local_(d, c) * linear->JC[d]).array() +
          level_(d, c);
    }
    JK.array().colwise() *= linear->row_scale.array();
    RowMatrix product;
    MultiplyInTiles(inverse, JK, num_threads_, &product);
    variance.segment(c * t, t) -=
        product.cwiseProduct(JK).colwise().sum().transpose();
  }
  return variance.cwiseMax(0.0);
}

MarginalLikelihood::FunctionVariance MarginalLikelihood::LightFunctionVariance(
    const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, const LightMode& mode,
    const RowMatrix& functions) const {
  CHECK_EQ(functions.rows(), num_texels());
  const Eigen::Index count = functions.cols();
  const Given given = GivenBy(matrices, errors, hyperparameters);
  const Point point = At(given, mode.level, mode.l);
  const auto linear = Linearise(given, point, DataAt(given, point));
  CHECK(linear != nullptr);
  FunctionVariance out;
  out.prior = out.posterior = Eigen::VectorXd::Zero(count);
  RowMatrix data(3 * num_points_, count);  // cov(data, function)
  for (int c = 0; c < 3; ++c) {
    for (Eigen::Index i = 0; i < count; ++i) {
      Eigen::VectorXd f = Eigen::VectorXd::Zero(num_latents());
      f.segment(Eigen::Index{c} * num_sources(), num_texels()) =
          functions.col(i);
      const Eigen::VectorXd Kf = ApplyCovariance(given.light, f);
      out.prior[i] += f.dot(Kf);
      data.col(i) = linear->row_scale.cwiseProduct(ApplyJacobian(*linear, Kf));
    }
    // f^T (K - K J^T A^-1 J K) f.
    const RowMatrix whitened =
        linear->factor.triangularView<Eigen::Lower>().solve(data);
    out.posterior -= whitened.colwise().squaredNorm().transpose();
  }
  out.posterior = (out.prior + out.posterior).cwiseMax(0.0);
  return out;
}

}  // namespace ibrdf

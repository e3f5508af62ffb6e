#include "ibrdf/solvers/priors/light_spectrum.h"

#include <glog/logging.h>

#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {

LightSpectrum::LightSpectrum(int height, int width,
                             const Correlation& correlation)
    : height_(height), width_(width) {
  CHECK(height > 0 && width > 0 && width % 2 == 0);
  auto basis = std::make_shared<RowMatrix>(width, width);
  for (int c = 0; c < width; ++c) {
    for (int j = 0; j < width; ++j) {
      const int k = FrequencyOf(j);
      const double angle = 2 * kPi * k * c / width;
      const double norm = k == 0 || 2 * k == width ? 1.0 : 2.0;
      (*basis)(c, j) =
          std::sqrt(norm / width) *
          (j % 2 == 1 || j == 0 ? std::cos(angle) : std::sin(angle));
    }
  }
  basis_ = std::move(basis);
  blocks_.assign(num_frequencies(), RowMatrix(height, height));
  RowMatrix cosines(num_frequencies(), width);
  for (int k = 0; k < num_frequencies(); ++k) {
    for (int c = 0; c < width; ++c) {
      cosines(k, c) = std::cos(2 * kPi * k * c / width);
    }
  }
  Eigen::VectorXd row(width);
  for (int a = 0; a < height; ++a) {
    const Eigen::Vector3d from = MapDirection(a + 0.5, 0.5, height, width);
    for (int b = 0; b <= a; ++b) {
      for (int c = 0; c < width; ++c) {
        row[c] =
            correlation(from, MapDirection(b + 0.5, c + 0.5, height, width));
      }
      if (a == b) row[0] = 1.0;
      const Eigen::VectorXd by_frequency = cosines * row;
      for (int k = 0; k < num_frequencies(); ++k) {
        blocks_[k](a, b) = blocks_[k](b, a) = by_frequency[k];
      }
    }
  }
}

void LightSpectrum::Multiply(const RowMatrix& X, RowMatrix* out) const {
  const Eigen::Index n = X.rows(), H = height_, W = width_;
  CHECK_EQ(X.cols(), H * W);
  // A row of X is H rows of W values: one product takes all to coefficients.
  using Rows = Eigen::Map<const RowMatrix>;
  RowMatrix coefficients;
  ibrdf::Multiply(Rows(X.data(), n * H, W), *basis_, &coefficients);
  // Coefficient by coefficient: [n][H] times S_k.
  RowMatrix gathered(n, H), weighted;
  for (int j = 0; j < width_; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      gathered.row(i) = coefficients.col(j).segment(i * H, H).transpose();
    }
    ibrdf::Multiply(gathered, blocks_[FrequencyOf(j)], &weighted);
    for (Eigen::Index i = 0; i < n; ++i) {
      coefficients.col(j).segment(i * H, H) = weighted.row(i).transpose();
    }
  }
  RowMatrix back;
  MultiplyTransposed(coefficients, *basis_, &back);
  *out = Rows(back.data(), n, H * W);
}

LightSpectrum LightSpectrum::Scaled(double share,
                                    const Eigen::VectorXd& by_row) const {
  CHECK_EQ(by_row.size(), height_);
  LightSpectrum out = *this;
  // Symmetric to the last bit.
  RowMatrix factors = by_row * by_row.transpose();
  factors *= share;
  for (RowMatrix& block : out.blocks_) block.array() *= factors.array();
  return out;
}

LightSpectrum LightSpectrum::PlusRows(const Eigen::VectorXd& value) const {
  CHECK_EQ(value.size(), height_);
  LightSpectrum out = *this;
  out.blocks_[0] += width_ * value * value.transpose();
  return out;
}

LightSpectrum LightSpectrum::Plus(const LightSpectrum& other) const {
  CHECK(other.height_ == height_ && other.width_ == width_);
  LightSpectrum out = *this;
  for (int k = 0; k < num_frequencies(); ++k)
    out.blocks_[k] += other.blocks_[k];
  return out;
}

ProcessSpectrum::ProcessSpectrum(int height, int width,
                                 const LightProcess& process)
    : process_(process),
      smooth_(LightSpectrum(height, width,
                            [&](const auto& a, const auto& b) {
                              return process.Smooth(a, b);
                            })
                  .Scaled(process.smooth_share, Eigen::VectorXd::Ones(height))),
      rough_(height, width, [&](const auto& a, const auto& b) {
        return process.Rough(a, b);
      }) {}

LightSpectrum ProcessSpectrum::At(
    const LightHyperparameters& hyperparameters) const {
  return smooth_.Plus(RoughAt(hyperparameters))
      .PlusRows(std::sqrt(process_.horizon_share *
                          std::exp(-hyperparameters.log_amplitude)) *
                HorizonStep(smooth_.height()));
}

LightSpectrum ProcessSpectrum::RoughAt(
    const LightHyperparameters& hyperparameters) const {
  return rough_.Scaled(process_.rough_share,
                       Roughness(rough_.height(), hyperparameters));
}

}  // namespace ibrdf

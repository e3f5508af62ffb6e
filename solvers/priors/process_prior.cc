#include "ibrdf/solvers/priors/process_prior.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/priors/directional_lights.h"

namespace ibrdf {
namespace {

constexpr int kColumns = 32;

// Texels a side, on average: sides need not be multiples of it.
int BlockSide(int width) {
  int block = 1;
  while (width / (2 * block) >= kColumns) block *= 2;
  return block;
}

// besides: variance of each block by itself.
RowMatrix Precision(const RowMatrix& correlation, double local, double level,
                    const Eigen::VectorXd& besides) {
  RowMatrix precision = (local * correlation).array() + level;
  precision.diagonal() += besides;
  CHECK(Factorise(&precision));
  InvertFactored(&precision);
  return precision;
}

}  // namespace

ProcessPrior::ProcessPrior(
    int height, int width, const LightProcess& process,
    const LightHyperparameters& hyperparameters, double level,
    const std::vector<Eigen::Vector3d>& directional_lights)
    : height_(height),
      width_(width),
      block_rows_(std::max(height / BlockSide(width), 1)),
      block_columns_(width / BlockSide(width)),
      level_(level) {
  std::vector<double> row_sum(block_rows_, 0.0);
  for (int r = 0; r < height; ++r) {
    row_sum[BlockRow(r)] += TexelSolidAngle(r, height, width);
  }
  for (int r = 0; r < height; ++r) {
    row_weight_.push_back(TexelSolidAngle(r, height, width) /
                          row_sum[BlockRow(r)]);
  }
  std::vector<int> columns(block_columns_, 0);
  for (int x = 0; x < width; ++x) ++columns[BlockColumn(x)];
  for (int x = 0; x < width; ++x) {
    column_weight_.push_back(1.0 / columns[BlockColumn(x)]);
  }
  const RowMatrix correlation =
      LightCorrelation(block_rows_, block_columns_, process, hyperparameters);
  const double amplitude = std::exp(hyperparameters.log_amplitude);
  Eigen::VectorXd directional_light_share =
      Eigen::VectorXd::Zero(correlation.rows());
  for (const DirectionalLightTexel& near :
       NearDirectionalLights(directional_lights, height, width)) {
    const int row = near.texel / width, column = near.texel % width;
    const double share = WeightOf(row, column) * near.weight;
    directional_light_share[BlockOf(row, column)] += share * share;
  }
  // Along grey the channels add up.
  grey_ = Precision(
      correlation, 3 * amplitude * process.luminance_variance,
      3 * process.level_variance,
      3 * process.directional_light_variance * directional_light_share);
  chroma_ = Precision(
      correlation, amplitude * process.chroma_variance,
      process.level_chroma_variance,
      process.directional_light_chroma_variance * directional_light_share);
}

Eigen::MatrixXd ProcessPrior::Means(const LogMap& log_map) const {
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(grey_.rows(), 3);
  for (int c = 0; c < 3; ++c) {
    const auto plane = log_map.Plane(c);
    for (int r = 0; r < height_; ++r) {
      for (int x = 0; x < width_; ++x) {
        means(BlockOf(r, x), c) += WeightOf(r, x) * plane(r, x);
      }
    }
  }
  return means * ColourAxes().transpose();
}

Eigen::MatrixXd ProcessPrior::Weighted(const Eigen::MatrixXd& means) const {
  Eigen::MatrixXd out(means.rows(), 3);
  out.col(0) = grey_ * means.col(0);
  out.rightCols(2) = chroma_ * means.rightCols(2);
  return out;
}

void ProcessPrior::Spread(const Eigen::MatrixXd& by_mean, LogMap* out) const {
  const Eigen::MatrixXd by_channel = by_mean * ColourAxes();
  for (int c = 0; c < 3; ++c) {
    auto plane = out->Plane(c);
    for (int r = 0; r < height_; ++r) {
      for (int x = 0; x < width_; ++x) {
        plane(r, x) +=
            static_cast<float>(WeightOf(r, x) * by_channel(BlockOf(r, x), c));
      }
    }
  }
}

double ProcessPrior::Evaluate(const LogMap& log_map, LogMap* gradient) {
  Eigen::MatrixXd means = Means(log_map);
  means.col(0).array() -= std::sqrt(3.0) * level_;
  const Eigen::MatrixXd weighted = Weighted(means);
  if (gradient != nullptr) Spread(weighted, gradient);
  return 0.5 * means.cwiseProduct(weighted).sum();
}

void ProcessPrior::AddProduct(const LogMap& v, LogMap* out) const {
  Spread(Weighted(Means(v)), out);
}

}  // namespace ibrdf

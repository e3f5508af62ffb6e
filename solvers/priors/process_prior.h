// The Gaussian process of natural light as a prior on a map of any size.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/solvers/optim/dense_algebra.h"
#include "ibrdf/solvers/priors/light_prior.h"
#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {

// 1/2 (D l - m)^T K^-1 (D l - m): D means of log radiance over blocks that
// leave 32 to 63 columns, K the covariance of LightProcess between the blocks'
// centres, m one level for all channels. Finer detail is left to others. Blocks
// at the directional lights (unit directions) vary besides by what their texels
// of NearDirectionalLights do, each by itself.
class ProcessPrior final : public LightPrior {
 public:
  ProcessPrior(int height, int width, const LightProcess& process,
               const LightHyperparameters& hyperparameters, double level,
               const std::vector<Eigen::Vector3d>& directional_lights = {});

  double Evaluate(const LogMap& log_map, LogMap* gradient) override;
  void AddProduct(const LogMap& v, LogMap* out) const override;

 private:
  int BlockRow(int row) const { return row * block_rows_ / height_; }
  int BlockColumn(int column) const { return column * block_columns_ / width_; }
  int BlockOf(int row, int column) const {
    return BlockRow(row) * block_columns_ + BlockColumn(column);
  }
  // The weight of a texel in the mean of its block.
  double WeightOf(int row, int column) const {
    return row_weight_[row] * column_weight_[column];
  }
  // Means over blocks as [blocks][3], in axes of grey and two of chroma.
  Eigen::MatrixXd Means(const LogMap& log_map) const;
  // Precision times those.
  Eigen::MatrixXd Weighted(const Eigen::MatrixXd& means) const;
  // out += D^T of them.
  void Spread(const Eigen::MatrixXd& by_mean, LogMap* out) const;

  int height_, width_, block_rows_, block_columns_;
  std::vector<double> row_weight_, column_weight_;
  double level_;
  RowMatrix grey_, chroma_;  // precisions of the two kinds of axes
};

}  // namespace ibrdf

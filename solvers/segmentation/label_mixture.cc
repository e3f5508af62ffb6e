#include "ibrdf/solvers/segmentation/label_mixture.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/solvers/segmentation/normal_polynomials.h"

namespace ibrdf {
namespace {

constexpr int kDegree = 2;
constexpr double kStudentDegrees = 4.0;
constexpr int kNoiseRounds = 4;  // of weights by Student's t
constexpr double kLeastNoise = 0.03;
constexpr double kRidge = 0.01;
constexpr double kLeastWeight = 1e-9;
// A pixel's own weight beside its neighbours'.
constexpr double kOwn = 0.15;
constexpr int kFieldRounds = 8;
constexpr double kStartShare = 0.9;  // of the label that a pixel begins with

using Shares = Eigen::MatrixXd;  // [pixels][materials]

Shares SharesOf(const Labelling& start) {
  const auto count = static_cast<Eigen::Index>(start.labels.size());
  Shares shares =
      Shares::Constant(count, start.count, (1.0 - kStartShare) / start.count);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (start.labels[i] < 0) {
      shares.row(i).setConstant(1.0 / start.count);
    } else {
      shares(i, start.labels[i]) += kStartShare;
    }
  }
  return shares;
}

// -log probability of each pixel's colour by a material that has these shares
// of the pixels.
Eigen::VectorXd CostsOf(const Eigen::MatrixXd& x,
                        const Eigen::MatrixX3d& colours,
                        const Eigen::VectorXd& shares) {
  const Eigen::ArrayXd own = shares.array() + kLeastWeight;
  Eigen::ArrayXd weights = own;
  Eigen::ArrayXd distance;
  double log_noise = 0.0;
  for (int round = 0; round < kNoiseRounds; ++round) {
    const Eigen::MatrixXd xw = x.array().colwise() * weights;
    Eigen::MatrixXd normal = xw.transpose() * x;
    normal.diagonal().array() += kRidge;
    const Eigen::MatrixX3d left =
        colours - x * normal.llt().solve(xw.transpose() * colours);
    Eigen::Matrix3d noise =
        (left.array().colwise() * weights).matrix().transpose() * left /
        weights.sum();
    noise.diagonal().array() += kLeastNoise * kLeastNoise;
    distance = (left * noise.inverse()).cwiseProduct(left).rowwise().sum();
    log_noise = std::log(noise.determinant());
    weights = own * (kStudentDegrees + 3.0) / (kStudentDegrees + distance);
  }
  return 0.5 * ((kStudentDegrees + 3.0) * (distance / kStudentDegrees).log1p() +
                log_noise);
}

// One round of the mean field: halfway to what neighbours and costs say.
void MeanField(const MaterialPixels& pixels, const Eigen::MatrixXd& costs,
               Shares* shares) {
  Shares drawn = -costs;
  for (const PixelPair& pair : pixels.neighbours) {
    drawn.row(pair.first) += pair.alike * shares->row(pair.second);
    drawn.row(pair.second) += pair.alike * shares->row(pair.first);
  }
  drawn.colwise() -= drawn.rowwise().maxCoeff().eval();
  drawn = drawn.array().exp().matrix();
  const Eigen::ArrayXd sums = drawn.rowwise().sum();
  drawn.array().colwise() /= sums;
  *shares = 0.5 * (*shares + drawn);
}

Labelling Hardest(const Shares& shares) {
  Labelling out;
  out.count = static_cast<int>(shares.cols());
  for (Eigen::Index i = 0; i < shares.rows(); ++i) {
    Eigen::Index most;
    shares.row(i).maxCoeff(&most);
    out.labels.push_back(static_cast<int>(most));
  }
  return out;
}

void DropEmpty(Labelling* labelling) {
  std::vector<int> pixels(labelling->count, 0), number(labelling->count, -1);
  for (const int label : labelling->labels) ++pixels[label];
  int count = 0;
  for (int m = 0; m < labelling->count; ++m) {
    if (pixels[m] > 0) number[m] = count++;
  }
  for (int& label : labelling->labels) label = number[label];
  labelling->count = count;
}

}  // namespace

RefinedLabelling RefineLabels(const MaterialPixels& pixels,
                              const Labelling& start, int rounds) {
  const Eigen::MatrixXd x = NormalPolynomials(pixels.normals, kDegree);
  Shares shares = SharesOf(start);
  Eigen::MatrixXd costs(shares.rows(), shares.cols());
  for (int round = 0; round < rounds; ++round) {
    for (Eigen::Index m = 0; m < shares.cols(); ++m) {
      costs.col(m) = kOwn * CostsOf(x, pixels.colours, shares.col(m));
    }
    for (int k = 0; k < kFieldRounds; ++k) MeanField(pixels, costs, &shares);
  }
  RefinedLabelling out{Hardest(shares)};
  out.energy = shares.cwiseProduct(costs).sum();
  const std::vector<int>& labels = out.labelling.labels;
  for (const PixelPair& pair : pixels.neighbours) {
    if (labels[pair.first] != labels[pair.second]) out.energy += pair.alike;
  }
  DropEmpty(&out.labelling);
  return out;
}

}  // namespace ibrdf

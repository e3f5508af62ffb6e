#include "ibrdf/solvers/segmentation/region_merging.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/segmentation/normal_polynomials.h"
#include "ibrdf/solvers/segmentation/pixel_regions.h"

namespace ibrdf {
namespace {

constexpr int kLeastRegion = 25;  // pixels; smaller ones wait
// More regions are noise; the largest are merged.
constexpr size_t kMostRegions = 300;
// The noise before any pixel is seen: its deviation, and what it counts for.
constexpr double kPriorNoise = 0.05, kPriorCount = 5.0;
constexpr double kNone = -std::numeric_limits<double>::infinity();

double LogDeterminant(const Eigen::LLT<Eigen::MatrixXd>& llt) {
  return 2.0 * llt.matrixLLT().diagonal().array().log().sum();
}

double LogDeterminant(const Eigen::Matrix3d& matrix) {
  return std::log(matrix.determinant());
}

// The gamma function of three dimensions, less what is the same for all a.
double LogGamma3(double a) {
  return std::lgamma(a) + std::lgamma(a - 0.5) + std::lgamma(a - 1.0);
}

// All that the evidence needs of a region.
struct Sums {
  Eigen::MatrixXd xx;  // polynomials by polynomials
  Eigen::MatrixX3d xy;
  Eigen::Matrix3d yy = Eigen::Matrix3d::Zero();
  double count = 0.0;

  explicit Sums(Eigen::Index size)
      : xx(Eigen::MatrixXd::Zero(size, size)),
        xy(Eigen::MatrixX3d::Zero(size, 3)) {}
  Sums& operator+=(const Sums& other) {
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    count += other.count;
    return *this;
  }
};

// Log evidence of a region's colours as one material's, nats.
class MaterialEvidence {
 public:
  explicit MaterialEvidence(int degree)
      : precisions_(PolynomialPrecisions(degree)),
        log_prior_(precisions_.array().log().sum()) {}

  double Of(const Sums& sums) const {
    const Eigen::Matrix3d noise =
        Eigen::Matrix3d::Identity() * kPriorNoise * kPriorNoise * kPriorCount;
    Eigen::MatrixXd posterior = sums.xx;
    posterior.diagonal() += precisions_;
    const Eigen::LLT<Eigen::MatrixXd> llt(posterior);
    const Eigen::Matrix3d left =
        noise + sums.yy - sums.xy.transpose() * llt.solve(sums.xy);
    const double known = kPriorCount + sums.count;
    return -1.5 * sums.count * std::log(kPi) +
           1.5 * (log_prior_ - LogDeterminant(llt)) +
           0.5 * kPriorCount * LogDeterminant(noise) -
           0.5 * known * LogDeterminant(left) + LogGamma3(0.5 * known) -
           LogGamma3(0.5 * kPriorCount);
  }

 private:
  const Eigen::VectorXd precisions_;
  const double log_prior_;
};

struct Region {
  std::vector<int> members;  // of FindRegions
  Sums sums;
  double evidence = 0.0;
  bool alive = true;
};

class Merging {
 public:
  Merging(const MaterialPixels& pixels, const MergeSetting& setting)
      : region_(FindRegions(pixels, setting.step)), evidence_(setting.degree) {
    const Eigen::MatrixXd x = NormalPolynomials(pixels.normals, setting.degree);
    const Eigen::MatrixX3d y =
        pixels.colours.rowwise() - pixels.colours.colwise().mean();
    std::vector<std::vector<int>> pixels_of(
        region_.empty()
            ? 0
            : 1 + *std::max_element(region_.begin(), region_.end()));
    for (size_t i = 0; i < region_.size(); ++i) {
      pixels_of[region_[i]].push_back(static_cast<int>(i));
    }
    num_regions_ = pixels_of.size();
    for (const int r : Largest(pixels_of)) {
      Region region{{r}, Sums(x.cols())};
      const Eigen::MatrixXd xr = x(pixels_of[r], Eigen::all);
      const Eigen::MatrixX3d yr = y(pixels_of[r], Eigen::all);
      region.sums.xx = setting.share * xr.transpose() * xr;
      region.sums.xy = setting.share * xr.transpose() * yr;
      region.sums.yy = setting.share * yr.transpose() * yr;
      region.sums.count = setting.share * static_cast<double>(xr.rows());
      region.evidence = evidence_.Of(region.sums);
      regions_.push_back(std::move(region));
    }
    alive_ = static_cast<int>(regions_.size());
    gains_ = Eigen::MatrixXd::Constant(alive_, alive_, kNone);
    for (int i = 0; i < alive_; ++i) SetGains(i, 0, i);
  }

  int num_alive() const { return alive_; }

  // Merges the two regions that gain the most.
  void MergeBest() {
    Eigen::Index i, j;
    gains_.maxCoeff(&i, &j);
    Region& kept = regions_[i];
    Region& gone = regions_[j];
    kept.sums += gone.sums;
    kept.evidence = evidence_.Of(kept.sums);
    kept.members.insert(kept.members.end(), gone.members.begin(),
                        gone.members.end());
    gone.alive = false;
    --alive_;
    gains_.row(j).setConstant(kNone);
    gains_.col(j).setConstant(kNone);
    SetGains(static_cast<int>(i), 0, static_cast<int>(regions_.size()));
  }

  Labelling Labels() const {
    std::vector<int> label_of(num_regions_, -1);
    Labelling out;
    for (const Region& region : regions_) {
      if (!region.alive) continue;
      for (const int member : region.members) label_of[member] = out.count;
      ++out.count;
    }
    for (const int r : region_) out.labels.push_back(label_of[r]);
    return out;
  }

 private:
  // Regions of enough pixels, in order.
  static std::vector<int> Largest(
      const std::vector<std::vector<int>>& pixels_of) {
    std::vector<int> large;
    for (size_t r = 0; r < pixels_of.size(); ++r) {
      if (pixels_of[r].size() >= kLeastRegion) {
        large.push_back(static_cast<int>(r));
      }
    }
    std::stable_sort(large.begin(), large.end(), [&](int a, int b) {
      return pixels_of[a].size() > pixels_of[b].size();
    });
    large.resize(std::min(large.size(), kMostRegions));
    return large;
  }

  // Sets the gains of region i with those from `begin` to `end`.
  void SetGains(int i, int begin, int end) {
    for (int j = begin; j < end; ++j) {
      if (j == i || !regions_[j].alive) continue;
      Sums both = regions_[i].sums;
      both += regions_[j].sums;
      gains_(std::min(i, j), std::max(i, j)) =
          evidence_.Of(both) - regions_[i].evidence - regions_[j].evidence;
    }
  }

  const std::vector<int> region_;  // [pixels]
  const MaterialEvidence evidence_;
  size_t num_regions_ = 0;
  std::vector<Region> regions_;
  int alive_ = 0;
  Eigen::MatrixXd gains_;  // of i < j, nats; kNone elsewhere
};

}  // namespace

std::vector<Labelling> MergeRegions(const MaterialPixels& pixels,
                                    const MergeSetting& setting, int most) {
  std::vector<Labelling> out;
  Merging merging(pixels, setting);
  while (merging.num_alive() > 1) {
    if (merging.num_alive() <= most) out.push_back(merging.Labels());
    merging.MergeBest();
  }
  return out;
}

}  // namespace ibrdf

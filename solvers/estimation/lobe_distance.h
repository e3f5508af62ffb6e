// How far apart the reflectances of lobes are.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"

namespace ibrdf {

// Log-RMSE between lobes as CompareBrdfs has it of their tables, but over some
// thousands of nodes, each with the share of bins around it. Immutable.
class LobeDistance {
 public:
  static constexpr BrdfGridShape kMetricGrid = {36, 16, 24};

  // A coarser grid is quicker and less exact.
  explicit LobeDistance(const LobeFactory& lobes,
                        const BrdfGridShape& grid = kMetricGrid);

  const LobeModel& lobes() const { return *lobes_; }
  // Log of raw values plus the metric's floor, [3][nodes].
  std::vector<double> LogValues(const std::vector<double>& parameters) const;
  // The distance of two such after the best scale of each channel.
  double Aligned(const std::vector<double>& a,
                 const std::vector<double>& b) const;
  // The distance of two such as they are.
  double WithLevel(const std::vector<double>& a,
                   const std::vector<double>& b) const;
  // Mean of a less b, by channel: the log of the best scale of b.
  Eigen::Array3d MeanDifference(const std::vector<double>& a,
                                const std::vector<double>& b) const;

 private:
  // If `aligned`, each channel's mean difference is taken off first.
  double Distance(const std::vector<double>& a, const std::vector<double>& b,
                  bool aligned) const;

  std::unique_ptr<const LobeModel> lobes_;
  std::vector<double> weights_;  // [nodes], sum 1
};

}  // namespace ibrdf

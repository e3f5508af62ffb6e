// Means of a value over points of like colour.
#pragma once
#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

namespace ibrdf {

// Points of like chroma, or of like chroma and luminance, wherever they are:
// their weights fall as a Gaussian of the difference. Values are summed in
// cells half a length wide, so that the time is that of the points.
class ColourMeans {
 public:
  // chroma [points], finite, as ChromaPlane's; length > 0: the Gaussian's
  // deviation.
  ColourMeans(std::vector<Eigen::Array2d> chroma, double length);

  // The mean of `values` [points] for each point; weights [points] >= 0. 0
  // where there is no weight near.
  std::vector<double> OfLikeChroma(const std::vector<double>& values,
                                   const std::vector<double>& weights) const;
  // The same over points whose log luminance is like too, by that length > 0.
  // What is further than 16 lengths from the mean luminance counts as that far.
  std::vector<double> OfLikeColour(const std::vector<double>& values,
                                   const std::vector<double>& weights,
                                   const std::vector<double>& luminance,
                                   double luminance_length) const;

 private:
  using Cell = std::pair<int, int>;
  // Sums by bins of luminance.
  struct Column {
    Eigen::ArrayXd weights, values;
  };

  // bins [points]: 0 .. num_bins - 1.
  std::vector<double> Of(const std::vector<double>& values,
                         const std::vector<double>& weights,
                         const std::vector<int>& bins, int num_bins) const;
  static Column Near(const std::map<Cell, Column>& columns, const Cell& at);

  std::vector<Cell> cells_;  // of each point
};

}  // namespace ibrdf

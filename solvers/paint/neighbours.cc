#include "ibrdf/solvers/paint/neighbours.h"

#include <glog/logging.h>

#include <unordered_map>

namespace ibrdf {

std::vector<NeighbourPair> NeighboursOf(const std::vector<ShadingPoint>& points,
                                        int image_width) {
  CHECK_GT(image_width, 0);
  std::unordered_map<int, int> point_of;
  for (size_t i = 0; i < points.size(); ++i) {
    point_of[points[i].pixel] = static_cast<int>(i);
  }
  std::vector<NeighbourPair> pairs;
  for (size_t i = 0; i < points.size(); ++i) {
    const int pixel = points[i].pixel;
    const bool last_column = (pixel + 1) % image_width == 0;
    for (const int other :
         {last_column ? -1 : pixel + 1, pixel + image_width}) {
      const auto found = point_of.find(other);
      if (found == point_of.end()) continue;
      const double turn =
          (points[i].normal - points[found->second].normal).norm();
      pairs.push_back({static_cast<int>(i), found->second, turn});
    }
  }
  return pairs;
}

double WeightOfTurn(double turn) {
  constexpr double kCrease = 0.05;
  const double of_crease = turn / kCrease;
  return 1.0 / (1.0 + of_crease * of_crease);
}

}  // namespace ibrdf

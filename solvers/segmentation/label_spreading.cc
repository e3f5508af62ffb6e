#include "ibrdf/solvers/segmentation/label_spreading.h"

#include <glog/logging.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace ibrdf {
namespace {

// Pixels without a way over the object to a labelled one are few: each asks
// them all.
int LabelOfNearest(const std::vector<ShadingPoint>& points, int image_width,
                   const std::vector<int>& labels, size_t point) {
  int64_t least = std::numeric_limits<int64_t>::max();
  int label = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (labels[i] < 0) continue;
    const int64_t x =
        points[i].pixel % image_width - points[point].pixel % image_width;
    const int64_t y =
        points[i].pixel / image_width - points[point].pixel / image_width;
    if (x * x + y * y >= least) continue;
    least = x * x + y * y;
    label = labels[i];
  }
  return label;
}

}  // namespace

void SpreadLabels(const std::vector<ShadingPoint>& points, int image_width,
                  std::vector<int>* labels) {
  CHECK_GT(image_width, 0);
  CHECK_EQ(points.size(), labels->size());
  std::unordered_map<int, size_t> point_of;
  std::vector<size_t> front;
  for (size_t i = 0; i < points.size(); ++i) {
    point_of[points[i].pixel] = i;
    if ((*labels)[i] >= 0) front.push_back(i);
  }
  CHECK(!front.empty());
  while (!front.empty()) {
    std::vector<size_t> next;
    for (const size_t i : front) {
      const int pixel = points[i].pixel;
      const int x = pixel % image_width;
      for (const int beside :
           {x > 0 ? pixel - 1 : -1, x + 1 < image_width ? pixel + 1 : -1,
            pixel - image_width, pixel + image_width}) {
        const auto found = point_of.find(beside);
        if (found == point_of.end() || (*labels)[found->second] >= 0) continue;
        (*labels)[found->second] = (*labels)[i];
        next.push_back(found->second);
      }
    }
    front = std::move(next);
  }
  const std::vector<int> reached = *labels;
  for (size_t i = 0; i < points.size(); ++i) {
    if (reached[i] < 0) {
      (*labels)[i] = LabelOfNearest(points, image_width, reached, i);
    }
  }
}

}  // namespace ibrdf

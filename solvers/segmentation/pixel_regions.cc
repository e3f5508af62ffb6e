#include "ibrdf/solvers/segmentation/pixel_regions.h"

#include <numeric>

namespace ibrdf {
namespace {

// Sets that are joined, each called by one of its members.
class JoinedSets {
 public:
  explicit JoinedSets(int count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int NameOf(int i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void Join(int i, int j) { parent_[NameOf(i)] = NameOf(j); }

 private:
  std::vector<int> parent_;
};

}  // namespace

std::vector<int> FindRegions(const MaterialPixels& pixels, double step) {
  JoinedSets sets(pixels.count());
  for (const PixelPair& pair : pixels.neighbours) {
    if (!pair.by_side) continue;
    const double difference =
        (pixels.smooth.row(pair.first) - pixels.smooth.row(pair.second))
            .cwiseAbs()
            .maxCoeff();
    if (difference < step) sets.Join(pair.first, pair.second);
  }
  std::vector<int> number(pixels.count(), -1), region(pixels.count());
  int count = 0;
  for (int i = 0; i < pixels.count(); ++i) {
    int& of_set = number[sets.NameOf(i)];
    if (of_set < 0) of_set = count++;
    region[i] = of_set;
  }
  return region;
}

}  // namespace ibrdf

#include "ibrdf/solvers/segmentation/label_overlap.h"

#include <glog/logging.h>

#include <Eigen/Core>
#include <algorithm>
#include <numeric>

namespace ibrdf {

double Agreement(const Labelling& a, const Labelling& b) {
  constexpr int kMost = 8;  // orders of the names are all tried
  CHECK_EQ(a.labels.size(), b.labels.size());
  const int size = std::max(a.count, b.count);
  CHECK_LE(size, kMost);
  if (a.labels.empty()) return 1.0;
  Eigen::MatrixXi both = Eigen::MatrixXi::Zero(size, size);
  for (size_t i = 0; i < a.labels.size(); ++i) {
    ++both(a.labels[i], b.labels[i]);
  }
  std::vector<int> name(size);
  std::iota(name.begin(), name.end(), 0);
  int most = 0;
  do {
    int same = 0;
    for (int k = 0; k < size; ++k) same += both(k, name[k]);
    most = std::max(most, same);
  } while (std::next_permutation(name.begin(), name.end()));
  return static_cast<double>(most) / static_cast<double>(a.labels.size());
}

}  // namespace ibrdf

#include "ibrdf/surface/prefiltered_map.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr int kMostDegree = 100;
constexpr double kLeastLeft = 1e-6;
// A texel of the result is a quarter of the finest wave or less.
constexpr int kRowsPerDegree = 2;
constexpr int kFewestRows = 64;
// Light of finer maps is a mean over their texels first: of 256 rows, as in the
// published code.
constexpr int kMostRows = 256;

}  // namespace

Image PrefilterMap(const Image& map, double alpha, int num_threads) {
  CHECK(alpha > 0.0 && alpha <= 1.0);
  const int order = std::min(
      kMostDegree,
      static_cast<int>(std::ceil(std::sqrt(-std::log(kLeastLeft)) / alpha)));
  const Image small =
      map.height > kMostRows ? ResizeMap(map, kMostRows, 2 * kMostRows) : map;
  HarmonicColours coefficients =
      HarmonicProjection(order, small.height, small.width)
          .Project(small.rgb.data());
  for (int l = 0; l <= order; ++l) {
    const double left = std::exp(-alpha * alpha * l * l);
    coefficients.middleRows(HarmonicIndex(l, -l), 2 * l + 1) *= left;
  }
  const int height = std::max(kFewestRows, kRowsPerDegree * order);
  Image out(2 * height, height);
  const HarmonicBasis basis(order);
  ParallelFor(height, num_threads, [&](int64_t row, int) {
    Eigen::VectorXd Y(basis.count());
    for (int column = 0; column < out.width; ++column) {
      basis.Evaluate(MapDirection(static_cast<double>(row) + 0.5, column + 0.5,
                                  out.height, out.width),
                     Y.data());
      const Eigen::Vector3d L = coefficients.transpose() * Y;
      Eigen::Map<Eigen::Vector3f>(out.At(column, static_cast<int>(row))) =
          L.cast<float>();
    }
  });
  return out;
}

}  // namespace ibrdf

#include "ibrdf/render/reference_radiance.h"

#include <algorithm>

namespace ibrdf {
namespace {

// Well below a second at reference quality, enough to keep the threads busy.
constexpr size_t kPointsPerStep = 2048;

}  // namespace

bool ReferenceRadiance::Render(const std::vector<ShadingPoint>& points,
                               const Progress& progress, double* L_o) const {
  for (size_t begin = 0; begin < points.size(); begin += kPointsPerStep) {
    if (progress && !progress(static_cast<double>(begin) / points.size())) {
      return false;
    }
    const size_t end = std::min(begin + kPointsPerStep, points.size());
    const std::vector<ShadingPoint> some(points.begin() + begin,
                                         points.begin() + end);
    if (table_ != nullptr) {
      renderer_.Render(some, *table_, L_o + 3 * begin, emitted_, rules_);
    } else if (surface_) {
      renderer_.Render(some, surface_, function_, L_o + 3 * begin, emitted_);
    } else {
      renderer_.Render(some, function_, L_o + 3 * begin, emitted_, rules_);
    }
  }
  return true;
}

}  // namespace ibrdf

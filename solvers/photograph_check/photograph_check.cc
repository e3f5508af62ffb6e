#include "ibrdf/solvers/photograph_check/photograph_check.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/solvers/photograph_check/normal_samples.h"

namespace ibrdf {
namespace {

void SetPercentiles(const Image& radiance,
                    const std::vector<ShadingPoint>& points,
                    PhotographCheck* check) {
  std::vector<float> values;
  values.reserve(3 * points.size());
  for (const ShadingPoint& point : points) {
    const float* const rgb =
        &radiance.rgb[3 * static_cast<size_t>(point.pixel)];
    if (KindOfPixel(rgb, check->codes) != PixelKind::kUsed) continue;
    values.insert(values.end(), rgb, rgb + 3);
  }
  if (values.empty()) return;
  const auto at = [&](size_t percent) {
    const auto rank =
        values.begin() + static_cast<long>(percent * (values.size() - 1) / 100);
    std::nth_element(values.begin(), rank, values.end());
    return static_cast<double>(*rank);
  };
  check->radiance_1 = at(1);
  check->radiance_99 = at(99);
}

}  // namespace

const NormalScore* PhotographCheck::AsGiven() const {
  for (const NormalScore& score : normals) {
    if (score.hypothesis == NormalHypothesis::kAsGiven) return &score;
  }
  return nullptr;
}

const NormalScore* PhotographCheck::BetterNormals() const {
  const NormalScore* const given = AsGiven();
  if (given == nullptr ||
      given->disagreement - normals.front().disagreement < kClearlyBetter) {
    return nullptr;
  }
  return &normals.front();
}

PhotographCheck CheckPhotograph(const LookInput& input) {
  PhotographCheck check;
  check.width = input.radiance.width;
  check.height = input.radiance.height;
  check.has_mask = !input.mask.empty();
  check.mask_pixels =
      check.has_mask ? input.mask.CountInside() : input.radiance.num_pixels();
  check.codes = input.codes;
  check.curve = input.curve;
  check.exposure = input.exposure;
  check.missing = input.missing;
  check.overlap = input.overlap;
  check.counts = CountPixels(input.radiance, input.points, input.codes);
  SetPercentiles(input.radiance, input.points, &check);
  const std::vector<NormalSample> samples =
      SampleNormals(input.radiance, input.points);
  check.colours = SpreadOfColours(samples);
  check.colour_steps = SharpColourSteps(samples, check.width, check.height);
  check.like_normals = SpreadOfLikeNormals(samples, input.points);
  if (!input.normal_map.empty()) {
    check.normals = RankNormalHypotheses(input.normal_map, input.mask);
  }
  return check;
}

}  // namespace ibrdf

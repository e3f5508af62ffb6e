#include "ibrdf/solvers/paint/apparent_paint.h"

#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ibrdf/base/median.h"
#include "ibrdf/solvers/paint/chroma_plane.h"

namespace ibrdf {
namespace {

// The apparent paint of one point.
struct Apparent {
  Eigen::Array3d log_albedo = Eigen::Array3d::Zero();
  bool seen = false;
};

Apparent ApparentAlbedo(const UnpaintedRadiance& unpainted,
                        const Observations& observed, size_t point) {
  Apparent out;
  if (!observed.valid[point]) return out;
  for (int c = 0; c < 3; ++c) {
    const size_t i = 3 * point + c;
    const double I = observed.radiance[i];
    const double matte = I - unpainted.gloss[i];
    if (!(matte > kLeastMatteShare * I) || !(unpainted.matte[i] > 0.0)) {
      return out;
    }
    out.log_albedo[c] = std::log(matte / unpainted.matte[i]);
  }
  out.seen = out.log_albedo.isFinite().all();
  return out;
}

ApparentPaint ApparentPaintOf(const UnpaintedRadiance& unpainted,
                              const Observations& observed) {
  ApparentPaint out;
  for (size_t i = 0; i < observed.valid.size(); ++i) {
    const Apparent apparent = ApparentAlbedo(unpainted, observed, i);
    out.chroma.push_back(ChromaPlane(apparent.log_albedo));
    out.luminance.push_back(apparent.log_albedo.mean());
    out.seen.push_back(apparent.seen ? 1.0 : 0.0);
  }
  return out;
}

// The median; of an even number what is nearest to 0 between the middle two.
double MedianStep(std::vector<double> steps) {
  std::sort(steps.begin(), steps.end());
  return std::clamp(0.0, steps[(steps.size() - 1) / 2],
                    steps[steps.size() / 2]);
}

// Luminance and the two axes of chroma.
using PaintColour = std::array<double, 3>;

PaintColour ColourAt(const ApparentPaint& paint, size_t point) {
  return {paint.luminance[point], paint.chroma[point][0],
          paint.chroma[point][1]};
}

PaintColour Minus(const PaintColour& a, const PaintColour& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// By coordinate; `median` of a list of numbers. colours: at least one.
template <typename Median>
PaintColour MedianColour(const std::vector<PaintColour>& colours,
                         Median median) {
  if (colours.size() == 1) return colours[0];
  PaintColour out;
  for (size_t axis = 0; axis < out.size(); ++axis) {
    std::vector<double> values;
    for (const PaintColour& colour : colours) values.push_back(colour[axis]);
    out[axis] = median(std::move(values));
  }
  return out;
}

// Moves an image's paint to the level and hue of another's.
void TakeLevelOf(const ApparentPaint& first, ApparentPaint* image) {
  std::vector<PaintColour> apart;
  for (size_t i = 0; i < first.seen.size(); ++i) {
    if (first.seen[i] == 0.0 || image->seen[i] == 0.0) continue;
    apart.push_back(Minus(ColourAt(*image, i), ColourAt(first, i)));
  }
  if (apart.empty()) return;
  const auto [level, u, v] = MedianColour(apart, UpperMedian<double>);
  for (size_t i = 0; i < first.seen.size(); ++i) {
    image->luminance[i] -= level;
    image->chroma[i] -= Eigen::Array2d(u, v);
  }
}

}  // namespace

std::vector<ApparentPaint> ApparentPaintsOf(
    const std::vector<PaintedImage>& images) {
  CHECK(!images.empty());
  const size_t count = images.front().observed->valid.size();
  std::vector<ApparentPaint> out;
  for (const auto& [unpainted, observed] : images) {
    CHECK_EQ(observed->valid.size(), count);
    CHECK_EQ(unpainted->matte.size(), 3 * count);
    out.push_back(ApparentPaintOf(*unpainted, *observed));
    if (out.size() > 1) TakeLevelOf(out[0], &out.back());
  }
  return out;
}

ApparentPaint Together(const std::vector<ApparentPaint>& images) {
  ApparentPaint out = images.front();
  for (size_t i = 0; images.size() > 1 && i < out.seen.size(); ++i) {
    std::vector<PaintColour> colours;
    for (const ApparentPaint& image : images) {
      if (image.seen[i] != 0.0) colours.push_back(ColourAt(image, i));
    }
    if (colours.empty()) continue;
    const auto [luminance, u, v] = MedianColour(colours, UpperMedian<double>);
    out.seen[i] = 1.0;
    out.luminance[i] = luminance;
    out.chroma[i] = {u, v};
  }
  return out;
}

ApparentStep StepOf(const std::vector<ApparentPaint>& images,
                    const NeighbourPair& pair) {
  const size_t a = pair.first, b = pair.second;
  std::vector<PaintColour> steps;
  for (const ApparentPaint& image : images) {
    if (image.seen[a] == 0.0 || image.seen[b] == 0.0) continue;
    steps.push_back(Minus(ColourAt(image, b), ColourAt(image, a)));
  }
  if (steps.empty()) return {};
  const auto [luminance, u, v] = MedianColour(steps, MedianStep);
  return {luminance, {u, v}, true};
}

}  // namespace ibrdf

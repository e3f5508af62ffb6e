#include "ibrdf/solvers/estimation/reflectance_given_light.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/candidate_search.h"
#include "ibrdf/solvers/estimation/known_light_covariance.h"

namespace ibrdf {
namespace {

// Across the disc of normals: what a few dozen parameters under known light can
// learn from.
constexpr int kBins = 26;
// A highlight is rendered wrong where it is brighter than the image by this
// factor more than any pixel that was fitted is.
constexpr double kWrongFactor = 2.0;

// The pixels in which a bright texel of the known map would be seen if the
// object were a mirror. One pixel per bin may leave the peak of a lobe that is
// narrower than a bin without any.
Observation HighlightsOf(const SolveSetup& setup, const Observation& pixels) {
  std::vector<Eigen::Vector3d> lights;
  for (const BrightSample& sample : setup.transport.bright) {
    lights.push_back(sample.direction);
  }
  return Highlights(pixels, lights, 2.0 / kBins);
}

// The largest factor by which an estimate is brighter than the image at some
// pixels.
double LargestExcess(const Estimate& estimate, const SolveSetup& setup,
                     ObservedPixels* pixels) {
  std::vector<double> L_o(3 * pixels->points().size());
  pixels->TransportFrom(setup.map_size())
      .Render(setup.lobes->Grid(estimate.iterate.state.lobes.data()),
              setup.known_map.data(), L_o.data());
  double largest = 1.0;
  for (size_t i = 0; i < L_o.size(); ++i) {
    if (!pixels->observed().valid[i / 3]) continue;
    largest = std::max(largest, (L_o[i] + estimate.iterate.ambient[i % 3]) /
                                    pixels->observed().Interval(i).high);
  }
  return largest;
}

// Whether an estimate has a peak that no pixel it was fitted to shows.
bool HasFalsePeak(const Estimate& estimate, const Observation& highlights,
                  const SolveSetup& setup) {
  if (highlights.points.empty()) return false;
  ObservedPixels pixels(setup, highlights);
  return LargestExcess(estimate, setup, &pixels) >
         kWrongFactor * LargestExcess(estimate, setup, estimate.pixels.get());
}

}  // namespace

void SetCovariance(const SolveSetup& setup, const SolveContext& context,
                   Estimate* estimate) {
  if (!context.IterationsLeft() || context.StopAfter(1.0)()) return;
  const Iterate& iterate = estimate->iterate;
  estimate->reflectance.covariance = KnownLightCovariance(
      estimate->pixels->TransportFrom(setup.map_size()), *setup.lobes,
      setup.materials, setup.known_map, estimate->pixels->observed(),
      LikelihoodOf(setup, iterate.scale, iterate.ambient), iterate.state.lobes);
}

Estimate EstimateLobesGivenLight(const SolveSetup& setup,
                                 const Observation& pixels,
                                 SolveContext* context) {
  // Pixels as they are: under a known directional light the mean of a bin is
  // not the radiance of its mean normal.
  const Observation bins = OnePixelPerBin(pixels, kBins);
  const Observation highlights = HighlightsOf(setup, pixels);
  const Observation both = Union(bins, highlights);
  // Under a lamp and nothing else every pixel shows one angle alone.
  const bool lamp = setup.problem->dark.num_unlit > 0;
  Estimate estimate =
      CandidateSearch(setup, lamp ? both : bins, context).Run(nullptr);
  if (!lamp && context->IterationsLeft() && !context->Interrupted() &&
      context->Remaining() >= 0.0 &&
      HasFalsePeak(estimate, highlights, setup)) {
    estimate = CandidateSearch(setup, both, context).Run(&estimate);
  }
  return estimate;
}

Estimate EstimateReflectanceGivenLight(const SolveSetup& setup,
                                       SolveContext* context) {
  Estimate estimate = EstimateLobesGivenLight(setup, setup.pixels, context);
  estimate.reflectance.candidates.clear();
  SetCovariance(setup, *context, &estimate);
  return estimate;
}

}  // namespace ibrdf

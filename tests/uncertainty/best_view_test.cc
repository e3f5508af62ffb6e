#include "ibrdf/uncertainty/best_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/uncertainty/random_samples.h"

namespace ibrdf {
namespace {

constexpr int kTexels = 12, kCandidateViews = 24;

TexelSamples Candidates() {
  std::mt19937 rng(41);
  TexelSamples samples = EmptySamples(kTexels, kCandidateViews);
  RandomDirections(&rng, &samples);
  FillByModel(4, 0.2, 0.6, 0.2, &rng, &samples);
  return samples;
}

BestViewOptions SmallGrid() {
  BestViewOptions options;
  options.spectrum.fit.order = 3;
  options.spectrum.num_alpha = 4;
  options.spectrum.num_ks = 5;
  options.spectrum.sigma = 0.1;
  return options;
}

// The samples with the weights of a set of views alone.
TexelSamples Only(const TexelSamples& samples, const std::vector<int>& views) {
  TexelSamples out = samples;
  out.weight.assign(out.weight.size(), 0.0f);
  for (int texel = 0; texel < out.num_texels; ++texel) {
    for (const int view : views) {
      out.weight[texel * kCandidateViews + view] =
          samples.weight[texel * kCandidateViews + view];
    }
  }
  return out;
}

// Eq. 13 as it stands: a refit of the light for each set of views, and the
// entropy of each hypothetical observation by the evaluator.
double PlainExpected(const TexelSamples& samples, std::vector<int> views,
                     int candidate, const BestViewOptions& options) {
  const SpectrumOptions& spectrum = options.spectrum;
  views.push_back(candidate);
  const PowerSpectra light =
      FitPowerSpectra(Only(samples, views), spectrum.fit, 1.0, 1);
  double sum = 0.0;
  for (const double alpha :
       AlphaValues(spectrum.alpha_grid, spectrum.num_alpha)) {
    for (const double Ks : UnitValues(spectrum.num_ks)) {
      PowerSpectra shown = light;
      for (int l = 0; l <= spectrum.fit.order; ++l) {
        const double e = Ks * FilterOf(spectrum.filter, alpha, l);
        for (int64_t k = 0; k < light.num_signals; ++k) {
          shown.outgoing[l * light.num_signals + k] = static_cast<float>(
              e * e * light.incoming[l * light.num_signals + k]);
        }
      }
      for (const float H : EntropyOfSpectra(shown, spectrum, 0.0, 1).entropy) {
        sum += H;
      }
    }
  }
  return sum / (3.0 * kTexels * spectrum.num_alpha * spectrum.num_ks);
}

TEST(BestViewSearch, ExpectsWhatRefitsExpect) {
  constexpr double kSinglePrecision = 1e-4;
  const TexelSamples samples = Candidates();
  for (const bool published : {false, true}) {
    BestViewOptions options = SmallGrid();
    if (published) {
      SpectrumOptions spectrum = SpectrumOptions::Published(1e-3);
      spectrum.fit.order = 3;
      spectrum.num_alpha = 4;
      spectrum.num_ks = 5;
      options.spectrum = spectrum;
    }
    BestViewSearch search(samples, options, 1);
    const std::vector<int> taken{3, 8, 20};
    for (const int view : taken) search.Add(view, true);
    const std::vector<double> expected = search.ExpectedEntropies();
    for (const int candidate : {0, 7, 23}) {
      EXPECT_NEAR(PlainExpected(samples, taken, candidate, options),
                  expected[candidate], kSinglePrecision)
          << published;
    }
    for (const int view : taken) {
      EXPECT_EQ(std::numeric_limits<double>::infinity(), expected[view]);
    }
  }
}

TEST(BestViewSearch, WeighsByWhatPhotographsSay) {
  const TexelSamples samples = Candidates();
  BestViewOptions options = SmallGrid();
  options.trusted_views = 3;
  BestViewSearch photographed(samples, options, 1);
  BestViewSearch planned(samples, options, 1);
  for (const int view : {3, 8, 20}) {
    photographed.Add(view, true);
    planned.Add(view, false);
  }
  // Plans leave the parameters uniform, as too few photographs do.
  options.trusted_views = 4;
  BestViewSearch few(samples, options, 1);
  for (const int view : {3, 8, 20}) few.Add(view, true);
  EXPECT_EQ(few.ExpectedEntropies(), planned.ExpectedEntropies());
  EXPECT_NE(few.ExpectedEntropies(), photographed.ExpectedEntropies());
}

TEST(BestViewSearch, GivesTheSameBitsForAnyNumberOfThreads) {
  const TexelSamples samples = Candidates();
  BestViewSearch one(samples, SmallGrid(), 1), two(samples, SmallGrid(), 2);
  one.Add(5, true);
  two.Add(5, true);
  EXPECT_EQ(one.ExpectedEntropies(), two.ExpectedEntropies());
}

TEST(BestViewSearch, AViewThatSeesNothingGainsNothing) {
  TexelSamples samples = Candidates();
  for (int texel = 0; texel < kTexels; ++texel) {
    samples.weight[texel * kCandidateViews + 6] = 0.0f;
    samples.weight[texel * kCandidateViews + 9] = 0.0f;
  }
  BestViewSearch search(samples, SmallGrid(), 1);
  search.Add(2, true);
  const std::vector<double> expected = search.ExpectedEntropies();
  EXPECT_EQ(expected[6], expected[9]);
  EXPECT_LT(expected[search.Best()], expected[6]);
}

TEST(BestViews, StopWhereNoneIsLeft) {
  const TexelSamples samples = Candidates();
  const std::vector<int> views =
      BestViews(samples, {4, 1}, kCandidateViews + 5, true, SmallGrid(), 1);
  ASSERT_EQ(static_cast<size_t>(kCandidateViews), views.size());
  EXPECT_EQ(4, views[0]);
  EXPECT_EQ(1, views[1]);
  std::vector<bool> seen(kCandidateViews, false);
  for (const int view : views) {
    EXPECT_FALSE(seen[view]);
    seen[view] = true;
  }
}

TEST(FarthestPoints, TakesTheFarthest) {
  const std::vector<Eigen::Vector3d> points{
      {0, 0, 0}, {1, 0, 0}, {0, 3, 0}, {2, 0, 0}, {0, 3, 0.1}};
  EXPECT_EQ((std::vector<int>{0, 4, 3}), FarthestPoints(points, {}, 3));
  EXPECT_EQ((std::vector<int>{2, 3}), FarthestPoints(points, {2}, 2));
  EXPECT_EQ(5u, FarthestPoints(points, {}, 9).size());
  EXPECT_TRUE(FarthestPoints(points, {}, 0).empty());
}

TEST(BestViewOptions, BadOnesAreNamed) {
  BestViewOptions options;
  EXPECT_TRUE(options.Check().ok());
  options.trusted_views = -1;
  EXPECT_NE(std::string::npos, options.Check().message().find("trusted_views"));
  options = {};
  options.spectrum.sigma = 0.0;
  EXPECT_NE(std::string::npos, options.Check().message().find("sigma"));
}

}  // namespace
}  // namespace ibrdf

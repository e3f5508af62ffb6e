// Seconds of harmonics, fits, entropy and the next view, on two threads, and
// those of the processor, which other programs do not lengthen as much.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "ibrdf/approximation/harmonic_batch.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/stopwatch.h"
#include "ibrdf/uncertainty/angular_entropy.h"
#include "ibrdf/uncertainty/best_view.h"
#include "ibrdf/uncertainty/harmonic_fit.h"
#include "ibrdf/uncertainty/spectrum_entropy.h"

namespace ibrdf {
namespace {

constexpr int kThreads = 2;
constexpr int kRounds = 3;
constexpr int64_t kTexels = 512 * 512;
constexpr int kViews = 100;
// Texels of a block: what a caller holds at a time.
constexpr int kBlock = 1 << 14;

// The least of several rounds.
void Print(const std::string& what, const std::function<void()>& body) {
  double best = 1e30, processor = 1e30;
  for (int round = 0; round < kRounds; ++round) {
    const Stopwatch clock;
    const std::clock_t start = std::clock();
    body();
    best = std::min(best, clock.Seconds());
    processor = std::min(
        processor, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::printf("\"%s\",%.4f,%.4f\n", what.c_str(), best, processor);
  std::fflush(stdout);
}

// Views all over the sphere, and light and surface of a few waves.
TexelSamples RandomTexels(int num_texels) {
  TexelSamples samples;
  samples.num_texels = num_texels;
  samples.num_views = kViews;
  std::mt19937 rng(1);
  std::normal_distribution<float> normal;
  const int64_t count = static_cast<int64_t>(num_texels) * kViews;
  samples.weight.assign(count, 1.0f);
  for (int64_t k = 0; k < count; ++k) {
    float w[3] = {normal(rng), normal(rng), normal(rng)};
    const float size = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (float& x : w) {
      x /= size;
      samples.directions.push_back(x);
    }
    for (int c = 0; c < 3; ++c) {
      const float L = 1.0f + w[c] + w[0] * w[(c + 1) % 3];
      samples.incoming.push_back(L);
      samples.outgoing.push_back(0.3f + 0.3f * L);
    }
  }
  samples.prefilter_alpha = 0.1;
  return samples;
}

void TimeHarmonics() {
  constexpr int64_t kDirections = 26'000'000;
  constexpr int kPiece = 512;
  const HarmonicBatch basis(5);
  std::vector<float> u(kPiece, 0.577f);
  Print("harmonics: 26 M directions x 36", [&] {
    ParallelFor(kDirections / kPiece / 64, kThreads, [&](int64_t, int) {
      std::vector<float> Y(basis.count() * kPiece);
      for (int k = 0; k < 64; ++k) {
        basis.Evaluate(u.data(), u.data(), u.data(), kPiece, Y.data(), kPiece);
      }
    });
  });
}

void TimeEvaluators() {
  const TexelSamples block = RandomTexels(kBlock);
  const auto all_blocks = [&](const std::function<void()>& body) {
    return [body] {
      for (int64_t first = 0; first < kTexels; first += kBlock) body();
    };
  };
  Print("fits: 512x512 texels, 100 views",
        all_blocks([&] { FitPowerSpectra(block, {}, 1.0, kThreads); }));
  const PowerSpectra one = FitPowerSpectra(block, {}, 1.0, kThreads);
  PowerSpectra spectra;
  spectra.order = one.order;
  spectra.num_signals = 3 * kTexels;
  for (int l = 0; l <= one.order; ++l) {
    for (int64_t k = 0; k < kTexels / kBlock; ++k) {
      const auto copy = [&](const std::vector<float>& from,
                            std::vector<float>* to) {
        to->insert(to->end(), from.begin() + l * one.num_signals,
                   from.begin() + (l + 1) * one.num_signals);
      };
      copy(one.outgoing, &spectra.outgoing);
      copy(one.incoming, &spectra.incoming);
    }
  }
  for (const int cells : {8, 16}) {
    SpectrumOptions options;
    options.num_alpha = options.num_ks = cells;
    const std::string size =
        std::to_string(cells) + "x" + std::to_string(cells);
    Print("spectrum entropy: 512x512 texels, " + size,
          [&] { EntropyOfSpectra(spectra, options, 0.1, kThreads); });
  }
  for (const int num_kd : {8, 0}) {
    AngularOptions options;
    options.num_kd = num_kd;
    const AngularEntropyEvaluator evaluator(options);
    Print(num_kd > 0 ? "angular, fits included: 512x512 texels, 8x8x8"
                     : "angular, fits included: 512x512 texels, 8x8",
          all_blocks([&] { evaluator.Evaluate(block, kThreads).value(); }));
  }
}

void TimeBestView() {
  const TexelSamples candidates = RandomTexels(1000);
  BestViewSearch search(candidates, {}, kThreads);
  for (int view = 0; view < 5; ++view) search.Add(view, true);
  Print("best view: 1000 texels, 100 candidates, uniform",
        [&] { search.Best(); });
  for (int view = 5; view < 12; ++view) search.Add(view, true);
  Print("best view: 1000 texels, 100 candidates, by photographs",
        [&] { search.Best(); });
}

}  // namespace
}  // namespace ibrdf

int main() {
  std::printf("part,seconds,processor_seconds\n");
  ibrdf::TimeHarmonics();
  ibrdf::TimeEvaluators();
  ibrdf::TimeBestView();
  return 0;
}

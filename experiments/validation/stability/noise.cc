// Noise and wrong pixels: a reflectance fitted under known light.
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/stability/lobe_fits.h"
#include "experiments/validation/stability/sweeps.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace stability {
namespace {

constexpr int kImageSize = 16;

struct Spoilt {
  double noise = 0.0;     // standard deviation, of the mean radiance
  double outliers = 0.0;  // share of pixels
};

class FitStudy {
 public:
  explicit FitStudy(const NeuralBrdfModel& model)
      : model_(model), scene_(kImageSize), truth_(TrueLobe(model)) {
    // A directional light in a room.
    map_ =
        testing::RandomMap(SphereScene::kMapHeight, SphereScene::kMapWidth, 3);
    for (int y = 3; y < 6; ++y) {
      for (int x = 4; x < 7; ++x) {
        for (int c = 0; c < 3; ++c) map_.At(x, y)[c] = 60.0f;
      }
    }
    const auto field = PreciseField(model, scene_.options.grid, truth_);
    for (const Real L_o : PreciseRadiance(scene_, field, truth_, map_)) {
      radiance_.push_back(static_cast<double>(L_o));
      mean_ += radiance_.back();
    }
    mean_ /= static_cast<double>(radiance_.size());
  }

  void Add(const std::string& sweep, double x, const Spoilt& spoilt,
           const SweepOptions& options, SweepTable* table) const {
    std::vector<double> ours, raw, masked;
    for (int k = 0; k < options.seeds; ++k) {
      const Image image = Observe(spoilt, options.seed + k);
      LobePrior prior;
      std::fill_n(prior.colour_mean, 3, MeanLogColour(model_));
      ours.push_back(Error(FitLibrary(model_, scene_, image, map_, prior)));
      raw.push_back(Error(FitNaive(model_, scene_, image, map_, false)));
      masked.push_back(Error(FitNaive(model_, scene_, image, map_, true)));
    }
    table->Add(sweep, x, "fitted reflectance", kOurs, ours);
    table->Add(sweep, x, "fitted reflectance", kNaive, raw);
    table->Add(sweep, x, "fitted reflectance", "naive masked", masked);
  }

 private:
  double Error(const std::vector<double>& lobe) const {
    return BrdfError(model_, scene_.options.grid, truth_, lobe);
  }

  Image Observe(const Spoilt& spoilt, unsigned seed) const {
    std::mt19937_64 rng(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<double> observed = radiance_;
    for (double& v : observed) v += spoilt.noise * mean_ * normal(rng);
    for (size_t i = 0; i < observed.size(); i += 3) {
      // Dust or a glint of something else.
      const bool bright = uniform(rng) < 0.5;
      if (uniform(rng) >= spoilt.outliers) continue;
      for (int c = 0; c < 3; ++c) observed[i + c] *= bright ? 30.0 : 1.0 / 30;
    }
    return scene_.ImageOf(observed);
  }

  const NeuralBrdfModel& model_;
  const SphereScene scene_;
  const std::vector<double> truth_;
  Image map_;
  std::vector<double> radiance_;
  double mean_ = 0.0;
};

}  // namespace

void SweepNoise(const NeuralBrdfModel& model, const SweepOptions& options,
                SweepTable* table) {
  const FitStudy study(model);
  for (const double noise : {1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0}) {
    study.Add("noise", noise, {noise, 0.0}, options, table);
  }
}

void SweepOutliers(const NeuralBrdfModel& model, const SweepOptions& options,
                   SweepTable* table) {
  const FitStudy study(model);
  for (const double share : {0.003, 0.01, 0.03, 0.1, 0.2, 0.4}) {
    study.Add("outliers", share, {1e-3, share}, options, table);
  }
}

}  // namespace stability
}  // namespace ibrdf

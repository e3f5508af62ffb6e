// Entropy of the evaluators beside that of brute force, and best views beside
// farthest points, on spheres under measured maps; see README.md.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/entropy/brute_force.h"
#include "experiments/entropy/statistics.h"
#include "experiments/entropy/study_scene.h"
#include "ibrdf/base/stopwatch.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/uncertainty/angular_entropy.h"
#include "ibrdf/uncertainty/best_view.h"
#include "ibrdf/uncertainty/spectrum_entropy.h"

namespace ibrdf {
namespace {

// Of brute force; mean squares in units of the map's mean radiance, squared.
constexpr double kSharpness = 1e-2;

using Numbers = std::vector<double>;

Numbers Doubles(const std::vector<float>& v) {
  return Numbers(v.begin(), v.end());
}

// What the uncertainty of a texel is compared with: -log of the power of B.
Numbers TrivialPredictor(const TexelSamples& samples) {
  const PowerSpectra spectra = FitPowerSpectra(samples, {}, 1.0, 0);
  Numbers out(spectra.num_signals);
  for (int texel = 0; texel < samples.num_texels; ++texel) {
    for (int c = 0; c < 3; ++c) {
      double sum = 1e-9;
      for (int l = 1; l <= spectra.order; ++l) {
        sum += spectra.outgoing[l * spectra.num_signals +
                                c * samples.num_texels + texel];
      }
      out[3 * texel + c] = -std::log(sum);
    }
  }
  return out;
}

struct Variant {
  std::string name;
  SpectrumOptions spectrum;
  AngularOptions angular;
  bool is_angular = false;
};

Variant Spectrum(std::string name, SpectrumOptions options) {
  Variant out;
  out.name = std::move(name);
  out.spectrum = std::move(options);
  return out;
}

Variant Angular(std::string name, AngularOptions options) {
  Variant out;
  out.name = std::move(name);
  out.angular = std::move(options);
  out.is_angular = true;
  return out;
}

std::string Named(const char* format, double value) {
  char name[60];
  std::snprintf(name, sizeof(name), format, value);
  return name;
}

// The published form, the defaults, and each mended default undone.
void AddSpectrumVariants(std::vector<Variant>* variants) {
  std::vector<Variant>& out = *variants;
  for (const double denominator : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    const std::string name = Named("published %g", denominator);
    out.push_back(Spectrum(name, SpectrumOptions::Published(denominator)));
  }
  out.push_back(Spectrum("spectrum", {}));
  SpectrumOptions s;
  s.filter = GlossFilter::kBeckmann;
  out.push_back(Spectrum("spectrum, Beckmann", s));
  s = {};
  s.undo_prefilter = false;
  out.push_back(Spectrum("spectrum, prefilter kept", s));
  s = {};
  s.fit.constant_penalty = 1.0;
  out.push_back(Spectrum("spectrum, constant penalised", s));
  s.fit.constant_penalty = 0.3;
  out.push_back(Spectrum("spectrum, constant penalised by 0.3", s));
  s = {};
  s.relative_weights = true;
  out.push_back(Spectrum("spectrum, relative weights", s));
  s = {};
  s.fit.lambda = 1e-2;
  out.push_back(Spectrum("spectrum, lambda 0.01", s));
  s = {};
  s.fit.order = 8;
  out.push_back(Spectrum("spectrum, order 8", s));
  for (const double sigma : {0.025, 0.035, 0.07, 0.1, 0.14}) {
    const std::string name = Named("spectrum, sigma %g", sigma);
    s = {};
    s.sigma = sigma;
    out.push_back(Spectrum(name, s));
  }
  for (const double sigma : {0.04, 0.15, 0.6}) {
    const std::string name = Named("spectrum, Eq. 11, sigma %g", sigma);
    s = {};
    s.distance = SpectrumDistance::kPower;
    s.sigma = sigma;
    out.push_back(Spectrum(name, s));
  }
}

void AddAngularVariants(std::vector<Variant>* variants) {
  std::vector<Variant>& out = *variants;
  out.push_back(Angular("angular", {}));
  AngularOptions a;
  a.filter = GlossFilter::kBeckmann;
  out.push_back(Angular("angular, Beckmann", a));
  a = {};
  a.undo_prefilter = false;
  out.push_back(Angular("angular, prefilter kept", a));
  a = {};
  a.fresnel = a.masking = false;
  out.push_back(Angular("angular, no Fresnel, no masking", a));
  a = {};
  a.num_kd = 0;
  out.push_back(Angular("angular, Kd profiled", a));
  a = {};
  a.fit.constant_penalty = 1.0;
  out.push_back(Angular("angular, constant penalised", a));
  a = {};
  a.fit.lambda = 1e-2;
  out.push_back(Angular("angular, lambda 0.01", a));
  for (const int order : {3, 8}) {
    const std::string name = Named("angular, order %g", order);
    a = {};
    a.fit.order = order;
    out.push_back(Angular(name, a));
  }
  for (const double sigma : {0.05, 0.1, 0.14}) {
    const std::string name = Named("angular, sigma %g", sigma);
    a = {};
    a.sigma = sigma;
    out.push_back(Angular(name, a));
  }
}

std::vector<Variant> Variants() {
  std::vector<Variant> out;
  AddSpectrumVariants(&out);
  AddAngularVariants(&out);
  return out;
}

EntropyMaps Evaluate(const Variant& v, const TexelSamples& samples) {
  return v.is_angular
             ? AngularEntropyEvaluator(v.angular).Evaluate(samples, 0).value()
             : SpectrumEntropyEvaluator(v.spectrum)
                   .Evaluate(samples, 0)
                   .value();
}

// Mean |roughness error| and |Ks error|.
std::pair<double, double> ParameterErrors(const EntropyMaps& maps,
                                          const StudyScene& scene) {
  double roughness = 0.0, Ks = 0.0;
  for (size_t k = 0; k < maps.alpha.size(); ++k) {
    const StudyMaterial& m = scene.materials[k / 3];
    roughness += std::abs(std::sqrt(maps.alpha[k]) - m.roughness);
    Ks += std::abs(maps.Ks[k] - m.Ks[k % 3]);
  }
  const double n = static_cast<double>(maps.alpha.size());
  return {roughness / n, Ks / n};
}

void PrintRow(const std::string& scene, const std::string& name,
              const Numbers& H, const Numbers& brute, const Numbers& trivial,
              const Numbers& error, std::pair<double, double> errors) {
  std::printf("%s,\"%s\",%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", scene.c_str(),
              name.c_str(), Pearson(H, brute), Spearman(H, brute),
              PartialCorrelation(H, brute, trivial), AreaForTopFifth(H, brute),
              Pearson(H, error), errors.first, errors.second);
  std::fflush(stdout);
}

void StudyCorrelation(const StudyScene& scene, const std::string& name) {
  const BruteForce brute = EvaluateBruteForce(scene, {}, kSharpness);
  const Numbers trivial = TrivialPredictor(scene.samples);
  PrintRow(name, "trivial", trivial, brute.entropy, trivial, brute.error, {});
  PrintRow(name, "Laplace", brute.laplace, brute.entropy, trivial, brute.error,
           {});
  for (const Variant& v : Variants()) {
    const EntropyMaps maps = Evaluate(v, scene.samples);
    PrintRow(name, v.name, Doubles(maps.entropy), brute.entropy, trivial,
             brute.error, ParameterErrors(maps, scene));
  }
}

double MeanOf(const Numbers& x) {
  double sum = 0.0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

struct ViewVariant {
  std::string name;
  BestViewOptions options;
  Numbers farthest, best;  // mean entropy of brute force at the last view
};

std::vector<ViewVariant> ViewVariants() {
  std::vector<ViewVariant> out;
  const auto add = [&](std::string name, const BestViewOptions& options) {
    out.push_back({std::move(name), options, {}, {}});
  };
  add("best view", {});
  BestViewOptions o;
  o.spectrum = SpectrumOptions::Published(1e-4);
  add("published 0.0001", o);
  o.published_alpha = true;
  o.published_mask = true;
  add("published 0.0001, its alpha and mask", o);
  o.spectrum = SpectrumOptions::Published(1e-2);
  add("published 0.01, its alpha and mask", o);
  o = {};
  o.trusted_views = 1000;
  add("parameters uniform", o);
  o = {};
  o.spectrum.fit.constant_penalty = 1.0;
  add("constant penalised", o);
  o = {};
  o.spectrum.fit.lambda = 1e-2;
  add("lambda 0.01", o);
  for (const double sigma : {0.025, 0.1, 0.2}) {
    const std::string name = Named("sigma %g", sigma);
    o = {};
    o.spectrum.sigma = sigma;
    add(name, o);
  }
  return out;
}

// From ten farthest points on to twenty views: a row for each variant.
void StudyViews(const StudyScene& scene, const std::string& name,
                std::vector<ViewVariant>* variants) {
  constexpr int kInitial = 10, kMost = 20;
  const std::vector<int> farthest = FarthestPoints(scene.cameras, {}, kMost);
  const std::vector<int> initial(farthest.begin(), farthest.begin() + kInitial);
  const auto score = [&](const std::vector<int>& views, int count) {
    return EvaluateBruteForce(
        scene, std::vector<int>(views.begin(), views.begin() + count),
        kSharpness);
  };
  const BruteForce goal = score(farthest, kMost);
  for (ViewVariant& v : *variants) {
    const Stopwatch clock;
    const std::vector<int> best =
        BestViews(scene.samples, initial, kMost, true, v.options, 0);
    const double seconds = clock.Seconds() / (kMost - kInitial);
    int reached = kInitial;
    while (reached < kMost &&
           MeanOf(score(best, reached).entropy) > MeanOf(goal.entropy)) {
      ++reached;
    }
    const BruteForce last = score(best, kMost);
    v.farthest.push_back(MeanOf(goal.entropy));
    v.best.push_back(MeanOf(last.entropy));
    std::printf("%s,\"%s\",%d,%.4f,%.4f,%.4f,%.4f,%.3f\n", name.c_str(),
                v.name.c_str(), reached, v.farthest.back(), v.best.back(),
                MeanOf(goal.error), MeanOf(last.error), seconds);
    std::fflush(stdout);
  }
}

int Run(const std::vector<std::string>& maps, bool views, bool one_material,
        int texels, unsigned seed) {
  std::printf(
      views ? "scene,search,views_that_reach_20,entropy_farthest,entropy_best,"
              "error_farthest,error_best,seconds_a_view\n"
            : "scene,evaluator,pearson,spearman,partial,auc,"
              "with_error,roughness_error,ks_error\n");
  std::vector<ViewVariant> searches = ViewVariants();
  for (const std::string& path : maps) {
    const StatusOr<Image> map = ReadMap(path, {});
    if (!map.ok()) {
      std::fprintf(stderr, "%s\n", map.status().message().c_str());
      return 2;
    }
    SceneOptions options;
    options.num_texels = texels;
    options.one_material = one_material;
    options.seed = seed++;
    const StudyScene scene = MakeStudyScene(*map, options);
    const std::string name = std::filesystem::path(path).stem().string();
    if (views) {
      StudyViews(scene, name, &searches);
    } else {
      StudyCorrelation(scene, name);
    }
  }
  for (const ViewVariant& v : searches) {
    if (v.best.size() < 2) continue;
    const TTest test = PairedTTest(v.farthest, v.best);
    std::fprintf(stderr, "%s: paired t %.2f, p %.2g\n", v.name.c_str(), test.t,
                 test.p);
  }
  return 0;
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) {
  CLI::App app("Entropy and best views beside brute force.");
  std::vector<std::string> maps;
  bool views = false, one_material = false;
  int texels = 200;
  unsigned seed = 1;
  app.add_option("maps", maps, "environment maps")->required();
  app.add_flag("--views", views, "best views beside farthest points");
  app.add_flag("--one-material", one_material, "the same for all texels");
  app.add_option("--texels", texels, "of the sphere")->capture_default_str();
  app.add_option("--seed", seed, "of the first scene")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return ibrdf::Run(maps, views, one_material, texels, seed);
}

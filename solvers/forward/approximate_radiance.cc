#include "ibrdf/solvers/forward/approximate_radiance.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/image/darkest.h"
#include "ibrdf/render/scene_probe.h"
#include "ibrdf/transport/lobe_bundles.h"

namespace ibrdf {
namespace {

// Seconds of one idle core, measured (experiments/render_speed, `gaussians`).
// Of a point: by quadrature in a preview; in harmonics of order l; in a
// Gaussian. Of a scene: Y at the quadrature's directions, per harmonic; tables
// of Gaussians, each; points that are compared, at reference quality.
constexpr double kQuadraturePoint = 1.3e-4;
constexpr double kHarmonicPoint = 4e-7, kHarmonicCube = 5e-9;
constexpr double kHarmonicScene = 2e-3, kHarmonicSceneEach = 2e-4;
constexpr double kGaussianPoint = 5e-8;
constexpr double kGaussianScene = 1e-2, kGaussianSceneEach = 3e-4;
// A quadrature faster than this is not worth a choice.
constexpr double kWorthChoosing = 0.3;
// Points compared.
constexpr size_t kChecked = 64;
// Of the probe whose spectra tell what an order leaves out.
constexpr int kProbeOrder = 16;
// It does not know what is above its own.
constexpr int kTrustedOrder = kProbeOrder - 3;
constexpr int kProbeViews = 12;
constexpr int kHarmonicViews = 24;
constexpr int kSpreads[] = {64, 128, 256};
// By normal: points compared, and nodes over the number of harmonics that the
// radiance needs, or where those are too many to tell.
constexpr double kMapChecks = 256, kMapNodes = 6, kRoughMapNodes = 4000;
constexpr double kNotPredicted = -1.0;

double Cube(double x) { return x * x * x; }

double HarmonicSeconds(int order, double points) {
  return kHarmonicScene + kHarmonicSceneEach * NumHarmonics(order) +
         points * (kHarmonicPoint + kHarmonicCube * Cube(order + 1));
}
double GaussianSeconds(int spread, double points) {
  return kGaussianScene + (kGaussianSceneEach + kGaussianPoint * points) *
                              static_cast<double>(spread);
}

// Mean |log L_o - log truth| over points and channels, and twice its standard
// error over points.
double ErrorBound(const std::vector<double>& L_o,
                  const std::vector<double>& truth) {
  double mean = 0.0;
  for (const double v : truth) mean += v / static_cast<double>(truth.size());
  if (!(mean > 0.0)) return 0.0;
  const double least = kDarkestShare * mean;
  double sum = 0.0, squares = 0.0;
  const auto count = static_cast<double>(truth.size() / 3);
  for (size_t i = 0; i < truth.size(); i += 3) {
    double error = 0.0;
    for (size_t k = i; k < i + 3; ++k) {
      error += std::abs(std::log(std::max(L_o[k], least) /
                                 std::max(truth[k], least))) /
               3.0;
    }
    sum += error;
    squares += error * error;
  }
  const double variance = squares / count - std::pow(sum / count, 2);
  return sum / count + 2.0 * std::sqrt(std::max(variance, 0.0) / count);
}

}  // namespace

struct ApproximateRadiance::Gaussians {
  Gaussians(const Image& map, const BrdfFunction& brdf, int spread,
            int num_threads)
      : light(map, FitOptions(spread)),
        transport(light.lobes(), Options(num_threads)),
        tables(transport.Tabulate(brdf)),
        amplitudes(light.Fit(map.rgb.data())) {}

  static GaussianFitOptions FitOptions(int spread) {
    GaussianFitOptions options;
    options.spread = spread;
    return options;
  }
  static GaussianOptions Options(int num_threads) {
    GaussianOptions options;
    options.num_threads = num_threads;
    return options;
  }

  GaussianLight light;
  GaussianTransport transport;
  GaussianTransport::Tables tables;
  GaussianColours amplitudes;
};

ApproximateRadiance::ApproximateRadiance(const Image& map,
                                         const KnownBrdf& brdf, int num_threads)
    : map_(map), brdf_(brdf), num_threads_(num_threads) {}
ApproximateRadiance::~ApproximateRadiance() = default;

void ApproximateRadiance::RenderBy(const Candidate& candidate,
                                   const std::vector<ShadingPoint>& points,
                                   double* L_o) {
  if (candidate.approximation == Approximation::kHarmonics) {
    HarmonicOptions options;
    options.order = candidate.size;
    options.grid = grid_.shape;
    options.view_angles = kHarmonicViews;
    options.num_threads = num_threads_;
    HarmonicTransport(points, map_.height, map_.width, options)
        .Render(grid_, map_.rgb.data(), L_o);
  } else {
    if (gaussians_ == nullptr || spread_ != candidate.size) {
      spread_ = candidate.size;
      gaussians_ = std::make_unique<const Gaussians>(map_, brdf_.Lookup(),
                                                     spread_, num_threads_);
    }
    gaussians_->transport.Render(points, gaussians_->tables,
                                 gaussians_->amplitudes, L_o);
  }
  for (size_t k = 0; k < 3 * points.size(); ++k) L_o[k] = std::max(L_o[k], 0.0);
}

std::vector<double> ApproximateRadiance::PredictByOrder(
    const std::vector<ShadingPoint>& few) const {
  return HarmonicTransport(few, map_.height, map_.width, ProbeOptions())
      .PredictLogErrors(grid_, map_.rgb.data());
}

void ApproximateRadiance::PredictGaussians(const std::vector<ShadingPoint>& few,
                                           const std::vector<double>& L_o,
                                           Candidate* candidate) const {
  // What of the map the mixture is not, as the points reflect it.
  const GaussianLight light(map_, Gaussians::FitOptions(candidate->size));
  const Image rest = light.Residual(map_.rgb.data());
  std::vector<double> with_rest(L_o.size());
  HarmonicTransport(few, rest.height, rest.width, ProbeOptions())
      .Render(grid_, rest.rgb.data(), with_rest.data());
  for (size_t k = 0; k < L_o.size(); ++k) with_rest[k] += L_o[k];
  candidate->predicted = MeanAbsLogRatio(with_rest, L_o);
  candidate->spots = light.num_peaks();
}

HarmonicOptions ApproximateRadiance::ProbeOptions() const {
  HarmonicOptions options;
  options.order = kProbeOrder;
  options.grid = grid_.shape;
  options.view_angles = kProbeViews;
  options.num_threads = num_threads_;
  return options;
}

bool ApproximateRadiance::Choose(const std::vector<ShadingPoint>& points,
                                 const PointRenderer& quadrature,
                                 const PointRenderer& reference,
                                 const ApproximationOptions& options) {
  const auto count = static_cast<double>(points.size());
  plan_ = ApproximationPlan();
  plan_.quadrature_seconds = count * kQuadraturePoint;
  plan_.seconds = plan_.quadrature_seconds;
  if (options.reflectance_map)
    plan_.approximation = Approximation::kReflectanceMap;
  if (!options.harmonics && !options.gaussians) return true;
  if (!options.forced && plan_.seconds < kWorthChoosing) return true;

  if (const double lobe = LobeHalfWidth(brdf_.Lookup());
      !options.forced && lobe < kNarrowLobe) {
    plan_.words = Format(
        "; spherical harmonics and spherical Gaussians are not within %.4f for "
        "a lobe of %.1f degrees",
        options.log_error, lobe * 180.0 / kPi);
    return true;
  }

  // What is predicted before anything is rendered.
  const std::vector<ShadingPoint> few = SpreadPoints(points, kChecked);
  grid_ = brdf_.Grid();
  const std::vector<double> by_order = PredictByOrder(few);
  int smooth = kTrustedOrder + 1;
  for (int l = kTrustedOrder; l >= 0; --l) {
    if (by_order[l] <= options.log_error) smooth = l;
  }
  if (options.reflectance_map) {
    const double nodes = smooth <= kTrustedOrder
                             ? kMapChecks + kMapNodes * NumHarmonics(smooth)
                             : kRoughMapNodes;
    plan_.seconds = std::min(plan_.seconds, kQuadraturePoint * nodes);
  }
  if (!options.forced && plan_.seconds < kWorthChoosing) return true;
  std::vector<double> truth(3 * few.size()), L_o(truth.size()),
      tried(truth.size());
  if (!quadrature(few, L_o.data())) return false;
  std::vector<Candidate> candidates;
  if (options.harmonics) {
    for (int l = std::clamp(smooth, 1, kTrustedOrder); l <= kTrustedOrder;
         l += 2) {
      candidates.push_back({Approximation::kHarmonics, l,
                            HarmonicSeconds(l, count), by_order[l], 0});
    }
  }
  if (options.gaussians) {
    for (const int spread : kSpreads) {
      candidates.push_back({Approximation::kGaussians, spread,
                            GaussianSeconds(spread, count), kNotPredicted, 0});
    }
  }

  const auto by_seconds = [](const Candidate& a, const Candidate& b) {
    return a.seconds < b.seconds;
  };
  std::stable_sort(candidates.begin(), candidates.end(), by_seconds);
  const auto predict = [&](Candidate* candidate) {
    if (candidate->predicted == kNotPredicted) {
      PredictGaussians(few, L_o, candidate);
    }
  };
  // Only spots are beyond the quadrature's own error.
  bool hopeful = options.forced;
  for (Candidate& candidate : candidates) {
    if (hopeful) break;
    predict(&candidate);
    hopeful = candidate.spots > 0 || candidate.predicted <= options.log_error;
  }
  const auto by_predicted = [](const Candidate& a, const Candidate& b) {
    return a.predicted < b.predicted;
  };
  if (!hopeful) {
    std::stable_sort(candidates.begin(), candidates.end(), by_predicted);
    plan_.words = Format(
        "; spherical harmonics and spherical Gaussians are not within %.4f: "
        "predicted at best %.4f",
        options.log_error, candidates[0].predicted);
    return true;
  }

  if (!reference(few, truth.data())) return false;
  plan_.checked = static_cast<int>(few.size());
  plan_.quadrature_error = ErrorBound(L_o, truth);
  const auto take_first_within = [&](double allowed) {
    for (Candidate& candidate : candidates) {
      predict(&candidate);
      if (candidate.predicted > allowed ||
          (!options.forced && candidate.seconds >= plan_.seconds)) {
        continue;
      }
      RenderBy(candidate, few, tried.data());
      const double found = ErrorBound(tried, truth);
      if (found > allowed) continue;
      Take(candidate, found, options);
      return true;
    }
    return false;
  };
  if (take_first_within(options.log_error)) return true;
  // A quadrature that is further off is no reason for more seconds.
  std::stable_sort(candidates.begin(), candidates.end(), by_predicted);
  if (plan_.quadrature_error > options.log_error &&
      take_first_within(plan_.quadrature_error)) {
    return true;
  }
  if (options.forced) {
    RenderBy(candidates[0], few, tried.data());
    Take(candidates[0], ErrorBound(tried, truth), options);
    return true;
  }
  plan_.words = Format(
      "; spherical harmonics and spherical Gaussians are slower or not "
      "within %.4f: predicted at best %.4f, point by point %.4f",
      options.log_error, candidates[0].predicted, plan_.quadrature_error);
  return true;
}

void ApproximateRadiance::Take(const Candidate& candidate, double found,
                               const ApproximationOptions& options) {
  plan_.approximation = candidate.approximation;
  plan_.predicted_error = candidate.predicted;
  plan_.found_error = found;
  plan_.seconds = candidate.seconds;
  taken_ = candidate;
  std::string light;
  if (candidate.approximation == Approximation::kHarmonics) {
    plan_.order = candidate.size;
    light = "spherical harmonics up to l = " + std::to_string(plan_.order);
  } else {
    plan_.gaussians = gaussians_->transport.num_lobes();
    plan_.spots = gaussians_->light.num_peaks();
    light = std::to_string(plan_.gaussians) + " spherical Gaussians";
    if (plan_.spots > 0) {
      light += ", " + std::to_string(plan_.spots) +
               (plan_.spots == 1 ? " for a bright spot" : " for bright spots");
    }
  }
  plan_.words = "; light in " + light + (options.forced ? ", as asked" : "") +
                Format(
                    ": predicted error of log radiance %.4f, found %.4f at "
                    "%d points",
                    candidate.predicted, found, plan_.checked) +
                Format(" (allowed %.4f; point by point %.4f)",
                       options.log_error, plan_.quadrature_error) +
                Format(", about %.2f s of a core for %.2f s", plan_.seconds,
                       plan_.quadrature_seconds);
}

void ApproximateRadiance::Render(const std::vector<ShadingPoint>& points,
                                 double* L_o) {
  RenderBy(taken_, points, L_o);
}

}  // namespace ibrdf

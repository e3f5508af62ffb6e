#include "ibrdf/solvers/forward/approximate_radiance.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ibrdf/approximation/gaussian_light.h"
#include "ibrdf/approximation/gaussian_radiance.h"
#include "ibrdf/approximation/harmonic_radiance.h"
#include "ibrdf/image/darkest.h"
#include "ibrdf/render/scene_probe.h"
#include "ibrdf/solvers/forward/approximation_costs.h"
#include "ibrdf/transport/lobe_bundles.h"

namespace ibrdf {
namespace {

// A quadrature of fewer seconds than this is not worth a choice.
constexpr double kWorthChoosing = 0.3;
// Order of the probe whose spectra tell what lower orders leave out. It does
// not know what is above its own.
constexpr int kProbeOrder = 16;
constexpr int kTrustedOrder = kProbeOrder - 3;
constexpr int kProbeViews = 12;
constexpr int kHarmonicViews = 24;
constexpr double kNotPredicted = -1.0;

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

// The least order within the error, kTrustedOrder + 1 where there is none.
int SmoothOrder(const std::vector<double>& by_order, double log_error) {
  int order = kTrustedOrder + 1;
  for (int l = kTrustedOrder; l >= 0; --l) {
    if (by_order[l] <= log_error) order = l;
  }
  return order;
}

GaussianFitOptions Spread(int spread) {
  GaussianFitOptions options;
  options.spread = spread;
  return options;
}

}  // namespace

Status ApproximationOptions::Check() const {
  const auto fault = [](const std::string& what) {
    return Status(StatusCode::kInternal, "ApproximationOptions: " + what);
  };
  if (!(log_error > 0.0)) return fault("log_error must be > 0");
  if (checked_points < 1) return fault("checked_points must be >= 1");
  for (const int spread : spreads) {
    if (spread < 1) return fault("spreads must be >= 1");
  }
  return OkStatus();
}

ApproximateRadiance::ApproximateRadiance(const Image& map,
                                         const KnownBrdf& brdf, int num_threads)
    : map_(map), brdf_(brdf), num_threads_(num_threads) {}

bool ApproximateRadiance::Choose(const std::vector<ShadingPoint>& points,
                                 const RadianceRenderer& quadrature,
                                 const RadianceRenderer& reference,
                                 const ApproximationOptions& options) {
  CHECK(options.Check().ok()) << options.Check().message();
  const auto count = static_cast<double>(points.size());
  StartPlan(count, options);
  if (!MayGain(options) || LobeIsTooNarrow(options)) return true;

  Samples at;
  at.points = SpreadPoints(points, options.checked_points);
  grid_ = brdf_.Grid();
  const std::vector<double> by_order = PredictByOrder(at);
  PredictReflectanceMap(by_order, options);
  if (!MayGain(options)) return true;
  at.quadrature.resize(3 * at.points.size());
  if (!quadrature.Render(at.points, nullptr, at.quadrature.data())) {
    return false;
  }
  std::vector<Candidate> table = ListCandidates(by_order, count, options);
  if (!AnyPromising(at, options, &table)) {
    Decline(ApproximationVerdict::kPredictedOff, table);
    return true;
  }

  at.reference.resize(3 * at.points.size());
  if (!reference.Render(at.points, nullptr, at.reference.data())) return false;
  plan_.checked = static_cast<int>(at.points.size());
  plan_.quadrature_error = ErrorBound(at.quadrature, at.reference);
  if (const Candidate* chosen = ChooseFrom(at, options, &table)) {
    Take(*chosen);
  } else {
    Decline(ApproximationVerdict::kNonePays, table);
  }
  return true;
}

void ApproximateRadiance::StartPlan(double num_points,
                                    const ApproximationOptions& options) {
  plan_ = ApproximationPlan();
  taken_ = nullptr;
  plan_.forced = options.forced;
  plan_.log_error = options.log_error;
  plan_.seconds = plan_.quadrature_seconds = QuadratureSeconds(num_points);
  if (options.reflectance_map) {
    plan_.approximation = Approximation::kReflectanceMap;
  }
}

bool ApproximateRadiance::MayGain(const ApproximationOptions& options) const {
  if (!options.harmonics && !options.gaussians) return false;
  return options.forced || plan_.seconds >= kWorthChoosing;
}

bool ApproximateRadiance::LobeIsTooNarrow(const ApproximationOptions& options) {
  if (options.forced) return false;
  plan_.lobe_half_width = LobeHalfWidth(brdf_.Lookup());
  if (plan_.lobe_half_width >= kNarrowLobe) return false;
  plan_.verdict = ApproximationVerdict::kNarrowLobe;
  return true;
}

void ApproximateRadiance::PredictReflectanceMap(
    const std::vector<double>& by_order, const ApproximationOptions& options) {
  if (!options.reflectance_map) return;
  const int order = SmoothOrder(by_order, options.log_error);
  const double seconds =
      ReflectanceMapSeconds(order <= kTrustedOrder ? order : -1);
  plan_.seconds = std::min(plan_.seconds, seconds);
}

std::vector<double> ApproximateRadiance::PredictByOrder(
    const Samples& at) const {
  return HarmonicTransport(at.points, map_.height, map_.width,
                           Harmonics(kProbeOrder, kProbeViews))
      .PredictLogErrors(grid_, map_.rgb.data());
}

std::vector<ApproximateRadiance::Candidate> ApproximateRadiance::ListCandidates(
    const std::vector<double>& by_order, double num_points,
    const ApproximationOptions& options) const {
  std::vector<Candidate> table;
  if (options.harmonics) {
    const int first =
        std::clamp(SmoothOrder(by_order, options.log_error), 1, kTrustedOrder);
    for (int l = first; l <= kTrustedOrder; l += 2) {
      Candidate candidate;
      candidate.approximation = Approximation::kHarmonics;
      candidate.size = l;
      candidate.seconds = HarmonicSeconds(l, num_points);
      candidate.predicted = by_order[l];
      table.push_back(candidate);
    }
  }
  if (options.gaussians) {
    for (const int spread : options.spreads) {
      Candidate candidate;
      candidate.approximation = Approximation::kGaussians;
      candidate.size = spread;
      candidate.seconds = GaussianSeconds(spread, num_points);
      candidate.predicted = kNotPredicted;
      table.push_back(candidate);
    }
  }
  std::stable_sort(table.begin(), table.end(),
                   [](const Candidate& a, const Candidate& b) {
                     return a.seconds < b.seconds;
                   });
  return table;
}

void ApproximateRadiance::Predict(const Samples& at,
                                  Candidate* candidate) const {
  if (candidate->predicted != kNotPredicted) return;
  // What of the map the mixture is not, as the points reflect it.
  const GaussianLight light(map_, Spread(candidate->size));
  const Image rest = light.Residual(map_.rgb.data());
  std::vector<double> with_rest(at.quadrature.size());
  HarmonicTransport(at.points, rest.height, rest.width,
                    Harmonics(kProbeOrder, kProbeViews))
      .Render(grid_, rest.rgb.data(), with_rest.data());
  for (size_t k = 0; k < with_rest.size(); ++k) {
    with_rest[k] += at.quadrature[k];
  }
  candidate->predicted = MeanAbsLogRatio(with_rest, at.quadrature);
  candidate->spots = light.num_peaks();
}

bool ApproximateRadiance::AnyPromising(const Samples& at,
                                       const ApproximationOptions& options,
                                       std::vector<Candidate>* table) const {
  if (options.forced) return true;
  // Under bright spots the quadrature itself may be off by more than the error
  // asked for, and a candidate that is off by as much still pays.
  return std::any_of(table->begin(), table->end(), [&](Candidate& candidate) {
    Predict(at, &candidate);
    return candidate.spots > 0 || candidate.predicted <= options.log_error;
  });
}

void ApproximateRadiance::SetUp(Candidate* candidate) const {
  if (candidate->approximation == Approximation::kHarmonics) {
    candidate->renderer = std::make_shared<HarmonicRadiance>(
        map_, grid_, Harmonics(candidate->size, kHarmonicViews));
    return;
  }
  GaussianOptions options;
  options.num_threads = num_threads_;
  const auto renderer = std::make_shared<GaussianRadiance>(
      map_, brdf_.Lookup(), Spread(candidate->size), options);
  candidate->gaussians = renderer->num_lobes();
  candidate->spots = renderer->num_peaks();
  candidate->renderer = renderer;
}

void ApproximateRadiance::Verify(const Samples& at,
                                 Candidate* candidate) const {
  if (candidate->renderer != nullptr) return;
  SetUp(candidate);
  std::vector<double> L_o(at.reference.size());
  candidate->renderer->Render(at.points, nullptr, L_o.data());
  candidate->found = ErrorBound(L_o, at.reference);
}

const ApproximateRadiance::Candidate* ApproximateRadiance::FirstWithin(
    double allowed, const Samples& at, const ApproximationOptions& options,
    std::vector<Candidate>* table) {
  for (Candidate& candidate : *table) {
    Predict(at, &candidate);
    const bool slower = !options.forced && candidate.seconds >= plan_.seconds;
    if (candidate.predicted > allowed || slower) continue;
    Verify(at, &candidate);
    if (candidate.found <= allowed) return &candidate;
  }
  return nullptr;
}

const ApproximateRadiance::Candidate* ApproximateRadiance::ChooseFrom(
    const Samples& at, const ApproximationOptions& options,
    std::vector<Candidate>* table) {
  if (const Candidate* fastest =
          FirstWithin(options.log_error, at, options, table)) {
    return fastest;
  }
  // A quadrature that is further off is no reason for more seconds.
  std::stable_sort(table->begin(), table->end(),
                   [](const Candidate& a, const Candidate& b) {
                     return a.predicted < b.predicted;
                   });
  if (plan_.quadrature_error > options.log_error) {
    if (const Candidate* nearest =
            FirstWithin(plan_.quadrature_error, at, options, table)) {
      return nearest;
    }
  }
  if (!options.forced) return nullptr;
  Verify(at, &table->front());
  return &table->front();
}

void ApproximateRadiance::Take(const Candidate& candidate) {
  taken_ = candidate.renderer;
  plan_.verdict = ApproximationVerdict::kTaken;
  plan_.approximation = candidate.approximation;
  plan_.predicted_error = candidate.predicted;
  plan_.found_error = candidate.found;
  plan_.seconds = candidate.seconds;
  if (candidate.approximation == Approximation::kHarmonics) {
    plan_.order = candidate.size;
  } else {
    plan_.gaussians = candidate.gaussians;
    plan_.spots = candidate.spots;
  }
}

void ApproximateRadiance::Decline(ApproximationVerdict verdict,
                                  const std::vector<Candidate>& table) {
  plan_.verdict = verdict;
  plan_.predicted_error =
      std::min_element(table.begin(), table.end(),
                       [](const Candidate& a, const Candidate& b) {
                         return a.predicted < b.predicted;
                       })
          ->predicted;
}

HarmonicOptions ApproximateRadiance::Harmonics(int order,
                                               int view_angles) const {
  HarmonicOptions options;
  options.order = order;
  options.grid = grid_.shape;
  options.view_angles = view_angles;
  options.num_threads = num_threads_;
  return options;
}

}  // namespace ibrdf

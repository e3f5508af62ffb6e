#include "ibrdf/solvers/estimation/search_settings.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "ibrdf/base/median.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/estimation/view_bins.h"
#include "ibrdf/solvers/problem/quadrature_level.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

// Below this multiple of the median radiance no camera sees, and its logarithm
// is far from all others.
constexpr double kDarkest = 1e-8;
// Where nearly all of a point's light comes from the object the map's says
// little of it.
constexpr double kMostBounceGain = 10.0;

// Radiance [points][3] with bounces over that without, under a map of log
// radiance [3][texels].
std::vector<double> GainByBounces(const Transport& transport,
                                  const MaterialGrids& grids,
                                  const std::vector<double>& log_radiance) {
  const int texels = transport.map_height() * transport.map_width();
  if (log_radiance.size() != size_t{3} * texels) return {};
  // The level cancels in the ratio.
  const std::vector<float> map = RelativeMap(log_radiance.data(), texels);
  std::vector<double> direct(size_t{3} * transport.num_points());
  std::vector<double> all(direct.size());
  transport.RenderBounces(grids, map.data(), 0, direct.data());
  transport.Render(grids, map.data(), all.data());
  for (size_t i = 0; i < all.size(); ++i) {
    const double gain = all[i] / direct[i];
    all[i] = std::isfinite(gain) && gain > 0.0 ? std::min(gain, kMostBounceGain)
                                               : 1.0;
  }
  return all;
}

// GainByBounces of all pixels, slice by slice. The last slice's transport is
// kept, which spares a small image the making of another.
class BounceGains {
 public:
  BounceGains(const SolveSetup& setup, MapSize size)
      : setup_(setup), size_(size) {}

  // At lobes and a log radiance [3][texels] of the search; empty: not to be
  // had.
  std::vector<double> Of(const std::vector<double>& lobes,
                         const std::vector<double>& log_radiance) {
    const InverseProblem& problem = *setup_.problem;
    const size_t count = problem.points.size();
    const std::vector<BrdfGrid> grids = setup_.GridsOf(lobes);
    std::vector<double> gain;
    for (size_t begin = 0; begin < count; begin += kPointsAtOnceWithBounces) {
      const std::vector<double> of_slice =
          GainByBounces(TransportOf(begin), ByMaterial(grids), log_radiance);
      if (of_slice.empty()) return of_slice;
      gain.insert(gain.end(), of_slice.begin(), of_slice.end());
    }
    return gain;
  }

 private:
  const Transport& TransportOf(size_t begin) {
    if (transport_ != nullptr && begin_ == begin) return *transport_;
    const std::vector<ShadingPoint>& points = setup_.problem->points;
    const size_t end =
        std::min(begin + kPointsAtOnceWithBounces, points.size());
    transport_.reset();  // the memory of one at a time
    transport_ = std::make_unique<Transport>(
        std::vector<ShadingPoint>(points.begin() + begin, points.begin() + end),
        size_.height, size_.width, setup_.transport);
    begin_ = begin;
    return *transport_;
  }

  const SolveSetup& setup_;
  const MapSize size_;
  std::unique_ptr<const Transport> transport_;
  size_t begin_ = 0;
};

// Several views together have no more bins than one could have.
void LimitBins(size_t views, NormalBinOptions* bins) {
  if (views < 2) return;
  bins->most_bins = bins->bins_across * bins->bins_across;
  bins->bins_across = BinsAcrossView(bins->bins_across, views);
}

}  // namespace

ReflectanceSearchOptions SearchOptions(double share, const SolveSetup& setup,
                                       SolveContext* context) {
  const InverseProblem& problem = *setup.problem;
  ReflectanceSearchOptions o;
  o.num_threads = problem.num_threads;
  for (MarginalResolution* resolution : {&o.screen, &o.coarse, &o.fine}) {
    AdaptResolution(problem, problem.sheet.views.size(), resolution);
  }
  o.should_stop = context->StopAfter(share);
  LimitIterations(problem.solver.max_iterations, &o);
  o.report = [&setup, context](const std::string& stage, double cost,
                               double misfit) {
    context->Report(stage, setup.pixels.observed.num_valid, cost, misfit);
  };
  return o;
}

void LimitIterations(int max_iterations, ReflectanceSearchOptions* options) {
  if (max_iterations == 0) options->coarse_stages = {{1, 0}};
  const int most = 5 * max_iterations;
  for (SearchStage& stage : options->coarse_stages) {
    stage.iterations = std::min(stage.iterations, most);
  }
  options->fine_iterations = std::min(options->fine_iterations, most);
}

void AdaptResolution(const InverseProblem& problem, size_t views,
                     MarginalResolution* resolution) {
  resolution->visibility = problem.transport.visibility;
  resolution->quadrature =
      AtLevel(resolution->quadrature, problem.solver.quadrature);
  LimitBins(views, &resolution->bins);
}

BounceGain BounceGainOf(const SolveSetup& setup,
                        const MarginalResolution& fine) {
  if (setup.problem->transport.patches == nullptr) return {};
  const auto gains = std::make_shared<BounceGains>(
      setup, MapSize{fine.map_width, fine.map_height});
  return [gains](const std::vector<double>& lobes,
                 const std::vector<double>& log_radiance) {
    return gains->Of(lobes, log_radiance);
  };
}

ReflectanceSearchOptions CoarseSearchOptions(double share,
                                             const SolveSetup& setup,
                                             SolveContext* context) {
  ReflectanceSearchOptions o = SearchOptions(share, setup, context);
  o.fine_iterations = 0;
  o.covariance = false;
  return o;
}

Observations SearchedPixels(const SolveSetup& setup) {
  const Observations& observed = setup.pixels.observed;
  std::vector<double> radiance = observed.radiance;
  std::vector<double> lit;
  for (const double e : radiance) {
    if (std::isfinite(e) && e > 0.0) lit.push_back(e);
  }
  if (lit.empty()) return observed;
  const double darkest = kDarkest * UpperMedian(std::move(lit));
  const std::vector<ShadingPoint>& points = setup.pixels.points;
  for (size_t i = 0; i < radiance.size(); ++i) {
    if (radiance[i] < darkest || points[i / 3].mixed) radiance[i] = 0.0;
  }
  return MakeObservations(std::move(radiance), observed.low, observed.high);
}

LightPosterior LightOf(const ReflectanceSearchResult& found, double level) {
  LightPosterior light;
  light.hyperparameters = found.hyperparameters;
  light.directional_lights = found.directional_lights;
  std::vector<float> mode;
  for (const double v : found.log_radiance) {
    mode.push_back(static_cast<float>(v - level));
  }
  light.mode = LogMap({found.map_width, found.map_height}, std::move(mode));
  light.log_std =
      FromPlanes(found.log_radiance_std, found.map_width, found.map_height);
  light.variance_left = FromPlanes(found.log_radiance_variance_left,
                                   found.map_width, found.map_height);
  light.variance_left_by_degree = found.variance_left_by_degree;
  return light;
}

}  // namespace ibrdf

#include "ibrdf/solvers/baselines/cook_torrance_fit.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/metrics/log_difference.h"
#include "ibrdf/solvers/baselines/cook_torrance_cost.h"
#include "ibrdf/solvers/baselines/table_cost.h"

namespace ibrdf {
namespace {

// Box of starts and results. Beyond it a parameter no longer changes an image.
constexpr ParameterBounds kLogColourBounds = {-16.0, 8.0};
constexpr ParameterBounds kLogRoughness = {-5.5, 0.7};  // 0.004 to 2
constexpr ParameterBounds kLogitF0 = {-7.0, 7.0};

// A pull on every parameter to where it started, natural log: too weak to show
// in the misfit, it holds what the image does not tell. Bounds instead cost
// Ceres a line search, ten renders and more, in each step along them.
constexpr double kPullScale = 30.0;
// Iterations of a fit of the colours alone, which takes no renders.
constexpr int kColourIterations = 40;

ParameterBounds BoundsOf(int parameter) {
  if (parameter < 6) return kLogColourBounds;
  return parameter == 6 ? kLogRoughness : kLogitF0;
}

void ClampToBounds(CookTorranceVector* p) {
  for (int i = 0; i < kCookTorranceParameters; ++i) {
    (*p)[i] = std::clamp((*p)[i], BoundsOf(i).lower, BoundsOf(i).upper);
  }
}

StatusOr<LogObservations> Observe(const Image& image,
                                  const std::vector<ShadingPoint>& points,
                                  std::vector<ShadingPoint>* used) {
  double largest = 0.0;
  for (const ShadingPoint& point : points) {
    CHECK_LT(static_cast<size_t>(point.pixel), image.num_pixels());
    const float* rgb = image.rgb.data() + size_t{3} * point.pixel;
    if (!std::all_of(rgb, rgb + 3, [](float v) { return std::isfinite(v); })) {
      continue;
    }
    used->push_back(point);
    for (int c = 0; c < 3; ++c) largest = std::max<double>(largest, rgb[c]);
  }
  if (largest <= 0.0) {
    return InvalidInput("image", "expected a finite pixel > 0 on the object");
  }
  LogObservations observed;
  observed.floor = kRelativeFloor * largest;
  for (const ShadingPoint& point : *used) {
    for (int c = 0; c < 3; ++c) {
      const double value = image.rgb[size_t{3} * point.pixel + c];
      observed.values.push_back(
          std::log(std::max(value, 0.0) + observed.floor));
    }
  }
  return observed;
}

// Half of the light from each part, on geometric average.
CookTorranceVector Start(const CookTorranceCost& cost,
                         const LogObservations& observed, double roughness,
                         double f0) {
  CookTorranceVector p;
  p[6] = std::log(roughness);
  p[7] = std::log(f0 / (1.0 - f0));
  const std::vector<float>& unit = cost.UnitRadiance(p[6], p[7]);
  const size_t points = observed.values.size() / 3;
  for (int k = 0; k < 2; ++k) {
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (size_t i = 0; i < points; ++i) {
        sum += observed.values[3 * i + c] -
               std::log(unit[3 * (CookTorranceCost::kFields * i + k) + c] +
                        observed.floor);
      }
      p[3 * k + c] = std::log(0.5) + sum / static_cast<double>(points);
    }
  }
  ClampToBounds(&p);
  return p;
}

// Evenly over the image.
std::vector<ShadingPoint> Thin(const std::vector<ShadingPoint>& points,
                               int width, size_t max_points) {
  const double share = static_cast<double>(points.size()) / max_points;
  if (share <= 1.0) return points;
  const int n = std::max(static_cast<int>(std::sqrt(share)), 1);
  std::vector<ShadingPoint> kept;
  for (const ShadingPoint& point : points) {
    if (point.pixel % width % n == n / 2 && point.pixel / width % n == n / 2) {
      kept.push_back(point);
    }
  }
  // Something thin may lie between those rows or columns.
  if (kept.size() >= max_points / 2) return kept;
  kept.clear();
  for (size_t i = 0; i < max_points; ++i) {
    kept.push_back(points[static_cast<size_t>((i + 0.5) * share)]);
  }
  return kept;
}

// Lowers the cost over all parameters, or over the colours at the same
// roughness and f0. Infinite where there is no solution.
double Minimise(CookTorranceCost* cost, bool only_colours, int iterations,
                double tolerance, CookTorranceVector* p) {
  ceres::NormalPrior pull(ceres::Matrix::Identity(kCookTorranceParameters,
                                                  kCookTorranceParameters) /
                              kPullScale,
                          *p);
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  problem.AddResidualBlock(cost, nullptr, p->data());
  problem.AddResidualBlock(&pull, nullptr, p->data());
  if (only_colours) {
    problem.SetManifold(
        p->data(), new ceres::SubsetManifold(kCookTorranceParameters, {6, 7}));
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = iterations;
  solver.function_tolerance = tolerance;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  ClampToBounds(p);
  VLOG(1) << p->transpose() << ": " << summary.BriefReport();
  return summary.IsSolutionUsable() ? summary.final_cost
                                    : std::numeric_limits<double>::infinity();
}

}  // namespace

StatusOr<CookTorranceFit> FitCookTorrance(
    const std::vector<ShadingPoint>& points, const Image& image,
    const Image& map, const CookTorranceFitOptions& options) {
  CHECK(!options.start_roughness.empty() && !options.start_f0.empty());
  CHECK(options.refined_starts > 0 && options.max_points > 0);
  std::vector<ShadingPoint> used;
  const StatusOr<LogObservations> observed =
      Observe(image, Thin(points, image.width, options.max_points), &used);
  if (!observed.ok()) return observed.status();
  TransportOptions transport_options;
  transport_options.num_threads = options.num_threads;
  const Transport transport(used, map.height, map.width, transport_options);
  CookTorranceCost cost(transport, map, *observed, options.smoothing,
                        options.num_threads);

  using Candidate = std::pair<double, CookTorranceVector>;
  const auto lower = [](const Candidate& a, const Candidate& b) {
    return a.first < b.first;
  };
  std::vector<Candidate> starts;
  for (const double roughness : options.start_roughness) {
    for (const double f0 : options.start_f0) {
      CookTorranceVector p = Start(cost, *observed, roughness, f0);
      const double at =
          Minimise(&cost, true, kColourIterations, options.tolerance, &p);
      starts.emplace_back(at, p);
    }
  }
  std::stable_sort(starts.begin(), starts.end(), lower);
  starts.resize(std::min<size_t>(starts.size(), options.refined_starts));
  for (auto& [at, p] : starts) {
    at = Minimise(&cost, false, options.refining_steps, options.tolerance, &p);
  }
  Candidate best = *std::min_element(starts.begin(), starts.end(), lower);
  best.first = Minimise(&cost, false, options.max_iterations, options.tolerance,
                        &best.second);
  if (!std::isfinite(best.first)) {
    return InvalidInput("image",
                        "expected radiance that a surface under the "
                        "given light can have");
  }
  return CookTorranceFit{FromCookTorranceVector(best.second),
                         cost.Misfit(best.second)};
}

StatusOr<IlluminationMetrics> ScoreConstantMap(const Image& reference) {
  const Eigen::Array3f mean = MeanRadiance(reference).cast<float>();
  Image constant(reference.width, reference.height);
  for (size_t i = 0; i < constant.rgb.size(); ++i) {
    constant.rgb[i] = mean[static_cast<int>(i % 3)];
  }
  return CompareIlluminations(constant, reference);
}

}  // namespace ibrdf

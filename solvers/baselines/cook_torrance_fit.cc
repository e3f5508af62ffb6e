#include "solvers/baselines/cook_torrance_fit.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/light/environment_map.h"
#include "solvers/baselines/cook_torrance_cost.h"

namespace ibrdf {
namespace {

// Of the largest pixel: inside the logarithms.
constexpr double kRelativeFloor = 1e-6;

// Box of the fit. Beyond it a parameter no longer changes an image, and the
// problem would be singular.
struct Bounds {
  double lower, upper;
};
constexpr Bounds kLogColour = {-16.0, 8.0};
constexpr Bounds kLogRoughness = {-5.5, 0.7};  // 0.004 to 2
constexpr Bounds kLogitF0 = {-7.0, 7.0};

Bounds BoundsOf(int parameter) {
  if (parameter < 6) return kLogColour;
  return parameter == 6 ? kLogRoughness : kLogitF0;
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
  const std::vector<float> unit = cost.UnitRadiance(p[6], p[7]);
  const size_t points = observed.values.size() / 3;
  for (int k = 0; k < 2; ++k) {
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (size_t i = 0; i < points; ++i) {
        sum += observed.values[3 * i + c] -
               std::log(unit[6 * i + 3 * k + c] + observed.floor);
      }
      p[3 * k + c] = std::log(0.5) + sum / static_cast<double>(points);
    }
  }
  for (int i = 0; i < kCookTorranceParameters; ++i) {
    p[i] = std::clamp(p[i], BoundsOf(i).lower, BoundsOf(i).upper);
  }
  return p;
}

}  // namespace

StatusOr<CookTorranceFit> FitCookTorrance(
    const std::vector<ShadingPoint>& points, const Image& image,
    const Image& map, const CookTorranceFitOptions& options) {
  CHECK(!options.start_roughness.empty());
  std::vector<ShadingPoint> used;
  const StatusOr<LogObservations> observed = Observe(image, points, &used);
  if (!observed.ok()) return observed.status();
  TransportOptions transport_options;
  transport_options.num_threads = options.num_threads;
  const Transport transport(used, map.height, map.width, transport_options);
  CookTorranceCost cost(transport, map, *observed, options.smoothing,
                        options.num_threads);

  CookTorranceVector best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const double roughness : options.start_roughness) {
    CookTorranceVector p = Start(cost, *observed, roughness, options.start_f0);
    ceres::Problem::Options problem_options;
    problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(problem_options);
    problem.AddResidualBlock(&cost, nullptr, p.data());
    for (int i = 0; i < kCookTorranceParameters; ++i) {
      problem.SetParameterLowerBound(p.data(), i, BoundsOf(i).lower);
      problem.SetParameterUpperBound(p.data(), i, BoundsOf(i).upper);
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.max_num_iterations = options.max_iterations;
    solver.function_tolerance = options.tolerance;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    VLOG(1) << "start " << roughness << ": " << summary.BriefReport();
    if (summary.IsSolutionUsable() && summary.final_cost < best_cost) {
      best_cost = summary.final_cost;
      best = p;
    }
  }
  if (!std::isfinite(best_cost)) {
    return InvalidInput("image",
                        "expected radiance that a surface under the "
                        "given light can have");
  }
  return CookTorranceFit{FromCookTorranceVector(best), cost.Misfit(best)};
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

// The unit of radiance changes radiance alone, whatever the factor.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/solve/solve.h"
#include "ibrdf/transport/transport.h"
#include "tests/properties/generators.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {

Image Times(const Image& image, double factor) {
  Image scaled = image;
  for (float& v : scaled.rgb) v = static_cast<float>(v * factor);
  return scaled;
}

RC_GTEST_PROP(ExposureProperty, RendersScaleWithTheLight, ()) {
  static const std::vector<ShadingPoint> points = testing::SpherePoints(4);
  static const Transport transport(points, 8, 16,
                                   testing::TinyTransportOptions());
  CookTorrance brdf;
  brdf.diffuse.setConstant(*Unit());
  brdf.roughness.setConstant(*Magnitude(0.01, 1.0));
  const BrdfGrid grid =
      BrdfGrid::FromFunction(brdf.Function(), transport.grid_shape());
  const Image map = AnyMap(8, 16);
  const double s = *Magnitude(1e-6, 1e6);
  std::vector<double> L_o(3 * points.size()), F(L_o.size());
  transport.Render(grid, map.rgb.data(), L_o.data());
  transport.Render(grid, Times(map, s).rgb.data(), F.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    // All terms are >= 0: each is rounded at the texel, the block's sum and the
    // product, and then in a sum of some hundred floats in eight lanes.
    constexpr double kRounding = 40 * 6e-8;
    RC_ASSERT(std::abs(F[i] - s * L_o[i]) <= kRounding * F[i]);
  }
}

// A sphere of 8 x 8 pixels; nothing but iterations ends a solve.
InverseProblem SmallProblem(ProblemKind kind, int materials, int iterations) {
  const int material = *Choice(materials);
  InverseProblem p;
  p.kind = kind;
  p.points = testing::SpherePoints(8);
  p.image = Image(8, 8);
  p.model = std::make_shared<const NeuralBrdfModel>(TinyModel(materials));
  p.transport = testing::TinyTransportOptions();
  p.num_threads = 1;
  p.map_width = 16;
  p.map_height = 8;
  p.illumination_prior = IlluminationPrior::kNone;
  p.solver.seconds = 1e6;
  p.solver.max_iterations = iterations;
  const int code = p.model->shape.code_size();
  std::vector<double> lobes;
  for (int k = 0; k < 2; ++k) {
    for (int d = 0; d < code; ++d) {
      lobes.push_back(0.8 * p.model->codes[(3 * material) * code + d] +
                      *Between(-0.1, 0.1));
    }
    for (int c = 0; c < 3; ++c) lobes.push_back(*Between(3.0, 5.0));
  }
  const BrdfGrid truth =
      FlowLobes(*p.model, 2, p.transport.grid, 1).Grid(lobes.data());
  Image map = testing::SmoothMap(8, 16);
  const Transport transport(p.points, 8, 16, p.transport);
  std::vector<double> L_o(3 * p.points.size());
  transport.Render(truth, map.rgb.data(), L_o.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    p.image.rgb[3 * p.points[i / 3].pixel + i % 3] = static_cast<float>(
        L_o[i] * std::exp(0.02 * std::sin(11.0 * static_cast<double>(i))));
  }
  if (kind == ProblemKind::kReflectance) p.known_map = map;
  if (kind == ProblemKind::kIllumination) p.known_brdf = truth;
  return p;
}

Solution Solve(const InverseProblem& problem) {
  StatusOr<Solution> e = SolveInverseRendering(problem, nullptr, nullptr);
  RC_ASSERT(e.ok());
  return *std::move(e);
}

// Root mean square of log(a / (s b)) over the values that are positive in both.
template <typename Values>
double LogDifference(const Values& a, const Values& b, double s) {
  double sum = 0.0;
  int count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (!(a[i] > 0) || !(b[i] > 0)) continue;
    const double d = std::log(a[i] / (s * b[i]));
    sum += d * d;
    ++count;
  }
  return std::sqrt(sum / std::max(count, 1));
}

// A factor that is no power of two rounds the image, 6e-8 a pixel, which
// decides now and then whether a step is taken or conjugate gradients end:
// measured 1e-5 to 4e-4 as a rule and at most 9e-3, in nats, over some hundred
// solves of like problems. A unit that is lost shows as log s, some nats.
constexpr double kPassedOn = 0.03;

void AssertScaled(const Solution& one, const Solution& scaled, double s) {
  RC_ASSERT(one.start == scaled.start);
  RC_ASSERT(LogDifference(scaled.brdf.raw, one.brdf.raw, 1.0) <= kPassedOn);
  RC_ASSERT(LogDifference(scaled.map.rgb, one.map.rgb, s) <= kPassedOn);
  RC_ASSERT(LogDifference(scaled.render.rgb, one.render.rgb, s) <= kPassedOn);
  RC_ASSERT(std::abs(scaled.epsilon - s * one.epsilon) <=
            1e-5 * scaled.epsilon);
  RC_ASSERT(std::abs(scaled.misfit - one.misfit) <= 0.05 * one.misfit + 1e-3);
}

// The colours of a reflectance have a prior, so an image alone in other units
// is another reflectance's; light and image together are the same one's.
TEST(ExposureProperty, KnownLightInTheImagesUnitGivesTheSameReflectance) {
  CheckSome(3, [] {
    InverseProblem p = SmallProblem(ProblemKind::kReflectance, 3, 2);
    const double s = *Magnitude(1e-6, 1e6);
    const Solution one = Solve(p);
    RC_ASSERT(one.misfit <= 0.1);
    p.image = Times(p.image, s);
    p.known_map = Times(*p.known_map, s);
    AssertScaled(one, Solve(p), s);
  });
}

TEST(ExposureProperty, UnknownLightUnderAKnownReflectanceScales) {
  CheckSome(10, [] {
    InverseProblem p = SmallProblem(ProblemKind::kIllumination, 3, 8);
    const double s = *Magnitude(1e-6, 1e6);
    const Solution one = Solve(p);
    RC_ASSERT(one.misfit <= 0.1);
    p.image = Times(p.image, s);
    AssertScaled(one, Solve(p), s);
  });
}

// The gauge puts the reflectance where the materials are: all of the unit goes
// to the light. One material keeps the search short.
void CheckBothUnknown(SolverEstimator estimator, int percent) {
  CheckSome(percent, [estimator] {
    InverseProblem p = SmallProblem(ProblemKind::kJoint, 1, 1);
    p.solver.estimator = estimator;
    const double s = *Magnitude(1e-6, 1e6);
    const Solution one = Solve(p);
    RC_ASSERT(one.misfit <= 0.1);
    p.image = Times(p.image, s);
    AssertScaled(one, Solve(p), s);
  });
}

TEST(ExposureProperty, BothUnknownGiveTheUnitToTheLight) {
  CheckBothUnknown(SolverEstimator::kMarginal, 2);
}

TEST(ExposureProperty, BothUnknownAtOnceGiveTheUnitToTheLight) {
  CheckBothUnknown(SolverEstimator::kMaximum, 4);
}

}  // namespace
}  // namespace ibrdf

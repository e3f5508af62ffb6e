// What holds of every reflectance that the model can name.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/flow_brdf.h"
#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/geometry/half_diff.h"
#include "tests/properties/generators.h"

namespace ibrdf {
namespace {

RC_GTEST_PROP(HalfDiffProperty, ExchangeOfDirectionsChangesNothing, ()) {
  const Eigen::Vector3d wi = AnyDirectionAbove(1e-6),
                        wo = AnyDirectionAbove(1e-6);
  const HalfDiff a = ToHalfDiff(wi, wo), b = ToHalfDiff(wo, wi);
  RC_ASSERT(std::abs(a.theta_h - b.theta_h) <= 1e-7);
  RC_ASSERT(std::abs(a.theta_d - b.theta_d) <= 1e-7);
  // phi_d means little where either angle is small; 0 and pi are one place.
  const double turn = std::remainder(a.phi_d - b.phi_d, kPi);
  RC_ASSERT(std::abs(turn) * std::sin(a.theta_h) * std::sin(a.theta_d) <= 1e-7);
}

RC_GTEST_PROP(HalfDiffProperty, DirectionsComeBackUpToARotation, ()) {
  const Eigen::Vector3d wi = AnyDirectionAbove(1e-6),
                        wo = AnyDirectionAbove(1e-6);
  const HalfDiff a = ToHalfDiff(wi, wo);
  Eigen::Vector3d u, v;
  FromHalfDiff(a, &u, &v);
  // Angles between the directions and their heights are kept; which is which
  // is not.
  RC_ASSERT(std::abs(u.dot(v) - wi.dot(wo)) <= 1e-7);
  RC_ASSERT(std::abs(u.z() + v.z() - wi.z() - wo.z()) <= 1e-6);
  RC_ASSERT(std::abs(u.z() * v.z() - wi.z() * wo.z()) <= 1e-6);
}

RC_GTEST_PROP(HalfDiffProperty, BoundIsWhereADirectionMeetsTheHorizon, ()) {
  const double theta_d = *Between(0.0, kPi / 2), phi_d = *Between(0.0, kPi);
  const double bound = ThetaHBound(theta_d, phi_d);
  RC_ASSERT(bound >= 0.0 && bound <= kPi / 2);
  Eigen::Vector3d u, v;
  FromHalfDiff({bound, theta_d, phi_d}, &u, &v);
  RC_ASSERT(std::min(u.z(), v.z()) >= -1e-7);
  if (bound < kPi / 2 - 1e-6) RC_ASSERT(std::min(u.z(), v.z()) <= 1e-6);
}

RC_GTEST_PROP(FlowBrdfProperty, IsReciprocalFiniteAndNotNegative, ()) {
  const NeuralBrdfModel model = AnyModel();
  const std::vector<double> lobes = AnyLobes(model, 2);
  const FlowBrdf brdf(model, lobes.data(), 2, 1);
  const Eigen::Vector3d wi = AnyDirectionAbove(1e-6),
                        wo = AnyDirectionAbove(1e-6);
  const auto f = brdf.Evaluate({ToHalfDiff(wi, wo)}),
             g = brdf.Evaluate({ToHalfDiff(wo, wi)});
  for (int c = 0; c < 3; ++c) {
    RC_ASSERT(std::isfinite(f[0][c]) && f[0][c] >= 0.0);
    // Angles differ by rounding, which the steepest splines multiply.
    const double near = 1e-3 * (f[0][c] + g[0][c]);
    const HalfDiff a = ToHalfDiff(wi, wo);
    if (std::sin(a.theta_h) * std::sin(a.theta_d) > 1e-3) {
      RC_ASSERT(std::abs(f[0][c] - g[0][c]) <= near);
    }
  }
}

RC_GTEST_PROP(FlowBrdfProperty, IsLinearInItsColours, ()) {
  const NeuralBrdfModel model = AnyModel();
  std::vector<double> lobes = AnyLobes(model, 1);
  const double factor = *Magnitude(1e-3, 1e3);
  const HalfDiff at{*Between(0.0, 1.5), *Between(0.0, 1.5), *Between(0.0, 3.1)};
  const auto f = FlowBrdf(model, lobes.data(), 1, 1).Evaluate({at});
  for (int c = 0; c < 3; ++c) {
    lobes[model.shape.code_size() + c] += std::log(factor);
  }
  const auto g = FlowBrdf(model, lobes.data(), 1, 1).Evaluate({at});
  for (int c = 0; c < 3; ++c) {
    RC_ASSERT(std::abs(g[0][c] - factor * f[0][c]) <= 1e-5 * g[0][c]);
  }
}

RC_GTEST_PROP(FlowProperty, InverseAndForwardAreTheIdentity, ()) {
  const NeuralBrdfModel model = AnyModel();
  const auto flow = BrdfFlow::Create(model.shape, model.weights);
  std::vector<float> code;
  for (const double v : AnyLobes(model, 1))
    code.push_back(static_cast<float>(v));
  // Faces and edges of the cube too.
  std::vector<double> u(3), x(3), back(3);
  for (double& v : u) v = *rc::gen::oneOf(Unit(), rc::gen::element(0.0, 1.0));
  flow->Inverse(u.data(), 1, code.data(), 1, x.data());
  flow->Latent(x.data(), 1, code.data(), 1, back.data());
  for (int d = 0; d < 3; ++d) {
    RC_ASSERT(x[d] >= 0.0 && x[d] <= 1.0);
    RC_ASSERT(std::abs(back[d] - u[d]) <= 1e-4);
  }
}

RC_GTEST_PROP(BrdfGridProperty, TapsAreWeightsOfACell, ()) {
  const BrdfGridShape shape{*rc::gen::inRange(2, 90), *rc::gen::inRange(2, 40),
                            *rc::gen::inRange(1, 30)};
  const Eigen::Vector3d x =
      ToUnitCube(*Between(0.0, kPi / 2), *Between(0.0, kPi / 2),
                 *Between(0.0, kPi * (1 - 1e-12)));
  const BrdfGridTaps taps = GridTaps(shape, x);
  double sum = 0.0;
  for (int k = 0; k < 8; ++k) {
    RC_ASSERT(taps.weight[k] >= 0.0);
    RC_ASSERT(taps.node[k] >= 0 && taps.node[k] < shape.num_nodes());
    sum += taps.weight[k];
  }
  RC_ASSERT(std::abs(sum - 1.0) <= 1e-12);
}

RC_GTEST_PROP(CookTorranceProperty, IsReciprocalAndFinite, ()) {
  CookTorrance brdf;
  brdf.diffuse.setConstant(*Unit());
  brdf.specular.setConstant(*Unit());
  brdf.roughness.setConstant(*Magnitude(1e-3, 10.0));
  brdf.f0.setConstant(*Unit());
  const Eigen::Vector3d wi = AnyDirectionAbove(1e-6),
                        wo = AnyDirectionAbove(1e-6);
  const HalfDiff a = ToHalfDiff(wi, wo), b = ToHalfDiff(wo, wi);
  const Eigen::Array3d f = brdf.Evaluate(a.theta_h, a.theta_d, a.phi_d),
                       g = brdf.Evaluate(b.theta_h, b.theta_d, b.phi_d);
  RC_ASSERT(f.isFinite().all() && (f >= 0.0).all());
  // exp(-(tan / roughness)^2) multiplies the angles' rounding.
  const double steep = 1.0 + std::pow(std::tan(std::min(a.theta_h, 1.57)), 2) /
                                 std::pow(brdf.roughness[0], 2);
  RC_ASSERT(std::abs(f[0] - g[0]) <= 1e-7 * steep * (f[0] + g[0]) + 1e-300);
}

}  // namespace
}  // namespace ibrdf

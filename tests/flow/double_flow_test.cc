#include "ibrdf/flow/double_flow.h"

#include <gtest/gtest.h>

#include <vector>

#include "ibrdf/flow/coupling_flow.h"
#include "tests/support/small_flow.h"

namespace ibrdf {
namespace {

// The level's tables, rounded once, are the reference's values point by point.
void ExpectReference(const NeuralBrdfModel& model) {
  const auto flow =
      BrdfFlow::Create(model.shape, model.weights, SimdLevel::kDouble);
  const ReferenceFlow reference(model);
  const int codes = model.shape.code_size();
  std::vector<float> code(codes);
  for (int k = 0; k < codes; ++k) code[k] = 0.3f - 0.25f * k;
  const std::vector<double> z(code.begin(), code.end());
  FlowColumns x(5, 4);
  for (int c = 0; c < x.columns; ++c) {
    x.SetColumn(c, 0.1 + 0.17 * c, 0.9 - 0.2 * c);
    for (int i = 0; i < x.points; ++i) {
      x.x_h[i * x.columns + c] = 0.05f + 0.28f * i + 0.01f * c;
    }
  }
  const size_t n = x.num_points();
  std::vector<float> value(n), only(n), gradient(n * codes);
  flow->LogDensityOnColumns(x, code.data(), 2, only.data(), nullptr);
  flow->LogDensityOnColumns(x, code.data(), 2, value.data(), gradient.data());
  for (size_t at = 0; at < n; ++at) {
    const size_t c = at % x.columns;
    const double point[3] = {x.x_h[at], x.x_d[c], x.x_p[c]};
    std::vector<double> by_code(codes);
    const double expected =
        reference.LogDensity(point, z.data(), by_code.data());
    // Rounding of the result, and of sums in another order in double.
    EXPECT_FLOAT_EQ(static_cast<float>(expected), value[at]);
    EXPECT_FLOAT_EQ(value[at], only[at]);
    for (int k = 0; k < codes; ++k) {
      EXPECT_FLOAT_EQ(static_cast<float>(by_code[k]), gradient[k * n + at]);
    }
  }
}

TEST(DoubleFlow, TablesAreTheReferenceOfATriangularFlow) {
  ExpectReference(SmallFlowModel(3.0f));
}

TEST(DoubleFlow, TablesAreTheReferenceOfACouplingFlow) {
  NeuralBrdfModel model;
  model.shape.architecture = FlowArchitecture::kCoupling;
  model.weights = InitialFlowWeights(model.shape, 3);
  ExpectReference(model);
}

TEST(DoubleFlow, NewWeightsReachTheReference) {
  const NeuralBrdfModel a = SmallFlowModel(3.0f, 5),
                        b = SmallFlowModel(3.0f, 6);
  const auto flow = BrdfFlow::Create(a.shape, a.weights, SimdLevel::kDouble);
  const auto other = BrdfFlow::Create(b.shape, b.weights, SimdLevel::kDouble);
  flow->SetWeights(b.weights);
  FlowColumns x(1, 1);
  x.SetColumn(0, 0.3, 0.4);
  x.x_h[0] = 0.6f;
  const float code[3] = {0.1f, 0.2f, -0.3f};
  float set = 0.0f, made = 1.0f;
  flow->LogDensityOnColumns(x, code, 1, &set, nullptr);
  other->LogDensityOnColumns(x, code, 1, &made, nullptr);
  EXPECT_EQ(made, set);
}

}  // namespace
}  // namespace ibrdf

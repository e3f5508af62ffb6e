#include "ibrdf/solvers/training/material_lobes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

TEST(MaterialLobes, AreSortedFiniteAndCloseToTheirMaterial) {
  NeuralBrdfModel model = TinyModel(2);
  ASSERT_TRUE(FitMaterialLobes(2, false, 2, nullptr, &model).ok());
  EXPECT_EQ(2, model.fit_lobes);
  EXPECT_FALSE(model.fit_lambertian);
  ASSERT_EQ(2u * 2 * 7, model.lobe_fits.size());
  for (const float v : model.lobe_fits) EXPECT_TRUE(std::isfinite(v));
  NeuralBrdfModel again = TinyModel(2);
  ASSERT_TRUE(FitMaterialLobes(2, false, 1, nullptr, &again).ok());
  EXPECT_EQ(model.lobe_fits, again.lobe_fits);
  const std::atomic<bool> stop{true};
  EXPECT_EQ(StatusCode::kInterrupted,
            FitMaterialLobes(1, true, 1, &stop, &again).code());
  EXPECT_EQ(model.lobe_fits, again.lobe_fits);
  EXPECT_FALSE(again.fit_lambertian);
}

TEST(MaterialLobes, LambertianLobeIsLast) {
  NeuralBrdfModel model = TinyModel(2);
  ASSERT_TRUE(FitMaterialLobes(2, true, 2, nullptr, &model).ok());
  EXPECT_TRUE(model.fit_lambertian);
  EXPECT_EQ(17, model.fit_size());
  ASSERT_EQ(2u * 17, model.lobe_fits.size());
  for (const float v : model.lobe_fits) EXPECT_TRUE(std::isfinite(v));
}

}  // namespace
}  // namespace ibrdf

#include "ibrdf/solvers/entropy_study/material_parameters.h"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr double kRounding = 1e-12;

TEST(GlossOf, IsWhatTheTableReflectsBeyondTheMattePart) {
  Disney fit;
  fit.base = {0.5, 0.3, 0.9};
  fit.roughness = 0.4;
  fit.specular = 0.5;  // F_0 = 0.04
  const GlossParameters gloss = GlossOf(fit, {0.6, 0.31, 0.8});
  EXPECT_EQ(0.4, gloss.roughness);
  EXPECT_NEAR(0.1, gloss.Ks[0], kRounding);
  // Not below F_0.
  EXPECT_NEAR(0.04, gloss.Ks[1], kRounding);
  EXPECT_NEAR(0.04, gloss.Ks[2], kRounding);
  // No more than all that is reflected.
  EXPECT_NEAR(0.5, gloss.Kd[0], kRounding);
  EXPECT_NEAR(0.8, gloss.Kd[2], kRounding);
}

TEST(GlossOf, OfAMetalIsItsColour) {
  Disney fit;
  fit.base = {1.4, 0.7, 0.2};
  fit.metallic = 1.0;
  const GlossParameters gloss = GlossOf(fit, {0.5, 0.5, 0.5});
  EXPECT_EQ(1.0, gloss.Ks[0]);
  EXPECT_NEAR(0.7, gloss.Ks[1], kRounding);
  EXPECT_NEAR(0.5, gloss.Ks[2], kRounding);
  EXPECT_TRUE((gloss.Kd == 0.0).all());
}

TEST(MaterialParameters, RefusesAFolderWithoutTables) {
  const TempDir dir;
  MaterialParametersOptions options;
  options.data = dir.path();
  options.out = dir.File("out");
  const Status status = RunMaterialParameters(options);
  EXPECT_EQ(2, status.ExitCode());
  EXPECT_NE(std::string::npos, status.message().find(dir.path()));
}

}  // namespace
}  // namespace ibrdf

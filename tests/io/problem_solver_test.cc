// The solver, the effects and the kind of problem in problem files.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ibrdf/io/problem_json.h"
#include "tests/io/problem_file_fixture.h"

namespace ibrdf {
namespace {

TEST_F(ProblemFile, GaugesAreOfJointProblems) {
  const std::string least = kLeast;
  EXPECT_EQ(SolverGauge::kPrior,
            Read(least + "solver: {gauge: prior}")->solver.gauge);
  EXPECT_EQ(SolverGauge::kUnitLight,
            Read(least + "solver: {gauge: unit_light}")->solver.gauge);
}

TEST_F(ProblemFile, SearchesAreOfJointProblems) {
  const StatusOr<Problem> p =
      Read(std::string(kLeast) + "solver: {search: thorough}");
  ASSERT_TRUE(p.ok()) << p.status().message();
  EXPECT_EQ(SolverSearch::kThorough, p->solver.search);
  EXPECT_EQ("thorough", ProblemToJson(*p)["solver"]["search"]);
}

TEST_F(ProblemFile, TurnsAreOfJointProblems) {
  EXPECT_EQ(2, Read(kLeast)->solver.turns);
  const StatusOr<Problem> p = Read(kLeast, {"solver.turns=0"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  EXPECT_EQ(0, p->solver.turns);
  EXPECT_EQ(0, ProblemToJson(*p)["solver"]["turns"]);
  for (const std::string turns : {"-1", "21", "many", "1.5"}) {
    const Status s = Read(kLeast, {"solver.turns=" + turns}).status();
    EXPECT_EQ(StatusCode::kInvalidInput, s.code()) << turns;
    EXPECT_NE(std::string::npos, s.message().find("solver.turns")) << turns;
  }
  const Status needs = Read(kLeast, {"solver.turns=2", "problem=reflectance",
                                     "illumination={known: map.hdr}"})
                           .status();
  EXPECT_EQ(StatusCode::kInvalidInput, needs.code());
  EXPECT_NE(std::string::npos, needs.message().find("solver.turns"));
}

TEST_F(ProblemFile, EveryMethodIsReadByItsName) {
  for (int m = 0; m < kNumSolverMethods; ++m) {
    const auto method = static_cast<SolverMethod>(m);
    const std::string name = SolverMethodName(method);
    const StatusOr<Problem> p = Read(kLeast, {"solver.method=" + name});
    ASSERT_TRUE(p.ok()) << p.status().message();
    EXPECT_EQ(method, p->solver.method);
    EXPECT_EQ(name, ProblemToJson(*p)["solver"]["method"]);
  }
  EXPECT_EQ(SolverMethod::kTrustRegion,
            Read(kLeast, {"solver.method=trust_region"})->solver.method);
}

TEST_F(ProblemFile, EffectsOfRendersAreNoneOfSolves) {
  for (const std::string effect : {"harmonics", "gaussians"}) {
    const StatusOr<Problem> read = Read(kLeast, {"effects=[" + effect + "]"});
    ASSERT_TRUE(read.ok()) << read.status().message();
    const Status s = CheckSolvable(*read);
    EXPECT_EQ(StatusCode::kInvalidInput, s.code());
    EXPECT_NE(std::string::npos, s.message().find("effects: " + effect));
  }
  EXPECT_TRUE(CheckSolvable(*Read(kLeast, {"effects=[visibility]"})).ok());
  // What no program simulates.
  for (const std::string effect : {"sharp_lobes", "perspective"}) {
    EXPECT_NE(std::string::npos,
              ErrorOf(kLeast, {"effects=[" + effect + "]"}).find(effect));
  }
}

TEST_F(ProblemFile, KnownPartsMustFitTheKind) {
  const struct {
    const char* kind;
    bool brdf, light, ok;
  } cases[] = {
      {"joint", false, false, true},
      {"joint", true, false, false},
      {"joint", false, true, false},
      {"reflectance", false, true, true},
      {"reflectance", false, false, false},
      {"illumination", true, false, true},
      {"illumination", false, false, false},
  };
  for (const auto& c : cases) {
    std::vector<std::string> overrides = {std::string("problem=") + c.kind};
    if (c.brdf) overrides.emplace_back("reflectance.known=a.binary");
    if (c.light) overrides.emplace_back("illumination.known=a.exr");
    const StatusOr<Problem> read = Read(kLeast, overrides);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(c.ok, CheckSolvable(*read).ok()) << c.kind;
  }
}

}  // namespace
}  // namespace ibrdf

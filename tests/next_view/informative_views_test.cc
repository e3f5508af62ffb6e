#include "ibrdf/solvers/next_view/informative_views.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/estimation/search_settings.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/marginal/marginal_objective.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kSize = 16;  // pixels a side

// A ball seen from +z, and its estimate, which is the truth.
class InformativeViewsTest : public ::testing::Test {
 protected:
  InformativeViewsTest() {
    problem_.points = SpherePoints(kSize);
    problem_.model =
        std::make_shared<const NeuralBrdfModel>(SmoothTinyModel(4));
    problem_.transport = TinyTransportOptions();
    problem_.num_threads = 1;
    problem_.map_width = 16;
    problem_.map_height = 8;
    problem_.image = Image(kSize, kSize);
    const std::vector<double> radiance =
        RenderTinyLobes(*problem_.model, problem_.points, SmoothMap(8, 16));
    for (size_t i = 0; i < problem_.points.size(); ++i) {
      for (size_t c = 0; c < 3; ++c) {
        problem_.image.rgb[size_t{3} * problem_.points[i].pixel + c] =
            static_cast<float>(radiance[3 * i + c]);
      }
    }
    object_.radiance = problem_.image;
    solution_.lobe_parameters = TinyLobes();
    const size_t n = solution_.lobe_parameters.size();
    solution_.lobe_covariance.assign(n * n, 0.0);
    solution_.directional_lights = {
        Eigen::Vector3d(0.5, 0.6, 0.6).normalized()};
  }

  NextViewCandidates Candidates(const std::string& text) const {
    return LoadNextViewCandidates(Problem(), object_, text, 1).value();
  }
  InformativeViews Choose(const NextViewCandidates& candidates,
                          int count) const {
    return ChooseInformativeViews(problem_, solution_, candidates, count)
        .value();
  }

  InverseProblem problem_;
  PhotographedObject object_;
  Solution solution_;
};

TEST_F(InformativeViewsTest, TakesTheBestEachTime) {
  const InformativeViews next = Choose(Candidates("sphere:9"), 4);
  ASSERT_EQ(4u, next.chosen.size());
  ASSERT_EQ(4u, next.gains.size());
  ASSERT_EQ(4u, next.farthest.size());
  ASSERT_EQ(9u, next.first_gains.size());
  const auto best =
      std::max_element(next.first_gains.begin(), next.first_gains.end());
  EXPECT_EQ(best - next.first_gains.begin(), next.chosen[0]);
  EXPECT_EQ(*best, next.gains[0]);
  EXPECT_EQ(4u, std::set<int>(next.chosen.begin(), next.chosen.end()).size());
  for (const double gain : next.first_gains) EXPECT_GT(gain, 0.0);
  for (const double gain : next.gains) EXPECT_GT(gain, 0.0);
  EXPECT_GT(next.information, 1.0);
}

// What the photographs say is what the search's own information says of them,
// the lights' offsets and the hyperparameters integrated out.
TEST_F(InformativeViewsTest, InformationOfPhotographsIsTheSearchs) {
  const SolveSetup setup = ibrdf::SetUp(problem_).value();
  MarginalResolution resolution = ReflectanceSearchOptions().fine;
  AdaptResolution(problem_, 2, &resolution);
  const MarginalReflectance reflectance(
      FlowLobes::Factory(*problem_.model, setup.lobes->layout(), 1),
      problem_.points, SearchedPixels(setup), LightProcess(), resolution, 1,
      solution_.directional_lights);
  const Eigen::VectorXd x =
      reflectance.WithDirectionalLights(ToEigen(solution_.lobe_parameters));
  LightMode mode;
  const DataErrors errors = reflectance.likelihood().FindErrors(
      reflectance.Matrices(x.data()), {}, 0.03, solution_.light_hyperparameters,
      1e-6, &mode);
  const MarginalObjective objective(&reflectance, &setup.materials, errors,
                                    &mode);
  const std::vector<double> y =
      objective.Whitened(x, solution_.light_hyperparameters);
  std::vector<double> gradient(y.size());
  double cost = 0.0;
  ASSERT_TRUE(objective.Evaluate(y.data(), &cost, gradient.data()));
  const Eigen::Index n = setup.materials.num_parameters();
  const Eigen::MatrixXd covariance =
      objective.Information(y.data()).inverse().topLeftCorner(n, n);
  const double nats =
      -0.5 *
      Eigen::LDLT<Eigen::MatrixXd>(covariance).vectorD().array().log().sum();
  // The mode is found to 1e-6 nats on both ways.
  EXPECT_NEAR(nats, Choose(Candidates("sphere:1"), 1).information, 1e-3);
}

// The photograph's own place tells less than the other side.
TEST_F(InformativeViewsTest, ViewAlreadyTakenGainsLess) {
  NextViewCandidates candidates = Candidates("sphere:2");
  const double distance =
      candidates.views[0].world_from_camera.topRightCorner<3, 1>().norm();
  for (int k = 0; k < 2; ++k) {
    Eigen::Matrix4d& pose = candidates.views[k].world_from_camera;
    pose.setIdentity();
    if (k == 1) {
      pose(0, 0) = pose(2, 2) = -1.0;  // half a turn about y
    }
    pose(2, 3) = k == 0 ? distance : -distance;
    const Camera camera = CandidateCamera(candidates.views[k], 1.0, 64)->camera;
    candidates.points[k] =
        FindShadingPoints(candidates.scene, camera, 64, 64, Mask(), 1).value();
  }
  const InformativeViews next = Choose(candidates, 2);
  EXPECT_GT(next.first_gains[1], 1.2 * next.first_gains[0]);
  EXPECT_EQ((std::vector<int>{1, 0}), next.chosen);
  // The other side is farther, too.
  EXPECT_EQ((std::vector<int>{1, 0}), next.farthest);
}

TEST_F(InformativeViewsTest, OrderOfCandidatesDoesNotMatter) {
  const NextViewCandidates forth = Candidates("sphere:7");
  NextViewCandidates back = forth;
  std::reverse(back.views.begin(), back.views.end());
  std::reverse(back.points.begin(), back.points.end());
  const InformativeViews one = Choose(forth, 3), other = Choose(back, 3);
  ASSERT_EQ(3u, other.chosen.size());
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(one.candidates[one.chosen[k]].name,
              other.candidates[other.chosen[k]].name);
    // Some candidates are transported together: products round otherwise.
    EXPECT_NEAR(one.gains[k], other.gains[k], 1e-8 * one.gains[k]);
  }
}

TEST_F(InformativeViewsTest, SameBitsForAnyNumberOfThreads) {
  const NextViewCandidates candidates = Candidates("sphere:7");
  const InformativeViews one = Choose(candidates, 3);
  problem_.num_threads = 3;
  const InformativeViews three = Choose(candidates, 3);
  EXPECT_EQ(one.chosen, three.chosen);
  EXPECT_EQ(one.gains, three.gains);
  EXPECT_EQ(one.first_gains, three.first_gains);
  EXPECT_EQ(one.information, three.information);
}

TEST_F(InformativeViewsTest, BlindCandidatesAreNotTaken) {
  NextViewCandidates candidates = Candidates("sphere:3");
  candidates.points[1].clear();
  const InformativeViews next = Choose(candidates, 10);
  EXPECT_EQ(0.0, next.first_gains[1]);
  ASSERT_EQ(2u, next.chosen.size());
  EXPECT_EQ(0, std::count(next.chosen.begin(), next.chosen.end(), 1));
  EXPECT_EQ(2u, next.farthest.size());
}

TEST_F(InformativeViewsTest, SaysWhyThereAreNone) {
  const NextViewCandidates candidates = Candidates("sphere:3");
  solution_.lobe_covariance.clear();
  const Status none =
      ChooseInformativeViews(problem_, solution_, candidates, 1).status();
  EXPECT_EQ(StatusCode::kNoImprovement, none.code());
  EXPECT_NE(std::string::npos, none.message().find("no posterior"));
  solution_.albedo = Image(2, 2);
  EXPECT_NE(std::string::npos,
            ChooseInformativeViews(problem_, solution_, candidates, 1)
                .status()
                .message()
                .find("painted"));
}

}  // namespace
}  // namespace ibrdf

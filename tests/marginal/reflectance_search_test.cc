#include "ibrdf/solvers/marginal/reflectance_search.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/cook_torrance_lobes.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/table_lobes.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/marginal/model_search.h"
#include "tests/marginal/marginal_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

class ReflectanceSearchTest : public MarginalTest {
 protected:
  ReflectanceSearchOptions Options() const {
    ReflectanceSearchOptions options;
    options.screen = options.coarse = options.fine = resolution_;
    options.kept = 3;
    options.coarse_stages = {{3, 1}, {2, 3}};
    options.ranked_anew = 0;
    options.fine_iterations = 4;
    options.num_threads = 1;
    return options;
  }
};

// What Cook-Torrance rendered, from other materials.
TEST_F(ReflectanceSearchTest, AmongCookTorranceExplainsItsOwn) {
  const auto paint = [](double roughness, double diffuse) {
    CookTorrance brdf;
    brdf.diffuse = diffuse * Eigen::Array3d(1.0, 0.7, 0.4);
    brdf.specular.setConstant(1.0);
    brdf.roughness.setConstant(roughness);
    brdf.f0.setConstant(0.2);
    return CookTorranceLobes::ToParameters(brdf);
  };
  TransportOptions transport;
  transport.grid = resolution_.grid;
  transport.num_threads = 1;
  const CookTorranceLobes lobes(resolution_.grid, 1);
  const std::vector<double> truth = paint(0.25, 0.1);
  std::vector<double> image(3 * points_.size());
  Transport(points_, 8, 16, transport)
      .Render(lobes.Grid(truth.data()), SmoothMap(8, 16).rgb.data(),
              image.data());
  std::vector<MaterialPrior::Material> materials;
  for (const double roughness : {0.1, 0.4, 0.8}) {
    for (const double diffuse : {0.03, 0.3}) {
      materials.push_back(
          {std::to_string(roughness), ToEigen(paint(roughness, diffuse))});
    }
  }
  MaterialPrior prior = GaussianPrior(materials, CookTorranceLobes::kCode);
  prior.wall = 0.0;
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance({CookTorranceLobes::Factory(1), &prior}, points_,
                        MakeObservations(image), Options());
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_LT(found->misfit, found->candidates[0].first_misfit);
  ASSERT_EQ(10u, found->parameters.size());
  // Those that came to something.
  ASSERT_LE(2u, found->coarse_optima.size());
  for (size_t k = 1; k < found->coarse_optima.size(); ++k) {
    EXPECT_LE(found->coarse_optima[k - 1].cost, found->coarse_optima[k].cost);
  }
  for (const CoarseOptimum& optimum : found->coarse_optima) {
    EXPECT_EQ(10u, optimum.parameters.size()) << optimum.name;
    EXPECT_GE(optimum.cost, found->cost) << optimum.name;
  }
  // All three resolutions are one: costs compare.
  for (const MaterialCandidate& tried : found->candidates) {
    EXPECT_LT(found->cost, tried.first_cost - 5.0) << tried.name;
  }
}

// The reflectance does not move, and the light of a directional light in dim
// surroundings is found with it.
TEST_F(ReflectanceSearchTest, UnderAKnownReflectanceFindsTheLight) {
  CookTorrance paint;
  paint.diffuse = {0.1, 0.07, 0.04};
  paint.specular.setConstant(1.0);
  paint.roughness.setConstant(0.2);
  paint.f0.setConstant(0.2);
  const BrdfGrid known =
      BrdfGrid::FromFunction(paint.Function(), resolution_.grid);
  const std::vector<ShadingPoint> points = SpherePoints(24);
  Image map = SmoothMap(16, 32);
  double row = 0.0, column = 0.0;
  MapPosition(kDirectionalLights[0], 16, 32, &row, &column);
  row = std::floor(row);
  column = std::floor(column);
  const Eigen::Vector3d directional_light =
      MapDirection(row + 0.5, column + 0.5, 16, 32);
  for (int c = 0; c < 3; ++c) {
    map.rgb[3 * static_cast<size_t>(row * 32 + column) + c] *= 200.0f;
  }
  TransportOptions transport;
  transport.grid = resolution_.grid;
  transport.num_threads = 1;
  std::vector<double> image(3 * points.size());
  Transport(points, 16, 32, transport)
      .Render(known, map.rgb.data(), image.data());
  ReflectanceSearchOptions options = Options();
  options.covariance = false;
  const std::vector<double> parameters = TableLobes::KnownParameters();
  const MaterialPrior prior = KnownMaterial(ToEigen(parameters));
  EXPECT_EQ(0.0, prior.Cost(ToEigen(parameters), nullptr));
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance({TableLobes::Factory(known), &prior}, points,
                        MakeObservations(image), options);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_EQ("known", found->initial_guess);
  ASSERT_EQ(parameters.size(), found->parameters.size());
  for (size_t i = 0; i < parameters.size(); ++i) {
    EXPECT_NEAR(parameters[i], found->parameters[i], 1e-6);
  }
  ASSERT_FALSE(found->directional_lights.empty());
  EXPECT_GT(found->directional_lights[0].dot(directional_light),
            std::cos(5.0 * kDegree));
  // All resolutions are one: costs compare.
  EXPECT_LT(found->cost, found->candidates[0].first_cost);
  EXPECT_LT(found->misfit, found->candidates[0].first_misfit);
}

// No infinite cost gets into a trace either.
TEST_F(ReflectanceSearchTest, UnderABlackReflectanceSaysSo) {
  const BrdfGrid black = BrdfGrid::FromFunction(
      [](double, double, double) { return Eigen::Array3d::Zero().eval(); },
      resolution_.grid);
  const MaterialPrior prior =
      KnownMaterial(ToEigen(TableLobes::KnownParameters()));
  ReflectanceSearchOptions options = Options();
  int reports = 0;
  options.report = [&](const std::string&, double, double) { ++reports; };
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance({TableLobes::Factory(black), &prior}, points_,
                        MakeObservations(radiance_), options);
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(StatusCode::kNoImprovement, found.status().code());
  EXPECT_EQ(0, reports);
}

TEST_F(ReflectanceSearchTest, LowersTheCostWhateverTheThreads) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  ReflectanceSearchOptions options = Options();
  const StatusOr<ReflectanceSearchResult> one =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(radiance_), options);
  ASSERT_TRUE(one.ok()) << one.status().message();
  ASSERT_EQ(14u, one->parameters.size());
  ASSERT_EQ(4u, one->candidates.size());
  EXPECT_EQ(one->candidates[0].cost, one->cost);
  EXPECT_EQ(one->candidates[0].name, one->initial_guess);
  EXPECT_EQ(one->candidates[0].parameters, one->parameters);
  for (size_t i = 1; i < one->candidates.size(); ++i) {
    EXPECT_LE(one->candidates[i - 1].cost, one->candidates[i].cost);
  }
  EXPECT_LT(one->misfit, 0.1);
  for (const double s : one->log_radiance_std) {
    EXPECT_TRUE(std::isfinite(s) && s >= 0.0);
  }
  // Seen texels are known better than before; none is worse.
  ASSERT_EQ(one->log_radiance_std.size(),
            one->log_radiance_variance_left.size());
  double least = 1.0;
  for (const double left : one->log_radiance_variance_left) {
    EXPECT_TRUE(left >= 0.0 && left <= 1.0) << left;
    least = std::min(least, left);
  }
  EXPECT_LT(least, 0.5);
  ASSERT_EQ(14, one->covariance.rows());
  EXPECT_LT((one->covariance - one->covariance.transpose()).norm(),
            1e-9 * one->covariance.norm());
  const Eigen::LLT<Eigen::MatrixXd> llt(one->covariance);
  EXPECT_EQ(Eigen::Success, llt.info());
  // The image tells something: no direction is wider than the prior's twice.
  const Eigen::VectorXd prior_variance =
      (prior.factor * prior.factor.transpose()).diagonal();
  EXPECT_LT(one->covariance.trace(), prior_variance.sum());
  options.num_threads = 2;
  const StatusOr<ReflectanceSearchResult> two =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(radiance_), options);
  ASSERT_TRUE(two.ok());
  EXPECT_EQ(one->parameters, two->parameters);
  EXPECT_EQ(one->log_radiance, two->log_radiance);
}

// What the object throws on itself, told by the caller, is taken out.
TEST_F(ReflectanceSearchTest, BouncesAreTakenOutOfTheImage) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  std::vector<double> gain(radiance_.size()), brighter = radiance_;
  for (size_t i = 0; i < gain.size(); ++i) {
    gain[i] = 1.0 + 0.8 * std::pow(std::sin(1.7 * (i / 3)), 2);
    brighter[i] *= gain[i];
  }
  ReflectanceSearchOptions options = Options();
  const ReflectanceSearchResult clean =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(radiance_), options)
          .value();
  const ReflectanceSearchResult left =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(brighter), options)
          .value();
  int calls = 0;
  SearchedModel model = {FlowLobes::Factory(model_, 2, 1), &prior};
  model.bounce_gain = [&](const std::vector<double>& lobes,
                          const std::vector<double>& log_radiance) {
    ++calls;
    EXPECT_EQ(14u, lobes.size());
    EXPECT_EQ(size_t{3} * left.map_width * left.map_height,
              log_radiance.size());
    return gain;
  };
  const ReflectanceSearchResult taken =
      SearchReflectance(model, points_, MakeObservations(brighter), options)
          .value();
  EXPECT_EQ(options.bounce_iterations, calls);
  EXPECT_GT(left.cost, clean.cost + 5.0);
  EXPECT_LT(taken.misfit, 1.2 * clean.misfit);
  // Lower where its rounds, of more iterations, came further.
  EXPECT_LT(taken.cost, clean.cost + 0.1 * (left.cost - clean.cost));
  // Where there is nothing to be had all stays.
  model.bounce_gain = [](const auto&, const auto&) {
    return std::vector<double>();
  };
  EXPECT_EQ(
      left.parameters,
      SearchReflectance(model, points_, MakeObservations(brighter), options)
          .value()
          .parameters);
}

TEST_F(ReflectanceSearchTest, WiderMarginsNeverEndAtAHigherCost) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  ReflectanceSearchOptions options = Options();
  options.covariance = false;
  options.coarse_margin = 1e9;
  // Coarse steps leave something to do.
  options.coarse_stages = {{4, 1}};
  options.margin = 0.0;
  const StatusOr<ReflectanceSearchResult> one =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(radiance_), options);
  options.margin = 1e9;
  const StatusOr<ReflectanceSearchResult> all =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(radiance_), options);
  ASSERT_TRUE(one.ok() && all.ok());
  EXPECT_LE(all->cost, one->cost);
  // What the narrow ones left where it was is refined now.
  double change = 0.0;
  for (const MaterialCandidate& a : one->candidates) {
    for (const MaterialCandidate& b : all->candidates) {
      if (a.name == b.name && std::isfinite(a.cost)) change += a.cost - b.cost;
    }
  }
  EXPECT_GT(change, 0.0);
}

class TwoModelsTest : public ReflectanceSearchTest {
 protected:
  const NeuralBrdfModel other_ = SmoothTinyModel(4, 7);
  const MaterialPrior prior_ = JointMaterialPrior(model_, 2, 0.5);
  const MaterialPrior of_other_ = JointMaterialPrior(other_, 2, 0.5);
  const std::vector<SearchedModel> models_ = {
      {FlowLobes::Factory(model_, 2, 1), &prior_},
      {FlowLobes::Factory(other_, 2, 1), &of_other_}};
};

// Where nothing is dropped the models do not meet.
TEST_F(TwoModelsTest, ModelsWithoutCompetitionFindWhatEachFindsAlone) {
  ReflectanceSearchOptions options = Options();
  options.kept = 100;
  options.coarse_stages = {{100, 1}, {100, 2}};
  options.coarse_margin = options.margin = 1e9;
  const StatusOr<std::vector<ReflectanceSearchResult>> both =
      SearchReflectances(models_, points_, MakeObservations(radiance_),
                         options);
  ASSERT_TRUE(both.ok()) << both.status().message();
  ASSERT_EQ(2u, both->size());
  const size_t best = (*both)[0].cost < (*both)[1].cost ? 0 : 1;
  for (size_t m = 0; m < 2; ++m) {
    const ReflectanceSearchResult& found = (*both)[m];
    const ReflectanceSearchResult alone =
        SearchReflectance(models_[m], points_, MakeObservations(radiance_),
                          options)
            .value();
    EXPECT_EQ(m, found.model);
    EXPECT_EQ(alone.parameters, found.parameters);
    EXPECT_EQ(alone.cost, found.cost);
    EXPECT_EQ(alone.log_radiance, found.log_radiance);
    EXPECT_EQ(m == best, found.covariance.size() > 0) << m;
  }
}

// At the fine resolution the candidates of all models compete.
TEST_F(TwoModelsTest, CandidatesOfAllModelsCompete) {
  ReflectanceSearchOptions options = Options();
  options.kept = 4;
  options.coarse_stages = {{3, 2}, {2, 2}};
  options.coarse_margin = options.margin = 0.0;
  options.fine.map_width *= 2;
  options.fine.map_height *= 2;
  std::vector<std::string> refined;
  options.report = [&](const std::string& stage, double, double) {
    refined.push_back(stage);
  };
  const StatusOr<std::vector<ReflectanceSearchResult>> found =
      SearchReflectances(models_, points_, MakeObservations(radiance_),
                         options);
  ASSERT_TRUE(found.ok()) << found.status().message();
  // Each model's best has been tried at the fine resolution, and no other.
  ASSERT_EQ(2u, found->size());
  for (const ReflectanceSearchResult& result : *found) {
    EXPECT_EQ(1,
              std::count_if(result.candidates.begin(), result.candidates.end(),
                            [](const MaterialCandidate& c) {
                              return std::isfinite(c.cost);
                            }));
  }
  ASSERT_GE(refined.size(), 4u);
  EXPECT_EQ("rank 8 materials", refined[0]);
  EXPECT_EQ("refine 6", refined[1]);
  EXPECT_EQ("refine 4", refined[2]);
  const ReflectanceSearchResult& best =
      (*found)[0].cost < (*found)[1].cost ? (*found)[0] : (*found)[1];
  EXPECT_EQ(std::vector<std::string>{"finish " + best.initial_guess},
            std::vector<std::string>(refined.begin() + 3, refined.end()));
}

TEST_F(ReflectanceSearchTest, MaterialsAreRankedAnewUnderTheLightThatWasFound) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  ReflectanceSearchOptions options = Options();
  options.kept = 4;
  options.ranked_anew = 2;
  std::vector<std::string> stages;
  options.report = [&](const std::string& stage, double, double) {
    stages.push_back(stage);
  };
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(radiance_), options);
  ASSERT_TRUE(found.ok()) << found.status().message();
  ASSERT_GT(stages.size(), 4u);
  EXPECT_EQ("rank 4 materials", stages[0]);
  EXPECT_EQ("refine 3", stages[1]);
  EXPECT_EQ("rank 4 materials", stages[2]);
  // The best two of the first stage and the two that joined.
  EXPECT_EQ("refine 4", stages[3]);
}

// Hyperparameters, directional lights and tolerance are those of the guess.
TEST_F(ReflectanceSearchTest, RankingTakesTheLightThatItIsTold) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  const SearchedModel model = {FlowLobes::Factory(model_, 2, 1), &prior};
  const ReflectanceSearchOptions options = Options();
  const Observations observed = MakeObservations(radiance_);
  ModelSearch search(model, points_, observed, kDirectionalLights, options);
  search.Rank({{LightHyperparameters(), {}}});
  ASSERT_TRUE(search.Take(search.rankings()[0][0]));
  EXPECT_FALSE(search.Take(search.rankings()[0][0]));
  ASSERT_TRUE(search.Join({search.Refine(search.candidates()[0], 1.0, 2)}, ""));
  LightGuess light = search.LightAt(search.candidates()[0]);
  ASSERT_EQ(4, light.offsets.size());
  EXPECT_GT(light.offsets.norm(), 0.0);
  light.tolerance = 2.0;
  search.Rank({light});
  const SearchLevel level(model.lobes, prior, points_, observed, options.coarse,
                          kDirectionalLights, options);
  ASSERT_FALSE(search.rankings()[0].empty());
  for (const MaterialUnderLight& ranked : search.rankings()[0]) {
    Eigen::VectorXd parameters(14 + 4);
    parameters << prior.materials[ranked.material].parameters, light.offsets;
    const TabulatedReflectance material = level.Tabulate(parameters);
    double misfit = 0.0;
    EXPECT_EQ(level.Rank(material, light.hyperparameters, 2.0 * options.sigma,
                         &misfit),
              ranked.cost);
    EXPECT_EQ(misfit, ranked.misfit);
    EXPECT_NE(
        level.Rank(material, light.hyperparameters, options.sigma, &misfit),
        ranked.cost);
  }
}

// Light of other offsets has matrices of its own.
TEST_F(ReflectanceSearchTest, RankingsTogetherAreThoseOfEachLight) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  const SearchedModel model = {FlowLobes::Factory(model_, 2, 1), &prior};
  const ReflectanceSearchOptions options = Options();
  const Observations observed = MakeObservations(radiance_);
  const std::vector<LightGuess> lights = {
      {LightHyperparameters(), {}},
      {LightHyperparameters(), Eigen::VectorXd::Constant(4, 0.1)},
      {LightHyperparameters::Harsh(), Eigen::VectorXd::Constant(4, 0.1), 2.0},
      {LightHyperparameters::Harsh(), {}}};
  ModelSearch together(model, points_, observed, kDirectionalLights, options);
  together.Rank(lights);
  ASSERT_EQ(lights.size(), together.rankings().size());
  for (size_t k = 0; k < lights.size(); ++k) {
    ModelSearch alone(model, points_, observed, kDirectionalLights, options);
    alone.Rank({lights[k]});
    const Ranking& of_all = together.rankings()[k];
    const Ranking& of_one = alone.rankings()[0];
    ASSERT_EQ(of_one.size(), of_all.size());
    for (size_t i = 0; i < of_one.size(); ++i) {
      EXPECT_EQ(of_one[i].material, of_all[i].material);
      EXPECT_EQ(of_one[i].cost, of_all[i].cost);
      EXPECT_EQ(of_one[i].misfit, of_all[i].misfit);
    }
  }
}

// A first stage of larger tolerance ends at other candidates' costs, but the
// optimum's is of sigma itself.
TEST_F(ReflectanceSearchTest, TolerantFirstStagesEndAtTheSameOptimum) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  ReflectanceSearchOptions options = Options();
  options.fine_iterations = 40;
  const auto find = [&](double tolerance, std::vector<double>* costs) {
    options.ranking_tolerances = {1.0, tolerance};
    options.coarse_stages[0].tolerance = tolerance;
    options.report = [&, costs](const std::string&, double cost, double) {
      costs->push_back(cost);
    };
    const StatusOr<ReflectanceSearchResult> found =
        SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                          MakeObservations(radiance_), options);
    EXPECT_TRUE(found.ok()) << found.status().message();
    return found->cost;
  };
  std::vector<double> strict, tolerant;
  const double strict_cost = find(1.0, &strict);
  EXPECT_NEAR(strict_cost, find(3.0, &tolerant), 1.0);
  EXPECT_NE(strict[1], tolerant[1]);
}

TEST_F(ReflectanceSearchTest, ModelThatExplainsNothingLeavesTheRace) {
  const BrdfGrid black = BrdfGrid::FromFunction(
      [](double, double, double) { return Eigen::Array3d::Zero().eval(); },
      resolution_.grid);
  const MaterialPrior known =
      KnownMaterial(ToEigen(TableLobes::KnownParameters()));
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  const StatusOr<std::vector<ReflectanceSearchResult>> found =
      SearchReflectances({{TableLobes::Factory(black), &known},
                          {FlowLobes::Factory(model_, 2, 1), &prior}},
                         points_, MakeObservations(radiance_), Options());
  ASSERT_TRUE(found.ok()) << found.status().message();
  ASSERT_EQ(1u, found->size());
  EXPECT_EQ(1u, found->front().model);
  EXPECT_GT(found->front().covariance.size(), 0);
}

TEST_F(ReflectanceSearchTest, StoppedSearchIsWhole) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  ReflectanceSearchOptions options = Options();
  options.should_stop = [] { return true; };
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(radiance_), options);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_EQ(14u, found->parameters.size());
  EXPECT_EQ(14, found->covariance.rows());
}

TEST_F(ReflectanceSearchTest, ImageWithoutAUsablePixelIsNamed) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  std::vector<double> bad = radiance_;
  for (size_t i = 0; i < bad.size(); i += 3) {
    bad[i] = i % 2 == 0 ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  }
  const Status status =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points_,
                        MakeObservations(bad), Options())
          .status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_EQ(0u, status.message().find("image"));
}

}  // namespace
}  // namespace ibrdf

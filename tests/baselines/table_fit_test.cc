#include "ibrdf/solvers/baselines/table_fit.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "ibrdf/brdf/bivariate.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/baselines/dsbrdf_fit.h"
#include "ibrdf/solvers/baselines/table_samples.h"
#include "tests/support/coloured_paint.h"

namespace ibrdf {
namespace {

// Where the data are the model's own, all that is left of the error is what
// the solver's tolerance leaves.
constexpr double kRecovered = 1e-4;

double LogRmse(const BrdfFunction& brdf, bool depends_on_phi_d,
               const MerlTable& table) {
  return CompareBrdfs(SampleBrdf(brdf, depends_on_phi_d, table), table)
      .value()
      .log_rmse;
}

CookTorrance Paint() {
  return testing::ColouredPaint({0.07, 0.2, 0.5}, {0.04, 0.3, 0.8});
}

Dsbrdf Lobes() {
  Dsbrdf brdf;
  const DsbrdfShape& shape = brdf.shape;
  for (int c = 0; c < 3; ++c) {
    Eigen::VectorXd& p = brdf.parameters[c];
    p.resize(shape.num_parameters());
    for (int k = 0; k < shape.coefficients; ++k) {
      const double t = k / (shape.coefficients - 1.0);
      for (int r = 0; r < shape.lobes; ++r) {
        p[shape.LogKappa(r) + k] = 1.3 * r - 2.5 + 0.6 * t * t + 0.2 * c;
        p[shape.LogGamma(r) + k] = 2.7 * r - 0.5 + 0.5 * t;
      }
    }
    p[shape.LogUnit()] = -1.0;
  }
  return brdf;
}

// Depends on phi_d; one colour is six orders of magnitude below its peak.
MerlTable Textured() {
  return SampleMerl([](double h, double d, double p) -> Eigen::Array3d {
    const double c = std::cos(p);
    return Eigen::Array3d(1.0, 0.3, 0.1) *
           (std::exp(8 - 90 * h * h) + (0.05 + d * d) * (1.2 + c * c * h));
  });
}

MerlTable Filled(double raw) {
  MerlTable table = SampleMerl(Lambertian().Function());
  for (double& value : table.raw) value = value < 0.0 ? -1.0 : raw;
  return table;
}

TEST(TableSamples, CoverTheBinsInProportion) {
  const MerlTable table = Textured();
  const auto samples = SampleBins(table, 3).value();
  EXPECT_GT(samples.size(), 2000u);
  EXPECT_LT(samples.size(), 8000u);
  double weight = 0.0, theta_h = 0.0, green = 0.0;
  for (const TableSample& s : samples) {
    weight += s.weight;
    theta_h += s.weight * s.theta_h;
    green += s.weight * s.log_raw[1];
  }
  EXPECT_NEAR(1.0, weight, 1e-12);
  double bins = 0.0, all_theta_h = 0.0, all_green = 0.0;
  for (int i = 0; i < kMerlBins; ++i) {
    if (!(table.Raw(0, i) > 0.0)) continue;
    bins += 1.0;
    all_theta_h += MerlThetaH(i / (kMerlThetaD * kMerlPhiD));
    all_green += std::log(table.Raw(1, i) + kTableLogFloor);
  }
  // Within a block theta_h varies by 0.03, log f by 0.3; the mean over some
  // thousand blocks has a hundredth of that.
  EXPECT_NEAR(all_theta_h / bins, theta_h, 2e-3);
  EXPECT_NEAR(all_green / bins, green, 0.02);
}

TEST(TableSamples, DependOnTheSeedOnly) {
  const MerlTable table = Textured();
  const auto a = SampleBins(table, 3).value(), b = SampleBins(table, 3).value(),
             c = SampleBins(table, 4).value();
  ASSERT_EQ(a.size(), b.size());
  int other = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].theta_h, b[i].theta_h);
    EXPECT_EQ(a[i].log_raw[2], b[i].log_raw[2]);
    other += a[i].phi_d != c[i].phi_d ? 1 : 0;
  }
  EXPECT_GT(other, 1000);
}

// The promise of AverageOverPhi: the same squared error but for a constant.
TEST(TableSamples, MeansOverPhiKeepTheErrorOfBivariateModels) {
  const MerlTable table = Textured();
  const auto samples = AverageOverPhi(table).value();
  const auto squares = [&](const BrdfFunction& brdf) {
    double sum = 0.0;
    for (const TableSample& s : samples) {
      const Eigen::Array3d f = brdf(s.theta_h, s.theta_d, s.phi_d);
      for (int c = 0; c < 3; ++c) {
        sum += s.weight / 3 *
               std::pow(std::log(f[c] / kMerlScale[c] + kTableLogFloor) -
                            s.log_raw[c],
                        2);
      }
    }
    return sum;
  };
  const BrdfFunction a = Lambertian().Function(), b = Lobes().Function();
  const double full_a = LogRmse(a, false, table);
  const double full_b = LogRmse(b, false, table);
  // Rounding of sums over a million bins.
  EXPECT_NEAR(full_a * full_a - full_b * full_b, squares(a) - squares(b), 1e-9);
}

TEST(TableCost, JacobianMatchesFiniteDifferences) {
  auto samples = SampleBins(Textured(), 1).value();
  // Few: every one of their derivatives is compared.
  std::vector<TableSample> few;
  for (size_t i = 0; i < samples.size(); i += 97) few.push_back(samples[i]);
  const TableCost cost(
      few, {0, 3}, kDisneyParameters,
      [&](const double* p, size_t i, int c, double* gradient) {
        DisneyLog slope;
        const double f = EvaluateDisney(
            Eigen::Map<const DisneyLog>(p),
            DisneyGeometry(few[i].theta_h, few[i].theta_d, few[i].phi_d), c,
            gradient != nullptr ? &slope : nullptr);
        if (gradient != nullptr) {
          std::copy_n(slope.data(), kDisneyParameters, gradient);
        }
        return f;
      });
  const std::vector<const ceres::Manifold*> manifolds{nullptr};
  const ceres::GradientChecker checker(&cost, &manifolds, {});
  std::mt19937 rng(42);
  std::uniform_real_distribution<double> u(-2.0, 1.0);
  for (int i = 0; i < 8; ++i) {
    DisneyLog p;
    for (int k = 0; k < kDisneyParameters; ++k) p[k] = u(rng);
    const double* blocks[] = {p.data()};
    ceres::GradientChecker::ProbeResults results;
    // Numeric differences of Ceres: about 1e-7.
    EXPECT_TRUE(checker.Probe(blocks, 1e-5, &results)) << results.error_log;
  }
}

TEST(FitLambertian, IsTheGeometricMean) {
  Lambertian truth;
  truth.albedo = {0.7, 0.2, 0.01};
  const Lambertian fit = FitLambertian(SampleMerl(truth.Function())).value();
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(1.0, fit.albedo[c] / truth.albedo[c], 1e-9);  // rounding
  }
  const MerlTable table = Textured();
  const Lambertian best = FitLambertian(table).value();
  const double least = LogRmse(best.Function(), false, table);
  for (const double factor : {0.99, 1.01}) {
    Lambertian other = best;
    other.albedo *= factor;
    EXPECT_GT(LogRmse(other.Function(), false, table), least);
  }
}

TEST(FitCookTorranceToTable, RecoversItsOwnModel) {
  const CookTorrance truth = Paint();
  const MerlTable table = SampleMerl(truth.Function());
  const CookTorrance fit = FitCookTorranceToTable(table, {}).value();
  EXPECT_LT(LogRmse(fit.Function(), true, table), kRecovered);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(truth.roughness[c], fit.roughness[c], 1e-3);
    EXPECT_NEAR(truth.diffuse[c], fit.diffuse[c], 1e-3);
  }
}

TEST(FitColouredCookTorranceToTable, RecoversItsOwnModel) {
  CookTorrance paint = Paint();
  paint.roughness.setConstant(0.2);
  paint.f0.setConstant(0.3);
  const MerlTable table = SampleMerl(paint.Function());
  const CookTorrance fit = FitColouredCookTorranceToTable(table, {}).value();
  EXPECT_LT(LogRmse(fit.Function(), true, table), kRecovered);
  EXPECT_TRUE((fit.roughness == fit.roughness[0]).all());
  EXPECT_TRUE((fit.f0 == fit.f0[0]).all());
  // On other data it is no better than with lobes of the channels' own.
  const MerlTable other = SampleMerl(Paint().Function());
  const double shared =
      LogRmse(FitColouredCookTorranceToTable(other, {}).value().Function(),
              true, other);
  EXPECT_GT(shared, 0.1);
  EXPECT_LT(LogRmse(FitCookTorranceToTable(other, {}).value().Function(), true,
                    other),
            kRecovered);
}

TEST(FitDisney, RecoversItsOwnModel) {
  Disney truth;
  truth.base = {0.6, 0.2, 0.05};
  truth.roughness = 0.4;
  truth.metallic = 0.3;
  truth.specular = 0.6;
  const MerlTable table = SampleMerl(truth.Function());
  const Disney fit = FitDisney(table, {}).value();
  EXPECT_LT(LogRmse(fit.Function(), true, table), kRecovered);
  EXPECT_NEAR(truth.roughness, fit.roughness, 1e-3);
  EXPECT_NEAR(truth.metallic, fit.metallic, 1e-2);
}

TEST(FitDsbrdf, RecoversItsOwnModel) {
  const Dsbrdf truth = Lobes();
  const MerlTable table = SampleMerl(truth.Function());
  const Dsbrdf fit = FitDsbrdf(table, {}).value();
  // Lobes trade with each other: a long valley, left at the tolerance. A
  // hundredth is a twentieth of what real tables leave.
  EXPECT_LT(LogRmse(fit.Function(), false, table), 1e-2);
}

// None is better than the bivariate mean unless it depends on phi_d, and the
// more flexible beats the less.
TEST(TableFits, AreOrderedOnATableOfNoneOfThem) {
  const MerlTable table = Textured();
  const double bivariate = LogRmse(
      FitBivariate(table, BivariateMean::kGeometric)->Function(), false, table);
  const double dsbrdf = LogRmse(FitDsbrdf(table, {})->Function(), false, table);
  const double lambertian =
      LogRmse(FitLambertian(table)->Function(), false, table);
  TableFitOptions options;
  const double first =
      LogRmse(FitCookTorranceToTable(table, options)->Function(), true, table);
  options.seed = 2;
  const double second =
      LogRmse(FitCookTorranceToTable(table, options)->Function(), true, table);
  EXPECT_LT(bivariate, dsbrdf);
  EXPECT_LT(dsbrdf, first);
  EXPECT_LT(first, lambertian);
  // Another subset of the bins is as good: its optimum is that of all but for
  // 1 / sqrt(samples).
  EXPECT_NEAR(first, second, 0.02 * first);
}

void ExpectFinite(const BrdfFunction& brdf, const MerlTable& table) {
  for (const double value : SampleBrdf(brdf, true, table).raw) {
    ASSERT_TRUE(std::isfinite(value));
  }
}

class DirtyTable : public ::testing::TestWithParam<int> {
 protected:
  static MerlTable Make(int kind) {
    switch (kind) {
      case 0:  // a floor
        return Filled(0.015);
      case 1:  // the largest raw value of MERL's chrome, everywhere
        return Filled(3.8e6);
      case 2:  // below the floor of the logarithm
        return Filled(1e-12);
      case 3: {  // green 0, blue negative
        MerlTable table = Textured();
        for (int i = 0; i < kMerlBins; ++i) {
          table.raw[static_cast<size_t>(kMerlBins) + i] = 0.0;
          table.raw[2 * static_cast<size_t>(kMerlBins) + i] = -3.0;
        }
        return table;
      }
      default: {  // a single valid bin
        MerlTable table = Filled(-1.0);
        for (int c = 0; c < 3; ++c) {
          table.raw[static_cast<size_t>(c) * kMerlBins +
                    MerlTable::Bin(5, 7, 100)] = 12.0;
        }
        return table;
      }
    }
  }
};

TEST_P(DirtyTable, GivesFiniteModels) {
  const MerlTable table = Make(GetParam());
  ExpectFinite(FitLambertian(table)->Function(), table);
  ExpectFinite(FitCookTorranceToTable(table, {})->Function(), table);
  ExpectFinite(FitColouredCookTorranceToTable(table, {})->Function(), table);
  ExpectFinite(FitDisney(table, {})->Function(), table);
  const BrdfFunction dsbrdf = FitDsbrdf(table, {})->Function();
  ExpectFinite(dsbrdf, table);
  // Constant tables are in the reach of all: 1 % is far from any real error.
  if (GetParam() < 2) {
    EXPECT_LT(LogRmse(dsbrdf, false, table), 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, DirtyTable, ::testing::Range(0, 5));

TEST(TableFits, RefuseTablesWithoutValuesAndNonFiniteOnes) {
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, -1.0);
  const std::string expected =
      "table: red: expected a bin with a positive value";
  EXPECT_EQ(expected, FitLambertian(table).status().message());
  EXPECT_EQ(expected, FitCookTorranceToTable(table, {}).status().message());
  EXPECT_EQ(expected,
            FitColouredCookTorranceToTable(table, {}).status().message());
  EXPECT_EQ(expected, FitDisney(table, {}).status().message());
  EXPECT_EQ(expected, FitDsbrdf(table, {}).status().message());
  table = Textured();
  table.raw[77] = std::numeric_limits<double>::infinity();
  EXPECT_EQ("table: bin 77: expected finite values",
            FitDisney(table, {}).status().message());
}

}  // namespace
}  // namespace ibrdf

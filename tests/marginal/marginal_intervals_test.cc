// The marginal likelihood of data of which intervals are known.
#include <gtest/gtest.h>

#include <limits>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/costs/interval_likelihood.h"
#include "tests/marginal/small_light.h"

namespace ibrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LogRadianceData Known(const std::vector<double>& y) { return {y, y, y}; }

// Values, intervals as of codes, ends that hold and ends that do not, and one
// datum of which nothing is known, in turns.
LogRadianceData Mixed(const std::vector<double>& y) {
  LogRadianceData data = Known(y);
  for (size_t i = 0; i < y.size(); ++i) {
    switch (i % 6) {
      case 1:
        data.low[i] = y[i] - 0.03;
        data.high[i] = y[i] + 0.05;
        break;
      case 2:  // clipped
        data.low[i] = y[i] - 0.12;
        data.high[i] = kInfinity;
        break;
      case 3:  // black, and not so dark
        data.low[i] = -kInfinity;
        data.high[i] = y[i] - 0.15;
        break;
      case 4:  // clipped below what light there is
        data.low[i] = y[i] - 4.0;
        data.high[i] = kInfinity;
        break;
      case 5:
        if (i > 6) break;
        data.low[i] = -kInfinity;
        data.high[i] = kInfinity;
        break;
      default:
        break;
    }
  }
  return data;
}

TEST(MarginalIntervals, GradientMatchesDifferences) {
  ExpectGradientMatches(Mixed);
}

// The integral itself, by drawing light from the prior.
TEST(MarginalIntervals, AreTheIntegralWhereLightVariesLittle) {
  const int points = 2;
  const std::array<RowMatrix, 3> T = Lobes(0.8, points);
  const LightProcess process = LittleVariance();
  const double log_amplitude = std::log(0.02), sigma = 0.15;
  const auto evidence = [&](const LogRadianceData& data) {
    const MarginalLikelihood likelihood = Likelihood(data, process);
    LightMode mode = ZeroMode(likelihood);
    const MarginalValue value = likelihood.Evaluate(
        T, Noise(sigma, points), {log_amplitude}, kTight, &mode, nullptr);
    EXPECT_TRUE(value.ok);
    return -value.cost;
  };
  const auto draws = [&](const LogRadianceData& data) {
    double sum = 0.0;
    const int count = 20000;
    for (int k = 0; k < count; ++k) {
      const std::vector<double> at =
          LogRadiance(T, DrawLight(process, 0.02, 100 + k));
      double log_p = 0.0;
      for (size_t i = 0; i < at.size(); ++i) {
        log_p -= EvaluateInterval(data.low[i], data.high[i], at[i], sigma).cost;
      }
      sum += std::exp(log_p) / count;
    }
    return std::log(sum);
  };
  LogRadianceData data = Known(LogRadiance(T, DrawLight(process, 0.02, 5)));
  for (size_t i = 0; i < data.value.size(); ++i) {
    data.low[i] -= 0.1;
    data.high[i] += 0.15;
  }
  EXPECT_NEAR(draws(data), evidence(data), 0.1);
  // One end holds, one does not.
  data.high[0] = kInfinity;
  data.low[1] = -kInfinity;
  data.high[1] = data.value[1] - 0.2;
  EXPECT_NEAR(draws(data), evidence(data), 0.1);
}

TEST(MarginalIntervals, OfNoWidthAreValues) {
  const std::array<RowMatrix, 3> T = Lobes(0.4);
  const std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 4));
  MarginalGradient exact, equal, narrow;
  const double cost = Cost({y, {}, {}}, T, Rough(), &exact);
  EXPECT_NEAR(cost, Cost(Known(y), T, Rough(), &equal), 1e-10);
  LogRadianceData data = Known(y);
  constexpr double kWidth = 1e-4;
  for (size_t i = 0; i < y.size(); ++i) {
    data.low[i] -= 0.5 * kWidth;
    data.high[i] += 0.5 * kWidth;
  }
  // A density times the width is a probability; the constants of the normal
  // density are not in the cost of values.
  const double constant = static_cast<double>(y.size()) *
                          (0.5 * std::log(2.0 * kPi) - std::log(kWidth));
  EXPECT_NEAR(cost + constant, Cost(data, T, Rough(), &narrow), 1e-5);
  for (int c = 0; c < 3; ++c) {
    const double size = exact.matrices[c].norm();
    EXPECT_LT((exact.matrices[c] - equal.matrices[c]).norm(), 1e-9 * size);
    EXPECT_LT((exact.matrices[c] - narrow.matrices[c]).norm(), 1e-4 * size);
  }
}

TEST(MarginalIntervals, WithoutEndsSayNothing) {
  const std::array<RowMatrix, 3> T = Lobes(0.4);
  const std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 4));
  LogRadianceData all = Known(y), fewer;
  std::array<RowMatrix, 3> T_fewer;
  for (int c = 0; c < 3; ++c) {
    const int missing = c * kPoints + kPoints - 1;
    all.low[missing] = -kInfinity;
    all.high[missing] = kInfinity;
    T_fewer[c] = T[c].topRows(kPoints - 1);
    const auto first = y.begin() + c * kPoints;
    fewer.value.insert(fewer.value.end(), first, first + kPoints - 1);
  }
  const MarginalLikelihood with = Likelihood(all, Proper());
  const MarginalLikelihood without = Likelihood(fewer, Proper());
  LightMode a, b;
  a.l = a.representers = Eigen::VectorXd::Zero(3 * kTexels);
  b = a;
  MarginalGradient with_gradient, without_gradient;
  const MarginalValue one =
      with.Evaluate(T, Noise(0.1), Rough(), kTight, &a, &with_gradient);
  const MarginalValue two = without.Evaluate(
      T_fewer, Noise(0.1, kPoints - 1), Rough(), kTight, &b, &without_gradient);
  EXPECT_NEAR(two.cost, one.cost, 1e-9);
  EXPECT_NEAR(two.misfit, one.misfit, 1e-9);
  for (int k = 0; k < LightHyperparameters::kCount; ++k) {
    EXPECT_NEAR(without_gradient.hyperparameters[k],
                with_gradient.hyperparameters[k], 1e-7);
  }
  EXPECT_LT(
      (with.LightVariance(T, Noise(0.1), Rough(), a) -
       without.LightVariance(T_fewer, Noise(0.1, kPoints - 1), Rough(), b))
          .cwiseAbs()
          .maxCoeff(),
      1e-7);
  const RowMatrix G = RowMatrix::Random(3 * kPoints, 3);
  RowMatrix G_fewer(3 * (kPoints - 1), 3);
  for (int c = 0; c < 3; ++c) {
    G_fewer.middleRows(c * (kPoints - 1), kPoints - 1) =
        G.middleRows(c * kPoints, kPoints - 1);
  }
  const Eigen::MatrixXd information =
      with.Information(T, Noise(0.1), Rough(), a, G);
  EXPECT_LT((information - without.Information(T_fewer, Noise(0.1, kPoints - 1),
                                               Rough(), b, G_fewer))
                .norm(),
            1e-6 * information.norm());
}

// Clipped highlights bound the light from below: it is brighter than where
// their pixels are left out, and than where they are taken at their word.
TEST(MarginalIntervals, AClippedHighlightMayBeBrighter) {
  const std::array<RowMatrix, 3> T = Lobes(0.3);
  std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 4));
  for (int c = 0; c < 3; ++c) y[c * kPoints] += 2.0;  // the highlight
  LogRadianceData clipped = Known(y);
  std::vector<double> cut = y;
  for (int c = 0; c < 3; ++c) {
    clipped.low[c * kPoints] = cut[c * kPoints] = y[c * kPoints] - 1.0;
    clipped.high[c * kPoints] = kInfinity;
  }
  const auto brightest = [&](const LogRadianceData& data) {
    LightMode mode;
    EXPECT_TRUE(Likelihood(data, Proper())
                    .Evaluate(T, Noise(0.05), {}, 1e-9, &mode, nullptr)
                    .ok);
    return (mode.l.array() + mode.level).maxCoeff();
  };
  EXPECT_GT(brightest(clipped), brightest({cut, {}, {}}));
  EXPECT_LT(brightest(clipped), brightest({y, {}, {}}));
}

TEST(MarginalIntervals, ExtremesAreFiniteOrRefused) {
  const std::array<RowMatrix, 3> T = Lobes(0.3);
  const std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 3));
  for (const double shift : {0.0, 14.0, -60.0, 300.0}) {
    for (const int kind : {0, 1, 2, 3}) {
      LogRadianceData data = Known(y);
      for (size_t i = 0; i < y.size(); ++i) {
        if (kind == 3 && i > 0) break;
        data.low[i] = kind == 1 ? -kInfinity : y[i] + shift;
        data.high[i] = kind == 0 ? kInfinity : y[i] + shift + 1e-13;
      }
      LightMode mode;
      MarginalGradient gradient;
      const MarginalValue value =
          Likelihood(data, LightProcess())
              .Evaluate(T, Noise(0.03), {}, 1e-3, &mode, &gradient);
      if (!value.ok) continue;
      EXPECT_TRUE(std::isfinite(value.cost)) << shift << " " << kind;
      EXPECT_TRUE(std::isfinite(value.misfit));
      for (const RowMatrix& m : gradient.matrices) EXPECT_TRUE(m.allFinite());
    }
  }
}

}  // namespace
}  // namespace ibrdf

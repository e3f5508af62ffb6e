// Holds derivatives to the errors that experiments/validation/derivatives
// measured: the same comparisons with long double at fewer points.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/solvers/problem/open_model.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

// Rounding of float through networks, tables and sums of some hundred terms.
// Each bound is several times the worst of the study's thousands of points.
constexpr double kNetwork = 5e-5;    // by code, by weights, of ordinary flows
constexpr double kByPoint = 1e-3;    // slopes of the default model's splines
constexpr double kSums = 5e-6;       // the transport
constexpr double kDouble = 1e-11;    // formulas in double
constexpr double kObjective = 1e-4;  // gradients of whole costs
// The bound of rows that show what cannot be held: their entries must be finite
// alone.
constexpr double kNotHeld = std::numeric_limits<double>::max();

// Every row of the table within `most`, but for rows whose name contains a word
// of `others`, which have their own bounds.
void ExpectWithin(
    const ErrorTable& table, double most,
    const std::vector<std::pair<std::string, double>>& others = {}) {
  ASSERT_FALSE(table.Rows().empty());
  for (const ErrorRow& row : table.Rows()) {
    const std::string name = row.derivative + ", " + row.points;
    double bound = most;
    for (const auto& [word, its] : others) {
      if (name.find(word) != std::string::npos) bound = its;
    }
    EXPECT_LE(row.worst, bound) << name << " at " << row.worst_point;
    EXPECT_EQ(0, row.not_finite) << name;
  }
}

StudyOptions Few(int points) {
  StudyOptions options;
  options.points = points;
  return options;
}

TEST(ErrorTable, CountsWhatIsWrong) {
  ErrorTable table;
  table.Add("d", "here", "a", {1.0, 0.0}, {1.0L, 0.0L});
  table.Add("d", "here", "b", {3.0, 4.4}, {3.0L, 4.0L});
  table.Add("d", "here", "c", {0.0, 0.25}, {0.0L, 0.0L});
  const ErrorRow row = table.Row("d", "here");
  EXPECT_EQ(3, row.count);
  EXPECT_NEAR(0.08, row.median, 1e-12);
  EXPECT_NEAR(0.25, row.worst, 1e-12);
  EXPECT_EQ("c", row.worst_point);
  EXPECT_NEAR(0.1, row.worst_entry, 1e-12);
  EXPECT_EQ(0, row.not_finite);
  table.Add("d", "there", "d", {std::nan(""), 1.0}, {1.0L, 1.0L});
  EXPECT_EQ(1, table.Row("d", "there").not_finite);
  EXPECT_TRUE(std::isinf(table.Row("d", "there").worst));
}

TEST(Derivatives, FlowsByCodePointAndWeights) {
  const StatusOr<OpenedModel> opened = OpenModel("default");
  ASSERT_TRUE(opened.ok()) << opened.status().message();
  ErrorTable table;
  StudyFlows(opened->model, Few(8), &table);
  // At a knot a derivative has two sides, and which one float takes is open.
  ExpectWithin(
      table, kNetwork,
      {{"by point", kByPoint}, {"steep", 2e-2}, {"right side", kNotHeld}});
}

TEST(Derivatives, LobesByCodesAndColours) {
  const NeuralBrdfModel model = TinyModel(3);
  ErrorTable table;
  StudyLobes(model, Few(10), &table);
  ExpectWithin(table, kObjective, {{"steep", 2e-2}, {"exponent", 1e-3}});
}

TEST(Derivatives, RadianceByLightAndReflectance) {
  ErrorTable table;
  StudyTransport(Few(100), &table);
  ExpectWithin(table, kSums);
}

TEST(Derivatives, RadianceInHarmonics) {
  ErrorTable table;
  StudyHarmonics(Few(80), &table);
  ExpectWithin(table, kSums);
}

TEST(Derivatives, RadianceInGaussians) {
  ErrorTable table;
  StudyGaussians(Few(80), &table);
  ExpectWithin(table, kSums);
}

TEST(Derivatives, MapByNetworkWeights) {
  ErrorTable table;
  StudyUnet(Few(20), &table);
  ExpectWithin(table, kNetwork);
}

TEST(Derivatives, LikelihoodAndPriors) {
  ErrorTable table;
  StudyCosts(Few(20), &table);
  // On the unit sphere the wall's row jumps; its gradient does not. What
  // epsilon or the observation hides cancels in a logarithm.
  ExpectWithin(table, kDouble,
               {{"prior, codes of norm 1", kNotHeld},
                {"prior, gradient, codes of norm 1", kDouble},
                {"cost by radiance, 1e-30", kNotHeld},
                {"cost by radiance, E = I", 1e-5},
                {"process prior", 1e-6}});
}

TEST(Derivatives, Baselines) {
  ErrorTable table;
  StudyBaselines(Few(40), &table);
  ExpectWithin(table, kDouble,
               {{"log table cost", kNetwork}, {"Torrance cost", kNetwork}});
}

TEST(Derivatives, JointObjective) {
  ErrorTable table;
  StudyJoint(TinyModel(3), Few(20), &table);
  ExpectWithin(table, kObjective);
}

TEST(Derivatives, MarginalObjective) {
  ErrorTable table;
  StudyMarginal(TinyModel(3), Few(10), &table);
  // The objective's mode is found to a millionth of a nat.
  ExpectWithin(table, kObjective, {{"objective", 1e-3}});
}

}  // namespace
}  // namespace derivatives
}  // namespace ibrdf

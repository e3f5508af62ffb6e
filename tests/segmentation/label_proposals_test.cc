#include "ibrdf/solvers/segmentation/label_proposals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "ibrdf/solvers/segmentation/label_overlap.h"
#include "labelled_ball.h"

namespace ibrdf {
namespace {

std::vector<LabelProposal> Propose(const LabelledBall& ball, int most = 3) {
  LabelProposalOptions options;
  options.most_materials = most;
  options.num_threads = 2;
  return ProposeLabels(ball.points, ball.Observed(), ball.width, options);
}

// The best agreement of the proposals of as many materials as the truth.
double BestAgreement(const LabelledBall& ball, int count,
                     const std::vector<LabelProposal>& proposals) {
  double best = 0.0;
  for (const LabelProposal& p : proposals) {
    if (p.count != count) continue;
    best = std::max(best, Agreement({p.labels, p.count}, {ball.labels, count}));
  }
  return best;
}

int TwoInPatches(int x, int y) { return (x / 16 + y / 16) % 2; }

TEST(ProposeLabels, FindsTwoMaterialsInPatches) {
  const LabelledBall ball = MakeLabelledBall(64, 0.02, TwoInPatches);
  const std::vector<LabelProposal> proposals = Propose(ball);
  ASSERT_FALSE(proposals.empty());
  EXPECT_EQ(2, proposals.front().count);
  EXPECT_GT(BestAgreement(ball, 2, proposals), 0.97);
}

TEST(ProposeLabels, FindsThreeMaterialsInStripes) {
  const LabelledBall ball =
      MakeLabelledBall(64, 0.02, [](int x, int) { return x * 3 / 64; });
  EXPECT_GT(BestAgreement(ball, 3, Propose(ball)), 0.97);
}

TEST(ProposeLabels, AreInOrderAndDiffer) {
  const LabelledBall ball = MakeLabelledBall(64, 0.02, TwoInPatches);
  const std::vector<LabelProposal> proposals = Propose(ball, 5);
  for (size_t k = 0; k < proposals.size(); ++k) {
    const LabelProposal& p = proposals[k];
    ASSERT_EQ(ball.points.size(), p.labels.size());
    std::vector<int> points(p.count, 0);
    for (const int label : p.labels) ++points.at(label);
    EXPECT_TRUE(std::is_sorted(points.rbegin(), points.rend()));
    EXPECT_GT(points.back(), 0);
    for (size_t j = 0; j < k; ++j) {
      const LabelProposal& q = proposals[j];
      EXPECT_LE(q.count, p.count);
      EXPECT_TRUE(q.count < p.count || q.energy <= p.energy);
      EXPECT_LT(Agreement({p.labels, p.count}, {q.labels, q.count}), 0.99);
    }
  }
}

// A single material has no step that is its own.
TEST(ProposeLabels, AreNoneWhereNothingPartsTheObject) {
  const LabelledBall ball =
      MakeLabelledBall(48, 0.002, [](int, int) { return 0; });
  EXPECT_TRUE(Propose(ball).empty());
}

TEST(ProposeLabels, AreNoneWhereNoPixelCanBeUsed) {
  LabelledBall ball = MakeLabelledBall(16, 0.0, [](int, int) { return 0; });
  std::fill(ball.radiance.begin(), ball.radiance.end(), 0.0);
  EXPECT_TRUE(Propose(ball).empty());
}

// As bits, for any number of threads.
TEST(ProposeLabels, DoNotDependOnTheThreads) {
  const LabelledBall ball = MakeLabelledBall(48, 0.02, TwoInPatches);
  LabelProposalOptions options;
  options.num_threads = 1;
  const std::vector<LabelProposal> one =
      ProposeLabels(ball.points, ball.Observed(), ball.width, options);
  options.num_threads = 3;
  const std::vector<LabelProposal> three =
      ProposeLabels(ball.points, ball.Observed(), ball.width, options);
  ASSERT_EQ(one.size(), three.size());
  for (size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].labels, three[k].labels);
    EXPECT_EQ(one[k].energy, three[k].energy);
  }
}

// More pixels than are looked at at once, and a scale of exposure.
TEST(ProposeLabels, SeesLargeAndDarkImagesAsWell) {
  LabelledBall ball = MakeLabelledBall(
      200, 0.02, [](int x, int y) { return (x / 50 + y / 50) % 2; });
  for (double& v : ball.radiance) v *= 1e-6;
  EXPECT_GT(BestAgreement(ball, 2, Propose(ball, 2)), 0.97);
}

// Pixels without a value have their neighbours' label.
TEST(ProposeLabels, FillsHoles) {
  LabelledBall ball = MakeLabelledBall(64, 0.02, TwoInPatches);
  for (size_t i = 0; i < ball.points.size(); i += 7) {
    ball.radiance[3 * i] = std::nan("");
  }
  EXPECT_GT(BestAgreement(ball, 2, Propose(ball, 2)), 0.96);
}

}  // namespace
}  // namespace ibrdf

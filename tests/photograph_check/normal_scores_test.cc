#include "ibrdf/solvers/photograph_check/normal_scores.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "tests/photograph_check/surfaces.h"

namespace ibrdf {
namespace {
using Hypothesis = NormalHypothesis;

Image Encoded(const Image& normals) {
  Image out = normals;
  for (size_t i = 0; i < out.num_pixels(); ++i) {
    Eigen::Map<Eigen::Vector3f> n(&out.rgb[3 * i]);
    if (!n.isZero()) n = (n.array() + 1.0f).matrix().normalized();
  }
  return out;
}

Image Decoded(const Image& normals) {
  Image out = normals;
  for (size_t i = 0; i < out.num_pixels(); ++i) {
    Eigen::Map<Eigen::Vector3f> n(&out.rgb[3 * i]);
    if (!n.isZero()) n = (2.0f * n.array() - 1.0f).matrix().normalized();
  }
  return out;
}

TEST(NormalHypotheses, FlipsAndSwapsAreTheirOwnInverses) {
  const Image sphere = SphereNormals(24);
  for (const Hypothesis h :
       {Hypothesis::kAsGiven, Hypothesis::kXFlipped, Hypothesis::kYFlipped,
        Hypothesis::kBothFlipped, Hypothesis::kSwapped, Hypothesis::kOpenCv}) {
    EXPECT_EQ(sphere.rgb, UnderHypothesis(UnderHypothesis(sphere, h), h).rgb)
        << NameOf(h);
  }
}

TEST(NormalHypotheses, EncodingsAreUndoneFromDirectionsAlone) {
  const Image sphere = SphereNormals(48);
  const Image from_float =
      UnderHypothesis(Decoded(sphere), Hypothesis::kWasFloat);
  const Image from_encoded =
      UnderHypothesis(Encoded(sphere), Hypothesis::kWasEncoded);
  for (size_t i = 0; i < sphere.num_pixels(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> n(&sphere.rgb[3 * i]);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(n[c], from_float.rgb[3 * i + c], 1e-4);
    }
    // Beyond it lies the mirror image, and near it square roots of rounding.
    if (n.sum() < -0.9f) continue;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(n[c], from_encoded.rgb[3 * i + c], 1e-4);
    }
  }
}

TEST(NormalScores, ASphereAgreesWithItself) {
  const NormalScore score = ScoreNormals(SphereNormals(128), Mask());
  EXPECT_EQ(0.0, score.away);
  EXPECT_LT(score.outline, 0.03);
  EXPECT_LT(score.curl, 0.01);
}

TEST(NormalScores, WhatWasDoneToASphereIsFound) {
  const Image sphere = SphereNormals(128);
  const auto first = [](const Image& normals) {
    return RankNormalHypotheses(normals, Mask()).front().hypothesis;
  };
  EXPECT_EQ(Hypothesis::kAsGiven, first(sphere));
  for (const Hypothesis h :
       {Hypothesis::kXFlipped, Hypothesis::kYFlipped, Hypothesis::kBothFlipped,
        Hypothesis::kSwapped, Hypothesis::kOpenCv}) {
    EXPECT_EQ(h, first(UnderHypothesis(sphere, h))) << NameOf(h);
  }
  EXPECT_EQ(Hypothesis::kWasEncoded, first(Encoded(sphere)));
  EXPECT_EQ(Hypothesis::kWasFloat, first(Decoded(sphere)));
}

TEST(NormalScores, CurlTellsAFlipWhereThereIsNoOutline) {
  const Image bumps = SurfaceNormals(
      96, [](double u, double v) { return Bumps(u + 0.3 * v, v); });
  const std::vector<NormalScore> ranking = RankNormalHypotheses(bumps, Mask());
  double given = 0.0, both = 0.0, y = 0.0;
  for (const NormalScore& score : ranking) {
    EXPECT_TRUE(std::isnan(score.outline));
    if (score.hypothesis == Hypothesis::kAsGiven) given = score.disagreement;
    if (score.hypothesis == Hypothesis::kBothFlipped) both = score.disagreement;
    if (score.hypothesis == Hypothesis::kYFlipped) y = score.disagreement;
  }
  // Bumps and dents are the same without an outline, one flip is not.
  EXPECT_NEAR(given, both, 1e-6);
  EXPECT_LT(given, 0.05);
  EXPECT_GT(y, given + 0.3);
}

TEST(NormalScores, AMaskCutsTheOutline) {
  // Half of the sphere: its straight edge is no silhouette, the round one is.
  const Image sphere = SphereNormals(128);
  Mask mask(128, 128, 1);
  for (int y = 0; y < 128; ++y) {
    for (int x = 64; x < 128; ++x) mask.inside[y * 128 + x] = 0;
  }
  EXPECT_EQ(Hypothesis::kAsGiven,
            RankNormalHypotheses(sphere, mask).front().hypothesis);
}

TEST(NormalScores, FlatAndTinyMapsSayNothing) {
  Image flat(40, 40);
  for (size_t i = 0; i < flat.num_pixels(); ++i) flat.rgb[3 * i + 2] = 1.0f;
  EXPECT_TRUE(std::isnan(ScoreNormals(flat, Mask()).curl));
  EXPECT_TRUE(std::isnan(ScoreNormals(flat, Mask()).outline));
  Image one(1, 1);
  one.rgb = {0, 0, 1};
  EXPECT_EQ(0.0, ScoreNormals(one, Mask()).disagreement);
}

}  // namespace
}  // namespace ibrdf

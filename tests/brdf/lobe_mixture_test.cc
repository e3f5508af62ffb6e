#include "ibrdf/brdf/lobe_mixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {
namespace {

constexpr LobeLayout kLayout = {2, 4};

class LobeMixtureTest : public ::testing::Test {
 protected:
  std::vector<double> parameters_ = {0.3, -0.4, 0.2, 0.1,  4.0, 4.3, 3.8,
                                     0.5, 0.1,  0.3, -0.2, 3.0, 2.5, 3.3};
  const LobeMixture lobes_{kLayout, parameters_.data()};
  const MutableLobeMixture mutable_{kLayout, parameters_.data()};
};

TEST_F(LobeMixtureTest, ViewsAreThePartsOfTheLayout) {
  EXPECT_EQ(7, kLayout.lobe_size());
  EXPECT_EQ(14, kLayout.num_parameters());
  EXPECT_EQ(2, LobeLayout::OfSize(14, 4).num_lobes);
  EXPECT_EQ(0, LobeLayout::OfSize(0, 4).num_lobes);
  EXPECT_EQ(Eigen::VectorXd(lobes_.code(1)),
            (Eigen::Vector4d(0.5, 0.1, 0.3, -0.2)));
  EXPECT_TRUE((lobes_.log_colour(0) == Eigen::Array3d(4.0, 4.3, 3.8)).all());
  // What is written through one view is read through all, in its own place.
  mutable_.log_colour(1)[2] = -7.0;
  mutable_.code(0)[1] = 9.0;
  EXPECT_EQ(-7.0, parameters_[13]);
  EXPECT_EQ(-7.0, lobes_.lobe(1)[6]);
  EXPECT_EQ(9.0, parameters_[1]);
  EXPECT_EQ(9.0, lobes_.code(0)[1]);
}

TEST_F(LobeMixtureTest, LobesWithoutCodesAreColours) {
  const double a[6] = {1, 2, 3, 4, 5, 6};
  const LobeMixture lobes({2, 0}, a);
  EXPECT_EQ(0, lobes.code(1).size());
  EXPECT_EQ(5.0, lobes.log_colour(1)[1]);
}

TEST_F(LobeMixtureTest, LambertianLobeIsLastAndHasColoursAlone) {
  const LobeLayout layout = kLayout.WithLambertian();
  EXPECT_EQ(3, layout.num_lobes);
  EXPECT_EQ(2, layout.num_coded());
  EXPECT_EQ(17, layout.num_parameters());
  EXPECT_EQ(layout, layout.WithLambertian());
  EXPECT_EQ(layout, LobeLayout::OfSize(17, 4));
  EXPECT_EQ(kLayout, LobeLayout::OfSize(14, 4));
  // Alone, and where no lobe has numbers in its code.
  EXPECT_EQ((LobeLayout{1, 4, true}), LobeLayout::OfSize(3, 4));
  EXPECT_EQ((LobeLayout{3, 0}), LobeLayout::OfSize(9, 0));
  std::vector<double> x = parameters_;
  x.insert(x.end(), {-1.0, -2.0, -3.0});
  const MutableLobeMixture lobes(layout, x.data());
  EXPECT_EQ(0, lobes.code(2).size());
  EXPECT_EQ(3, lobes.lobe(2).size());
  EXPECT_EQ(7, lobes.lobe(1).size());
  EXPECT_EQ(-2.0, lobes.log_colour(2)[1]);
  EXPECT_EQ(std::exp(-3.0), lobes.RawColours()(2, 2));
  lobes.ShiftColours({1.0, 2.0, 4.0});
  EXPECT_EQ(1.0, x[16]);
  // The others are where they were.
  EXPECT_EQ(Eigen::VectorXd(lobes.code(1)), Eigen::VectorXd(lobes_.code(1)));
  lobes.code(1) *= 50.0;
  lobes.ClampCodes();
  EXPECT_NEAR(1.0, lobes.code(1).norm(), 1e-15);
  EXPECT_EQ(1.0, x[16]);
}

// Black to the last bit, however dark.
TEST_F(LobeMixtureTest, DarkestColoursAreZeroWithoutSlope) {
  for (const double a : {-800.0, -1e300}) {
    mutable_.log_colour(1).setConstant(a);
    EXPECT_TRUE((lobes_.Colours().col(1) == 0.0).all());
    EXPECT_TRUE((lobes_.ColourSlopes().col(1) == 0.0).all());
  }
}

TEST_F(LobeMixtureTest, ColoursAreExponentialsInTheChannelsScale) {
  const Eigen::Array3Xd colours = lobes_.Colours(), raw = lobes_.RawColours();
  for (int k = 0; k < 2; ++k) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(std::exp(lobes_.log_colour(k)[c]), raw(c, k));
      EXPECT_EQ(raw(c, k) * kMerlScale[c], colours(c, k));
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_EQ(kMerlScale[c], LobeColour(0.0, c));
}

TEST_F(LobeMixtureTest, ColoursBeyondTheLargestAreClamped) {
  for (const double a : {kMaxLogColour, kMaxLogColour + 1e-9, 1e3, 1e300}) {
    mutable_.log_colour(0).setConstant(a);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(std::exp(kMaxLogColour), lobes_.RawColours()(c, 0)) << a;
      EXPECT_EQ(0.0, lobes_.ColourSlopes()(c, 0)) << a;
    }
    // Those of the other lobe are as they were.
    EXPECT_EQ(lobes_.Colours()(1, 1), lobes_.ColourSlopes()(1, 1));
  }
}

// Below the clamp, just below, above it and dark. exp(a) rounds to 1e-16 of
// itself, over 2 h; the third derivative's share is h^2 / 6.
TEST_F(LobeMixtureTest, SlopesMatchDifferences) {
  constexpr double kStep = 1e-5, kTolerance = 1e-9;
  for (const double a : {-30.0, 0.0, 7.5, kMaxLogColour - 2 * kStep,
                         kMaxLogColour + 2 * kStep, 90.0}) {
    for (int c = 0; c < 3; ++c) {
      mutable_.log_colour(1)[c] = a;
      const double slope = lobes_.ColourSlopes()(c, 1);
      const double numeric =
          (LobeColour(a + kStep, c) - LobeColour(a - kStep, c)) / (2 * kStep);
      EXPECT_NEAR(numeric, slope, kTolerance * LobeColour(a, c)) << a;
    }
  }
}

TEST_F(LobeMixtureTest, ShiftMovesTheColoursOfAllLobesAlone) {
  const std::vector<double> before = parameters_;
  const Eigen::Array3d shift(0.5, -2.0, 7.25);
  mutable_.ShiftColours(shift);
  for (int i = 0; i < 14; ++i) {
    const int in_lobe = i % 7;
    const double moved = in_lobe < 4 ? 0.0 : shift[in_lobe - 4];
    EXPECT_EQ(before[i] + moved, parameters_[i]);
  }
  mutable_.ShiftColours(-shift);
  for (int i = 0; i < 14; ++i) {
    EXPECT_NEAR(before[i], parameters_[i], 1e-14);  // two roundings
  }
}

TEST_F(LobeMixtureTest, ClampedCodesAreInTheBallAndPointTheSameWay) {
  const std::vector<double> before = parameters_;
  mutable_.ClampCodes();
  EXPECT_EQ(before, parameters_);  // inside already
  mutable_.code(1) *= 50.0;
  const Eigen::VectorXd outside = lobes_.code(1);
  mutable_.ClampCodes();
  EXPECT_NEAR(1.0, lobes_.code(1).norm(), 1e-15);
  EXPECT_NEAR(1.0, lobes_.code(1).dot(outside) / outside.norm(), 1e-15);
  for (const int i : {0, 1, 2, 3, 4, 5, 6, 11, 12, 13}) {
    EXPECT_EQ(before[i], parameters_[i]);
  }
}

}  // namespace
}  // namespace ibrdf

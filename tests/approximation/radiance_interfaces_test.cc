// What every LinearTransport and every RadianceRenderer promises.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/approximation/gaussian_operator.h"
#include "ibrdf/approximation/gaussian_radiance.h"
#include "ibrdf/approximation/harmonic_radiance.h"
#include "ibrdf/render/reference_radiance.h"
#include "ibrdf/transport/transport.h"
#include "tests/approximation/all_points.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kHeight = 16, kWidth = 32;
constexpr BrdfGridShape kGrid = {24, 12, 8};

// The transports of one scene.
class LinearTransports : public ::testing::Test {
 protected:
  LinearTransports() {
    TransportOptions options;
    options.grid = kGrid;
    options.bright = {{Eigen::Vector3d(0.3, 0.5, 0.8).normalized(),
                       Eigen::Array3d(2.0, 1.0, 0.5)}};
    HarmonicOptions harmonic_options;
    harmonic_options.grid = kGrid;
    harmonics_ = std::make_unique<HarmonicTransport>(points_, kHeight, kWidth,
                                                     harmonic_options);
    gaussians_ =
        std::make_unique<GaussianTransport>(light_.lobes(), GaussianOptions());
    stored_ = std::make_unique<LightOperator>(
        Transport(points_, kHeight, kWidth, options).ByLight(grid_));
    by_harmonics_ =
        std::make_unique<HarmonicOperator>(harmonics_->ByLight(grid_));
    by_gaussians_ =
        std::make_unique<GaussianOperator>(light_, *gaussians_, points_, brdf_);
  }

  const std::vector<ShadingPoint> points_ = AllPoints();
  const BrdfFunction brdf_ = Glossy(0.2, 0.4, 20);
  const BrdfGrid grid_ = BrdfGrid::FromFunction(brdf_, kGrid);
  const Image map_ = RandomMap(kHeight, kWidth, 3);
  const GaussianLight light_{map_};
  std::unique_ptr<const HarmonicTransport> harmonics_;
  std::unique_ptr<const GaussianTransport> gaussians_;
  std::unique_ptr<const LinearTransport> stored_, by_harmonics_, by_gaussians_;
};

TEST_F(LinearTransports, AreAffineInTheMapAndTheTransposeIsTheirs) {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  const Image other = RandomMap(kHeight, kWidth, 5);
  Image mixed(kWidth, kHeight);
  for (size_t k = 0; k < mixed.rgb.size(); ++k) {
    mixed.rgb[k] = 2.0f * map_.rgb[k] - 0.5f * other.rgb[k];
  }
  for (const LinearTransport* transport :
       {stored_.get(), by_harmonics_.get(), by_gaussians_.get()}) {
    ASSERT_EQ(static_cast<int>(points_.size()), transport->num_points());
    const size_t size = 3 * points_.size();
    std::vector<double> L_o(size), a(size), b(size), both(size), adjoint(size);
    transport->Apply(map_.rgb.data(), L_o.data());
    transport->ApplyLinear(map_.rgb.data(), a.data());
    transport->ApplyLinear(other.rgb.data(), b.data());
    transport->ApplyLinear(mixed.rgb.data(), both.data());
    const bool has_offset = !transport->offset().empty();
    EXPECT_EQ(transport == stored_.get(), has_offset);
    double sum = 0.0, magnitude = 0.0;
    for (size_t k = 0; k < size; ++k) {
      EXPECT_EQ(a[k] + (has_offset ? transport->offset()[k] : 0.0), L_o[k]);
      EXPECT_NEAR(2.0 * a[k] - 0.5 * b[k], both[k],
                  2e-6 * (std::abs(a[k]) + std::abs(b[k])) + 1e-6);
      adjoint[k] = normal(rng);
      sum += adjoint[k] * a[k];
      magnitude += std::abs(adjoint[k] * a[k]);
    }
    std::vector<float> gradient(map_.rgb.size());
    transport->ApplyTranspose(adjoint.data(), gradient.data());
    double by_map = 0.0;
    for (size_t k = 0; k < gradient.size(); ++k) {
      by_map += double{gradient[k]} * map_.rgb[k];
    }
    // Sums of float products.
    EXPECT_NEAR(sum, by_map, 5e-6 * magnitude);
  }
}

TEST_F(LinearTransports, AreThoseOfTheirRenderers) {
  std::vector<double> operated(3 * points_.size()), rendered(operated.size());
  by_harmonics_->Apply(map_.rgb.data(), operated.data());
  harmonics_->Render(grid_, map_.rgb.data(), rendered.data());
  EXPECT_EQ(rendered, operated);
  by_gaussians_->Apply(map_.rgb.data(), operated.data());
  gaussians_->Render(points_, gaussians_->Tabulate(brdf_),
                     light_.Fit(map_.rgb.data()), rendered.data());
  EXPECT_EQ(rendered, operated);
}

TEST_F(LinearTransports, RenderersClipWhatIsBelowZeroAndMayBeStopped) {
  HarmonicOptions harmonic_options;
  harmonic_options.grid = kGrid;
  const HarmonicRadiance by_harmonics(map_, grid_, harmonic_options);
  const GaussianRadiance by_gaussians(map_, brdf_, {}, {});
  const ReferenceRenderer renderer(map_, Coarser({}));
  const ReferenceRadiance reference(renderer, brdf_);
  std::vector<double> harmonic(3 * points_.size()), gaussian(harmonic.size()),
      slow(harmonic.size()), L_o(harmonic.size());
  by_harmonics_->Apply(map_.rgb.data(), harmonic.data());
  by_gaussians_->Apply(map_.rgb.data(), gaussian.data());
  renderer.Render(points_, brdf_, slow.data());
  for (auto& [radiance, expected] :
       {std::pair<const RadianceRenderer*, std::vector<double>*>{&by_harmonics,
                                                                 &harmonic},
        {&by_gaussians, &gaussian},
        {&reference, &slow}}) {
    for (double& v : *expected) v = std::max(v, 0.0);
    ASSERT_TRUE(radiance->Render(points_, {}, L_o.data()));
    EXPECT_EQ(*expected, L_o);
    std::vector<double> shares;
    EXPECT_TRUE(radiance->Render(
        points_,
        [&shares](double share) {
          shares.push_back(share);
          return true;
        },
        L_o.data()));
    ASSERT_FALSE(shares.empty());
    EXPECT_EQ(0.0, shares[0]);
    EXPECT_FALSE(radiance->Render(
        points_, [](double) { return false; }, L_o.data()));
  }
}

// Steps of a large image are those of the whole.
TEST(ReferenceRadiance, RendersInStepsThatMayBeStopped) {
  ReferenceOptions options;
  options.near_rings = 8;
  options.near_ring_samples = 24;
  options.far_width = 16;
  const ReferenceRenderer renderer(SmoothMap(8, 16), options);
  const ReferenceRadiance radiance(renderer, Lambertian(0.5));
  const std::vector<ShadingPoint> points = SpherePoints(80);
  ASSERT_GT(points.size(), 4096u);
  std::vector<double> L_o(3 * points.size()), whole(L_o.size());
  renderer.Render(points, Lambertian(0.5), whole.data());
  std::vector<double> shares;
  const auto keep = [&shares](double share) {
    shares.push_back(share);
    return shares.size() < 3;
  };
  EXPECT_FALSE(radiance.Render(points, keep, L_o.data()));
  ASSERT_EQ(3u, shares.size());
  EXPECT_EQ(0.0, shares[0]);
  EXPECT_LT(shares[1], shares[2]);
  EXPECT_LT(shares[2], 1.0);
  ASSERT_TRUE(radiance.Render(points, {}, L_o.data()));
  EXPECT_EQ(whole, L_o);
}

}  // namespace
}  // namespace ibrdf

#include "ibrdf/render/reference_batch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/render/reference_renderer.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Samples a BRDF at the bin centres, times 1 + skew sin(phi_d) cos(phi_d),
// which mirroring changes; bins below the horizon are invalid, and those of
// theta_h beyond `cut`.
MerlTable TableOf(const BrdfFunction& brdf, double skew, int cut) {
  MerlTable table;
  table.raw.resize(size_t{3} * kMerlBins);
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      for (int k = 0; k < kMerlPhiD; ++k) {
        const double phi = MerlPhiD(k);
        const Eigen::Array3d f = brdf(MerlThetaH(i), MerlThetaD(j), phi) *
                                 (1.0 + skew * std::sin(2.0 * phi));
        const bool valid = i < cut && MerlBinAboveHorizon(i, j, k);
        for (int c = 0; c < 3; ++c) {
          table.raw[static_cast<size_t>(c) * kMerlBins +
                    MerlTable::Bin(i, j, k)] =
              valid ? f[c] / kMerlScale[c] : -1.0;
        }
      }
    }
  }
  return table;
}

// Matte, glossy and mirror-like, one with fewer valid bins.
const std::vector<MerlTable>& Tables() {
  static const std::vector<MerlTable> tables = {
      TableOf(Lambertian(0.6), 0.0, kMerlThetaH),
      TableOf(Glossy(0.1, 0.5, 8), 0.4, kMerlThetaH),
      TableOf(Glossy(0.01, 0.8, 1), -0.3, 80)};
  return tables;
}

MerlTableStack StackOf(int count) {
  MerlTableStack stack(count);
  for (int m = 0; m < count; ++m) stack.Set(m, Tables()[m % Tables().size()]);
  return stack;
}

std::vector<double> Batch(const MerlTableStack& tables,
                          const std::vector<Image>& maps,
                          const std::vector<ShadingPoint>& points,
                          const ReferenceOptions& options) {
  std::vector<const Image*> pointers;
  for (const Image& map : maps) pointers.push_back(&map);
  std::vector<double> L_o(3 * tables.count() * maps.size() * points.size());
  ReferenceBatch(tables, pointers, options).Render(points, L_o.data());
  return L_o;
}

// With bright texels as the batch has them.
std::vector<double> Single(const MerlTable& table, const Image& map,
                           const std::vector<ShadingPoint>& points,
                           ReferenceOptions options) {
  options.split_bright = false;
  std::vector<double> L_o(3 * points.size());
  ReferenceRenderer(map, options).Render(points, table, L_o.data());
  return L_o;
}

// A smooth sky and a hard sun of 9 texels, 10^9 times as bright.
Image SunnyMap(int height, int width) {
  Image map = SmoothMap(height, width);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) {
        map.At(width / 5 + c, height / 3 + r)[k] = 1e9f;
      }
    }
  }
  return map;
}

TEST(ReferenceBatch, IsTheSingleRendererWhereBothTakeEveryTexel) {
  // Numbers that do not fill the vectors, and several points of one angle.
  const MerlTableStack tables = StackOf(19);
  const std::vector<Image> maps = {SmoothMap(16, 32), RandomMap(16, 32, 3),
                                   SunnyMap(16, 32), ConstantMap(16, 32, 2.0f),
                                   RandomMap(16, 32, 4)};
  const std::vector<ShadingPoint> points = SpherePoints(6);
  ReferenceOptions options;
  options.near_rings = 24;
  options.near_ring_samples = 64;
  const std::vector<double> L_o = Batch(tables, maps, points, options);
  const size_t image = 3 * points.size();
  for (int m = 0; m < tables.count(); ++m) {
    for (size_t l = 0; l < maps.size(); ++l) {
      const std::vector<double> single =
          Single(Tables()[m % Tables().size()], maps[l], points, options);
      for (size_t i = 0; i < image; ++i) {
        // Float sums of up to 128 products.
        ASSERT_NEAR(1.0, L_o[image * (m * maps.size() + l) + i] / single[i],
                    2e-5)
            << m << " " << l << " " << i;
      }
    }
  }
}

TEST(ReferenceBatch, BlocksAgreeWithEveryTexel) {
  const MerlTableStack tables = StackOf(3);
  // Skies of full size, as the claim is about them; noise at texel scale is
  // the worst that a block can hold.
  Image noisy = RandomMap(256, 512, 7);
  const Image smooth = SmoothMap(256, 512);
  for (size_t i = 0; i < noisy.rgb.size(); ++i) {
    noisy.rgb[i] = smooth.rgb[i] * std::sqrt(noisy.rgb[i]);
  }
  const std::vector<Image> maps = {smooth, noisy, SunnyMap(256, 512)};
  // Points of a sphere that share angles by rotation, mirrors, and not at all.
  std::vector<ShadingPoint> points;
  for (const double degrees : {15.0, 50.0, 75.0}) {
    const ShadingPoint p = PointAt(degrees * kPi / 180, 0.4);
    const Eigen::Vector3f n = p.normal;
    points.insert(points.end(), 4, p);
    // The same digits in all four mirrors.
    points[points.size() - 3].normal = {-n.x(), n.y(), n.z()};
    points[points.size() - 2].normal = {-n.x(), -n.y(), n.z()};
    points[points.size() - 1].normal = {n.x(), -n.y(), n.z()};
    points.push_back(PointAt(degrees * kPi / 180, 1.3));
  }
  const ReferenceOptions blocks;
  ReferenceOptions texels;
  texels.far_width = 512;
  const std::vector<double> L_o = Batch(tables, maps, points, blocks);
  const size_t image = 3 * points.size();
  for (int m = 0; m < tables.count(); ++m) {
    for (size_t l = 0; l < maps.size(); ++l) {
      const std::vector<double> exact =
          Single(Tables()[m], maps[l], points, texels);
      double sum = 0.0;
      for (size_t i = 0; i < image; ++i) {
        sum += std::abs(
            std::log(L_o[image * (m * maps.size() + l) + i] / exact[i]));
      }
      // What the header promises.
      EXPECT_LT(sum / static_cast<double>(image), 1e-3) << m << " " << l;
    }
  }
}

TEST(ReferenceBatch, WhiteFurnaceIsOne) {
  MerlTableStack tables(1);
  tables.Set(0, TableOf(Lambertian(1.0), 0.0, kMerlThetaH));
  const std::vector<ShadingPoint> points = SpherePoints(8);
  ReferenceOptions options;
  options.far_width = 16;
  for (const double e :
       Batch(tables, {ConstantMap(64, 128, 1.0f)}, points, options)) {
    // Weights in double, values and products in float.
    EXPECT_NEAR(1.0, e, 3e-6);
  }
}

TEST(ReferenceBatch, SameBitsForAnyNumberOfThreads) {
  const MerlTableStack tables = StackOf(2);
  const std::vector<Image> maps = {RandomMap(32, 64, 1), SunnyMap(32, 64)};
  const std::vector<ShadingPoint> points = SpherePoints(7);
  ReferenceOptions options;
  options.far_width = 32;
  options.num_threads = 1;
  const std::vector<double> one = Batch(tables, maps, points, options);
  options.num_threads = 3;
  EXPECT_EQ(one, Batch(tables, maps, points, options));
}

TEST(ReferenceBatch, ExtremesStayFinite) {
  MerlTableStack tables(2);  // one is never set: black
  tables.Set(1, Tables()[2]);
  const std::vector<Image> maps = {SunnyMap(32, 64), ConstantMap(32, 64, 0.0f)};
  std::vector<ShadingPoint> points = {PointAt(0.0, 0.0),
                                      PointAt(89.99 * kPi / 180, 2.0)};
  ReferenceOptions options;
  options.far_width = 16;
  const std::vector<double> L_o = Batch(tables, maps, points, options);
  for (size_t i = 0; i < L_o.size(); ++i) {
    ASSERT_TRUE(std::isfinite(L_o[i]));
    const size_t image = i / (3 * points.size());
    if (image != 2) {
      EXPECT_EQ(0.0, L_o[i]);
    } else {
      EXPECT_GT(L_o[i], 0.0);
    }
  }
}

TEST(ReferenceKernels, LevelsAgreeWithPlainSums) {
  constexpr int kTables = 21, kMaps = 5, kRays = 77, kStride = 64;
  std::vector<const ReferenceKernels*> levels = {&portable::kReferenceKernels};
#if defined(IBRDF_HAVE_X86_KERNELS)
  if (SimdLevelSupported(SimdLevel::kAvx2)) {
    levels.push_back(&avx2::kReferenceKernels);
  }
  if (SimdLevelSupported(SimdLevel::kAvx512)) {
    levels.push_back(&avx512::kReferenceKernels);
  }
#endif
  std::vector<float> f(kRays * kStride + kReferenceStride);
  std::vector<float> g(kRays * kReferenceStride);
  for (size_t i = 0; i < f.size(); ++i) f[i] = std::sin(0.1f * i) + 1.5f;
  for (size_t i = 0; i < g.size(); ++i) g[i] = std::cos(0.3f * i) + 1.5f;
  std::vector<const float*> rows;
  for (int i = 0; i < kRays; ++i) rows.push_back(&g[i * kReferenceStride]);
  for (const ReferenceKernels* kernels : levels) {
    std::vector<double> sums(3 * kMaps * 32, 1.0);
    kernels->add_products(f.data(), kStride, kTables, rows.data(), kMaps, kRays,
                          sums.data());
    for (int c = 0; c < 3; ++c) {
      for (int l = 0; l < kMaps; ++l) {
        for (int m = 0; m < kTables; ++m) {
          double expected = 1.0;
          for (int i = 0; i < kRays; ++i) {
            expected += static_cast<double>(f[i * kStride + c * kTables + m]) *
                        rows[i][c * kMaps + l];
          }
          ASSERT_NEAR(1.0, sums[(c * kMaps + l) * 32 + m] / expected, 1e-5);
        }
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf

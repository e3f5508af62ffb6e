// Radiance under spherical Gaussians by light, in which it is linear. The
// library is compared with itself: its products with differences of radiance,
// and with each other.
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/approximation/gaussian_operator.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace derivatives {
namespace {

constexpr int kHeight = 16, kWidth = 32, kTrials = 10;

// A map made brighter and darker by up to a quarter, and the difference of the
// two, which is exact in float (Sterbenz's lemma). Steps have one sign: those
// of either sign would cancel in the radiance and leave the rounding of floats.
struct TangentMaps {
  std::vector<float> above, below, tangent;
};

TangentMaps MapsAbout(const Image& map, std::mt19937_64* rng) {
  std::uniform_real_distribution<float> share(0.0f, 0.25f);
  TangentMaps maps{map.rgb, map.rgb, map.rgb};
  for (size_t k = 0; k < map.rgb.size(); ++k) {
    const float step = share(*rng) * map.rgb[k];
    maps.above[k] += step;
    maps.below[k] -= step;
    maps.tangent[k] = maps.above[k] - maps.below[k];
  }
  return maps;
}

// The differential of all points' radiance along tangents, and the adjoint
// identity there.
void AddTangents(const std::string& kind,
                 const std::vector<ShadingPoint>& points, const Image& map,
                 const BrdfFunction& brdf, std::mt19937_64* rng,
                 ErrorTable* table) {
  const GaussianLight light(map);
  const GaussianTransport transport(light.lobes(), {});
  const GaussianOperator by_light(light, transport, points, brdf);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::string where = "trial " + std::to_string(trial);
    const TangentMaps maps = MapsAbout(map, rng);
    std::vector<double> a(3 * points.size()), above(a.size()), below(a.size()),
        dL_o(a.size());
    by_light.Apply(maps.above.data(), above.data());
    by_light.Apply(maps.below.data(), below.data());
    by_light.ApplyLinear(maps.tangent.data(), dL_o.data());
    std::vector<Real> difference;
    for (size_t k = 0; k < a.size(); ++k) {
      difference.push_back(Real(above[k]) - below[k]);
    }
    table->Add("gaussians: radiance along a map", kind, where, dL_o,
               difference);
    for (double& v : a) v = normal(*rng);
    std::vector<float> by_map(map.rgb.size());
    by_light.ApplyTranspose(a.data(), by_map.data());
    AddAdjointIdentity("gaussians: adjoint identity by map", kind, where, a,
                       dL_o, maps.tangent, by_map, table);
  }
}

}  // namespace

void StudyGaussians(const StudyOptions& options, ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  const int side = std::clamp(options.points / 40, 2, 5);
  const std::vector<ShadingPoint> sphere = testing::SpherePoints(side);
  const std::vector<ShadingPoint> extreme = testing::PolarAndGrazingPoints();
  const BrdfFunction matte = testing::Glossy(0.3, 0.2, 20);
  const BrdfFunction glossy = testing::Glossy(0.05, 0.6, 3);
  const Image smooth = testing::SmoothMap(kHeight, kWidth);
  Image sun = smooth;
  std::fill_n(sun.At(20, 4), 3, 1e6f);

  AddTangents("sphere, matte", sphere, smooth, matte, &rng, table);
  AddTangents("poles and grazing, glossy", extreme, smooth, glossy, &rng,
              table);
  AddTangents("poles and grazing, sun of one texel", extreme, sun, glossy, &rng,
              table);
}

}  // namespace derivatives
}  // namespace ibrdf

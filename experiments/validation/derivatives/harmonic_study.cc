// Radiance in spherical harmonics by BRDF and by light, in both of which it is
// linear.
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/reference_harmonics.h"
#include "experiments/validation/derivatives/studies.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace derivatives {
namespace {

constexpr int kHeight = 8, kWidth = 16;

void AddOrder(const std::string& kind, const std::vector<ShadingPoint>& points,
              const Image& map, const BrdfGrid& grid, int order,
              ErrorTable* table) {
  HarmonicOptions options;
  options.order = order;
  options.grid = grid.shape;
  const HarmonicTransport transport(points, map.height, map.width, options);
  const HarmonicOperator by_light = transport.ByLight(grid);
  const ReferenceHarmonics reference(points, map.height, map.width, options);
  const size_t nodes = grid.shape.num_nodes(), texels = map.num_pixels();
  for (size_t i = 0; i < points.size(); ++i) {
    const int point = static_cast<int>(i);
    std::vector<double> adjoint(3 * points.size(), 0.0);
    std::fill_n(&adjoint[3 * i], 3, 1.0);
    std::vector<float> by_map(3 * texels), by_grid(3 * nodes);
    by_light.ApplyTranspose(adjoint.data(), by_map.data());
    transport.GridGradient(map.rgb.data(), adjoint.data(), by_grid.data());
    std::vector<Real> map_row(3 * texels), grid_row(3 * nodes);
    for (size_t c = 0; c < 3; ++c) {
      const float* const field = grid.Channel(static_cast<int>(c));
      std::vector<Real> light;
      for (size_t t = 0; t < texels; ++t) light.push_back(map.rgb[3 * t + c]);
      const std::vector<Real> by_texel =
          reference.MapRow(point, {field, field + nodes});
      for (size_t t = 0; t < texels; ++t) map_row[3 * t + c] = by_texel[t];
      const std::vector<Real> by_node = reference.GridRow(point, light);
      std::copy(by_node.begin(), by_node.end(), &grid_row[c * nodes]);
    }
    const std::string where = "point " + std::to_string(i) +
                              ", cosine of view " +
                              Coordinates({points[i].normal.dot(points[i].wo)});
    const std::string name = kind + ", order " + std::to_string(order);
    table->Add("harmonics: radiance by map", name, where, ToDoubles(by_map),
               map_row);
    table->Add("harmonics: radiance by BRDF", name, where, ToDoubles(by_grid),
               grid_row);
  }
}

}  // namespace

void StudyHarmonics(const StudyOptions& options, ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  const BrdfGridShape shape = {12, 8, 6};
  const int side = std::clamp(options.points / 40, 2, 5);
  const std::vector<ShadingPoint> sphere = testing::SpherePoints(side);
  const std::vector<ShadingPoint> extreme = testing::PolarAndGrazingPoints();
  const BrdfGrid matte =
      BrdfGrid::FromFunction(testing::Glossy(0.3, 0.2, 20), shape);
  const BrdfGrid glossy =
      BrdfGrid::FromFunction(testing::Glossy(0.05, 0.6, 3), shape);
  BrdfGrid random(shape);  // signed, as tangents are
  std::normal_distribution<float> normal;
  for (float& v : random.values) v = normal(rng);
  const Image smooth = testing::SmoothMap(kHeight, kWidth);
  Image sun = smooth;
  std::fill_n(sun.At(10, 2), 3, 1e6f);

  AddOrder("sphere, matte", sphere, smooth, matte, 2, table);
  AddOrder("sphere, matte", sphere, smooth, matte, 5, table);
  AddOrder("sphere, signed BRDF", sphere, smooth, random, 5, table);
  AddOrder("poles and grazing, glossy", extreme, smooth, glossy, 5, table);
  AddOrder("poles and grazing, sun of one texel", extreme, sun, glossy, 5,
           table);
}

}  // namespace derivatives
}  // namespace ibrdf

// Radiance by BRDF and by light: L_o is linear in both, so that derivatives are
// entries of two matrices.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/reference_transport.h"
#include "experiments/validation/derivatives/studies.h"
#include "tests/support/render_testing.h"
#include "tests/support/shadow_testing.h"

namespace ibrdf {
namespace derivatives {
namespace {

using testing::PointAt;
using testing::SmoothMap;

// A point's reference takes all patches'.
constexpr size_t kBouncePoints = 6;

BrdfGridShape SmallGrid() { return {12, 8, 6}; }

// Signed, as tangents are.
BrdfGrid RandomGrid(std::mt19937_64* rng) {
  std::normal_distribution<float> normal;
  BrdfGrid grid(SmallGrid());
  for (float& v : grid.values) v = normal(*rng);
  return grid;
}

// The gradients of a point's radiance, channel c by channel c of the light and
// of the BRDF.
struct PointGradients {
  std::vector<float> map;   // [texels, 3]
  std::vector<float> grid;  // [3, nodes]
};

PointGradients GradientsOf(const Transport& transport,
                           const LightOperator& by_light, const BrdfGrid& grid,
                           const Image& map, size_t point) {
  std::vector<double> adjoint(size_t{3} * transport.num_points(), 0.0);
  for (int c = 0; c < 3; ++c) adjoint[3 * point + c] = 1.0;
  PointGradients by{std::vector<float>(map.rgb.size()),
                    std::vector<float>(grid.values.size())};
  by_light.ApplyTranspose(adjoint.data(), by.map.data());
  transport.GridGradient(grid, map.rgb.data(), adjoint.data(), by.grid.data());
  return by;
}

// The same by the reference.
struct ExactGradients {
  std::vector<Real> map;   // [texels, 3]
  std::vector<Real> grid;  // [3, nodes]
};

// light [texels][3].
ExactGradients ExactGradientsOf(const ReferenceTransport& reference,
                                const std::vector<Real>& light,
                                const BrdfGrid& grid, int point) {
  const size_t nodes = reference.num_nodes(), texels = reference.num_texels();
  const std::vector<Real> gathered = reference.Gather(point, light);
  ExactGradients by{std::vector<Real>(3 * texels),
                    std::vector<Real>(3 * nodes)};
  for (int c = 0; c < 3; ++c) {
    const std::vector<Real> field(grid.Channel(c), grid.Channel(c) + nodes);
    const std::vector<Real> row = reference.MapRow(point, field);
    for (size_t t = 0; t < texels; ++t) by.map[3 * t + c] = row[t];
    for (size_t n = 0; n < nodes; ++n) {
      by.grid[c * nodes + n] = gathered[3 * n + c];
    }
  }
  return by;
}

void AddRadiance(const std::string& kind, const std::string& where,
                 const PointGradients& by, const ExactGradients& exact,
                 ErrorTable* table) {
  table->Add("transport: radiance by map", kind, where, ToDoubles(by.map),
             exact.map);
  table->Add("transport: radiance by BRDF", kind, where, ToDoubles(by.grid),
             exact.grid);
}

// A point's row of the light matrix [points][texels] of the BRDF's first
// channel, and the derivative of its radiance by that channel.
void AddLightMatrix(const std::string& kind, const std::string& where,
                    const Transport& transport,
                    const std::vector<float>& matrix, const Image& map,
                    size_t point, const ExactGradients& exact,
                    ErrorTable* table) {
  const size_t texels = map.num_pixels(), nodes = exact.grid.size() / 3;
  const size_t first = point * texels;
  std::vector<Real> row(texels);
  std::vector<float> adjoint(matrix.size(), 0.0f), by_field(nodes);
  for (size_t t = 0; t < texels; ++t) {
    row[t] = exact.map[3 * t];
    adjoint[first + t] = map.rgb[3 * t];
  }
  table->Add("transport: light matrix", kind, where,
             {matrix.begin() + first, matrix.begin() + first + texels}, row);
  transport.LightMatrixGradient(adjoint.data(), by_field.data());
  table->Add("transport: light matrix by BRDF", kind, where,
             ToDoubles(by_field),
             {exact.grid.begin(), exact.grid.begin() + nodes});
}

// A point's radiance [3, 3] of the BRDF's channels as fields under each channel
// of the light, by RenderLobes and by the stored operator. Entry by entry:
// radiance of signed fields cancels.
void AddFields(const std::string& kind, const std::string& where,
               const BrdfGrid& grid, const float* lobes, const float* stored,
               const ExactGradients& exact, ErrorTable* table) {
  const size_t nodes = exact.grid.size() / 3;
  std::vector<Real> L_o(9, 0);
  Real size = 0;
  for (int k = 0; k < 3; ++k) {
    const float* const field = grid.Channel(k);
    for (int c = 0; c < 3; ++c) {
      Real magnitude = 0;
      for (size_t n = 0; n < nodes; ++n) {
        const Real term = field[n] * exact.grid[c * nodes + n];
        L_o[3 * k + c] += term;
        magnitude += std::abs(term);
      }
      size = std::max(size, magnitude);
    }
  }
  // Relative to the sum of magnitudes: 1 + the error, of 1.
  for (int k = 0; k < 9 && size > 0; ++k) {
    const auto add = [&](const std::string& name, double value) {
      table->Add(name, kind, where,
                 {static_cast<double>(1 + (value - L_o[k]) / size)}, {1});
    };
    add("transport: radiance of fields / sum of magnitudes", lobes[k]);
    add("transport: the same by the stored operator", stored[k]);
  }
}

void AddScene(const std::string& kind, const std::vector<ShadingPoint>& points,
              const Image& map, const BrdfGrid& grid,
              const TransportOptions& options, ErrorTable* table) {
  const Transport transport(points, map.height, map.width, options);
  const ReferenceTransport reference(points, map.height, map.width, options);
  const std::vector<Real> light(map.rgb.begin(), map.rgb.end());
  const LightOperator by_light = transport.ByLight(grid);
  const float* const fields[] = {grid.Channel(0), grid.Channel(1),
                                 grid.Channel(2)};
  std::vector<float> lobes(points.size() * 9), stored(lobes.size()), matrix;
  transport.RenderLobes(fields, 3, map.rgb.data(), lobes.data());
  transport.ByReflectance(map.rgb.data()).Apply(fields, 3, stored.data());
  // There is a light matrix where the map is not taken in blocks.
  if (FarBlockSize(map.height, map.width, options.quadrature.far_width) == 1) {
    matrix.resize(points.size() * map.num_pixels());
    transport.LightMatrix(grid.Channel(0), matrix.data());
  }
  for (size_t i = 0; i < points.size(); ++i) {
    const std::string where = "point " + std::to_string(i) +
                              ", cosine of view " +
                              Coordinates({points[i].normal.dot(points[i].wo)});
    const ExactGradients exact =
        ExactGradientsOf(reference, light, grid, static_cast<int>(i));
    if (!matrix.empty()) {
      AddLightMatrix(kind, where, transport, matrix, map, i, exact, table);
    }
    AddRadiance(kind, where, GradientsOf(transport, by_light, grid, map, i),
                exact, table);
    AddFields(kind, where, grid, &lobes[9 * i], &stored[9 * i], exact, table);
  }
}

// L_o is linear in the light and a polynomial in the BRDF. At a few of the
// points that see patches.
void AddBounces(const std::string& kind,
                const std::vector<ShadingPoint>& points, const Image& map,
                const BrdfGrid& grid, const TransportOptions& options,
                ErrorTable* table) {
  const Transport transport(points, map.height, map.width, options);
  const ReferenceBounces reference(points, map.height, map.width, options);
  const std::vector<Real> light(map.rgb.begin(), map.rgb.end());
  const LightOperator by_light = transport.ByLight(grid);
  const size_t nodes = grid.shape.num_nodes(), texels = map.num_pixels();
  std::vector<size_t> seeing;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!options.patches->SeenFrom(points[i]).empty()) seeing.push_back(i);
  }
  const size_t few = std::min(seeing.size(), kBouncePoints);
  for (size_t k = 0; k < few; ++k) {
    const size_t i = seeing[k * seeing.size() / few];
    const std::string where = "point " + std::to_string(i);
    ExactGradients exact{std::vector<Real>(3 * texels),
                         std::vector<Real>(3 * nodes)};
    for (int c = 0; c < 3; ++c) {
      const std::vector<Real> field(grid.Channel(c), grid.Channel(c) + nodes);
      const ReferenceBounces::Rows rows =
          reference.Derivatives(static_cast<int>(i), c, light, field);
      for (size_t t = 0; t < texels; ++t) exact.map[3 * t + c] = rows.by_map[t];
      std::copy(rows.by_grid.begin(), rows.by_grid.end(),
                exact.grid.begin() + c * nodes);
    }
    AddRadiance(kind, where, GradientsOf(transport, by_light, grid, map, i),
                exact, table);
  }
}

// <a, A x> against <A^T a, x>, of the two operators of the library alone.
void AddAdjoints(const std::string& kind,
                 const std::vector<ShadingPoint>& points, const Image& map,
                 const BrdfGrid& grid, const TransportOptions& options,
                 std::mt19937_64* rng, ErrorTable* table) {
  const Transport transport(points, map.height, map.width, options);
  const LightOperator light = transport.ByLight(grid);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<double> a(3 * points.size()), L_o(a.size());
    for (double& v : a) v = normal(*rng);
    std::vector<float> tangent(map.rgb.size()), by_map(tangent.size());
    for (float& v : tangent) v = static_cast<float>(normal(*rng));
    light.Apply(tangent.data(), L_o.data());
    light.ApplyTranspose(a.data(), by_map.data());
    const std::string where = "trial " + std::to_string(trial);
    AddAdjointIdentity("transport: adjoint identity by map", kind, where, a,
                       L_o, tangent, by_map, table);
    transport.Render(grid, map.rgb.data(), L_o.data());
    std::vector<float> by_grid(grid.values.size());
    transport.GridGradient(grid, map.rgb.data(), a.data(), by_grid.data());
    AddAdjointIdentity("transport: adjoint identity by BRDF", kind, where, a,
                       L_o, grid.values, by_grid, table);
  }
}

}  // namespace

void StudyTransport(const StudyOptions& options, ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  TransportOptions plain;
  plain.grid = SmallGrid();
  const int side = std::clamp(options.points / 25, 4, 8);
  const std::vector<ShadingPoint> sphere = testing::SpherePoints(side);
  std::vector<ShadingPoint> grazing;
  for (const double degrees : {89.0, 89.9, 89.94, 89.9427}) {
    grazing.push_back(PointAt(degrees * kPi / 180, 40));
  }
  const BrdfGrid matte =
      BrdfGrid::FromFunction(testing::Glossy(0.3, 0.2, 20), SmallGrid());
  const BrdfGrid glossy =
      BrdfGrid::FromFunction(testing::Glossy(0.05, 0.6, 3), SmallGrid());
  Image sun = SmoothMap(32, 64);
  std::fill_n(sun.At(40, 9), 3, 1e6f);
  Image directional_light = testing::ConstantMap(32, 64, 0.0f);
  std::fill_n(directional_light.At(40, 9), 3, 1e6f);

  AddScene("sphere", sphere, SmoothMap(32, 64), matte, plain, table);
  AddScene("signed BRDF", sphere, SmoothMap(8, 16), RandomGrid(&rng), plain,
           table);
  AddScene("map in blocks", sphere, SmoothMap(64, 128), glossy, plain, table);
  AddScene("sun of one texel", sphere, sun, glossy, plain, table);
  AddScene("sun alone", sphere, directional_light, glossy, plain, table);
  AddScene("grazing", grazing, SmoothMap(32, 64), glossy, plain, table);

  const Scene torus = Scene::FromMesh(testing::UnitTorusMesh(32, 16)).value();
  const std::vector<ShadingPoint> points =
      FindShadingPoints(torus, testing::TorusCamera(), side, side, Mask(), 1)
          .value();
  TransportOptions shadowed = plain;
  shadowed.visibility =
      std::make_shared<Visibility>(torus, points, VisibilityOptions());
  AddScene("shadows", points, SmoothMap(32, 64), glossy, shadowed, table);
  AddScene("shadows, map in blocks", points, SmoothMap(64, 128), glossy,
           shadowed, table);

  for (const int bounces : {1, 3}) {
    RadiosityOptions how;
    how.bounces = bounces;
    how.max_patches = 200;
    TransportOptions lit = shadowed;
    lit.patches = std::make_shared<RadiosityPatches>(torus, points,
                                                     shadowed.visibility, how);
    const std::string name =
        std::to_string(bounces) + (bounces == 1 ? " bounce" : " bounces");
    AddBounces(name, points, SmoothMap(16, 32), matte, lit, table);
    AddBounces(name + ", glossy, sun of one texel", points, sun, glossy, lit,
               table);
  }

  AddAdjoints("sphere", sphere, SmoothMap(32, 64), RandomGrid(&rng), plain,
              &rng, table);
  AddAdjoints("sun of one texel", sphere, sun, RandomGrid(&rng), plain, &rng,
              table);
  AddAdjoints("shadows, map in blocks", points, SmoothMap(64, 128),
              RandomGrid(&rng), shadowed, &rng, table);
}

}  // namespace derivatives
}  // namespace ibrdf

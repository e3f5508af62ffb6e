// The analytic BRDFs of the baselines, their costs, and lobes against a table.
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/reference_flows.h"
#include "experiments/validation/derivatives/reference_scene.h"
#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/dsbrdf.h"
#include "ibrdf/solvers/baselines/cook_torrance_cost.h"
#include "ibrdf/solvers/baselines/table_cost.h"
#include "ibrdf/solvers/costs/log_table_cost.h"
#include "tests/support/render_testing.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

constexpr Real kRealPi = 3.14159265358979323846L;
constexpr double kCostScale = 0.02;  // of the Cook-Torrance cost's loss

// The formula of cook_torrance.h at an angle where nothing is clamped or, where
// the library clamps a cosine, with its clamp.
template <typename T>
T CookTorranceOf(const T* p, Real theta_h, Real theta_d, Real phi_d) {
  const Real least = 1e-4;
  const Real nh = std::max(std::cos(theta_h), least);
  const Real oh = std::max(std::cos(theta_d), least);
  const Real along = std::sin(theta_h) * std::sin(theta_d) * std::cos(phi_d);
  const Real larger = std::max(nh * oh + std::abs(along), least);
  const Real smaller = std::max(nh * oh - std::abs(along), Real(0));
  Real masking = 2 * nh / (oh * larger);
  if (masking * larger * smaller > 1) masking = 1 / (larger * smaller);
  const T m2 = exp(T(2) * p[2]);
  const T f0 = T(1) / (T(1) + exp(-p[3]));
  const T fresnel = f0 + (T(1) - f0) * std::pow(1 - oh, 5);
  const Real tan2 = (1 - nh * nh) / (nh * nh);
  const T slopes = exp(-(T(tan2) / m2)) / m2;
  return exp(p[0]) / kRealPi + exp(p[1]) * fresnel * slopes *
                                   (masking / (4 * kRealPi * std::pow(nh, 4)));
}

void AddCookTorrance(const std::string& kind, const Eigen::Vector4d& p,
                     const Eigen::Vector3d& angles, ErrorTable* table) {
  std::vector<RealDual> x;
  for (int k = 0; k < 4; ++k) x.emplace_back(Real(p[k]), 4, k);
  Eigen::Vector4d gradient;
  EvaluateCookTorrance(p, angles[0], angles[1], angles[2], &gradient);
  table->Add(
      "Cook-Torrance by parameters", kind,
      "parameters " + Coordinates({p[0], p[1], p[2], p[3]}) + ", angles " +
          Coordinates({angles[0], angles[1], angles[2]}),
      {gradient.data(), gradient.data() + 4},
      CookTorranceOf(x.data(), angles[0], angles[1], angles[2]).derivatives);
}

void StudyCookTorrance(int count, std::mt19937_64* rng, ErrorTable* table) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  const double quarter = std::acos(0.0);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d angles(quarter * unit(*rng), quarter * unit(*rng),
                                 2 * quarter * unit(*rng));
    Eigen::Vector4d p(normal(*rng), normal(*rng), -2 + normal(*rng),
                      -3 + normal(*rng));
    AddCookTorrance("random", p, angles, table);
    AddCookTorrance("grazing", p, {angles[0], quarter, angles[2]}, table);
    AddCookTorrance("theta_h = 0", p, {0, angles[1], angles[2]}, table);
    for (const double roughness : {-400.0, -60.0, 30.0, 400.0}) {
      p[2] = roughness;
      AddCookTorrance("log roughness " + Coordinates({roughness}), p, angles,
                      table);
    }
    p[2] = -2;
    p[3] = i % 2 == 0 ? -60.0 : 60.0;
    AddCookTorrance("logit f0 +-60", p, angles, table);
  }
}

// exp(x) - 1 without cancellation.
RealDual Expm1(const RealDual& x) {
  return RealDual::Chain(std::expm1(x.value), std::exp(x.value), x);
}

void StudyDsbrdf(int count, std::mt19937_64* rng, ErrorTable* table) {
  const DsbrdfShape shape;
  const int n = shape.num_parameters();
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double quarter = std::acos(0.0);
  for (int i = 0; i < count; ++i) {
    std::vector<double> p(n);
    for (int r = 0; r < shape.lobes; ++r) {
      for (int k = 0; k < shape.coefficients; ++k) {
        p[shape.LogKappa(r) + k] = -4.0 + 7.0 * unit(*rng);
        p[shape.LogGamma(r) + k] = -3.0 + 9.0 * unit(*rng);
      }
    }
    p[shape.LogUnit()] = -3.0;
    const double theta_h = quarter * unit(*rng);
    const double theta_d = i % 4 == 0 ? quarter : quarter * unit(*rng);
    const DsbrdfGeometry geometry(shape, theta_h, theta_d);
    std::vector<double> gradient(n);
    EvaluateDsbrdf(shape, p.data(), geometry, gradient.data());
    std::vector<RealDual> x;
    for (int k = 0; k < n; ++k) x.emplace_back(Real(p[k]), n, k);
    RealDual f = 0;
    for (int r = 0; r < shape.lobes; ++r) {
      RealDual kappa = 0, gamma = 0;
      for (int k = 0; k < 4; ++k) {
        const Real w = geometry.basis.weight[k];
        kappa += w * x[shape.LogKappa(r) + geometry.basis.first + k];
        gamma += w * x[shape.LogGamma(r) + geometry.basis.first + k];
      }
      const RealDual power =
          exp(kappa + exp(gamma) * std::log(std::cos(Real(theta_h))));
      f += exp(x[shape.LogUnit()]) * Expm1(power);
    }
    table->Add(
        "DSBRDF by parameters", i % 4 == 0 ? "theta_d = 90 degrees" : "random",
        "angles " + Coordinates({theta_h, theta_d}), gradient, f.derivatives);
  }
}

// TableCost's chain rule, around Cook-Torrance.
void StudyTableCost(int count, std::mt19937_64* rng, ErrorTable* table) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<TableSample> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back({1.5 * unit(*rng), 1.5 * unit(*rng), 3 * unit(*rng),
                       Eigen::Array3d::Random(), unit(*rng)});
  }
  const TableModel model = [&](const double* p, size_t i, int,
                               double* gradient) {
    const TableSample& s = samples[i];
    Eigen::Vector4d g;
    const double f = EvaluateCookTorrance(Eigen::Map<const Eigen::Vector4d>(p),
                                          s.theta_h, s.theta_d, s.phi_d, &g);
    if (gradient != nullptr) std::copy_n(g.data(), 4, gradient);
    return f;
  };
  TableCost cost(samples, {1, 2}, 4, model);
  const double p[] = {-2.0, 0.5, -1.5, -2.0};
  std::vector<double> r(count), J(4 * count);
  const double* block[] = {p};
  double* jacobians[] = {J.data()};
  CHECK(cost.Evaluate(block, r.data(), jacobians));
  for (int i = 0; i < count; ++i) {
    const TableSample& s = samples[i];
    std::vector<RealDual> x;
    for (int k = 0; k < 4; ++k) x.emplace_back(Real(p[k]), 4, k);
    const RealDual f = CookTorranceOf(x.data(), s.theta_h, s.theta_d, s.phi_d);
    const RealDual residual =
        std::sqrt(Real(s.weight)) *
        log(f / Real(kMerlScale[1]) + Real(kTableLogFloor));
    table->Add("table cost by parameters", "random",
               Coordinates({s.theta_h, s.theta_d, s.phi_d}),
               {J.begin() + 4 * i, J.begin() + 4 * i + 4},
               residual.derivatives);
  }
}

void StudyLogTableCost(int count, std::mt19937_64* rng, ErrorTable* table) {
  const NeuralBrdfModel model = TinyModel(2);
  const auto flow = BrdfFlow::Create(model.shape, model.weights);
  const ReferenceFlows reference(model);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  TableColumns columns;
  columns.points = FlowColumns(count, 1);
  for (int i = 0; i < count; ++i) {
    columns.points.SetColumn(i, unit(*rng), unit(*rng));
    columns.points.x_h[i] = unit(*rng);
  }
  columns.log_raw.assign(3 * count, 0.0f);
  for (const double colour : {2.0, -60.0, 60.0}) {
    std::vector<double> p = {0.3,  -0.4, 0.2, 0.1,  0.0, 0.3, -0.2,
                             -0.5, 0.1,  0.3, -0.2, 1.0, 0.5, 0.3};
    for (const int k : {4, 5, 6, 11, 12, 13}) p[k] += colour;
    const double floor = 1e-6;
    LogTableCost cost(*flow, {2, 4}, 1.0, columns, floor, 2.0, 1);
    std::vector<double> r(3 * count), J(r.size() * p.size());
    const double* block[] = {p.data()};
    double* jacobians[] = {J.data()};
    CHECK(cost.Evaluate(block, r.data(), jacobians));
    for (int i = 0; i < 3 * count; ++i) {
      const int c = i / count, at = i % count;
      const Real x[3] = {columns.points.x_h[at], columns.points.x_d[at],
                         columns.points.x_p[at]};
      std::vector<Real> row(p.size(), 0), lobe(2);
      Real sum = floor;
      std::vector<FlowDerivatives> d;
      for (int k = 0; k < 2; ++k) {
        std::vector<Real> code;
        for (int z = 0; z < 4; ++z) {
          code.push_back(static_cast<float>(p[7 * k + z]));
        }
        d.push_back(reference.At(x, code));
        lobe[k] = std::exp(Real(p[7 * k + 4 + c]) + d[k].value);
        sum += lobe[k];
      }
      for (int k = 0; k < 2; ++k) {
        const Real share = std::sqrt(Real(2)) * lobe[k] / sum;
        for (int z = 0; z < 4; ++z) row[7 * k + z] = share * d[k].by_code[z];
        row[7 * k + 4 + c] = share;
      }
      const auto begin = J.begin() + static_cast<std::ptrdiff_t>(i * p.size());
      table->Add(
          "log table cost by lobes",
          "log colours about " + Coordinates({colour}),
          Coordinates({static_cast<double>(x[0]), static_cast<double>(x[1]),
                       static_cast<double>(x[2])}),
          {begin, begin + static_cast<std::ptrdiff_t>(p.size())}, row);
    }
  }
}

// The lobe at the nodes, by log roughness and logit f0.
std::vector<RealDual> LobeAtNodes(const BrdfGridShape& grid,
                                  const CookTorranceVector& p) {
  const std::vector<RealDual> x = {RealDual(Real(-1e4)), RealDual(0),
                                   RealDual(Real(p[6]), 2, 0),
                                   RealDual(Real(p[7]), 2, 1)};
  std::vector<RealDual> lobe;
  for (int i = 0; i < grid.num_nodes(); ++i) {
    const Eigen::Vector3d a = grid.NodeAngles(i);
    lobe.push_back(CookTorranceOf(x.data(), a[0], a[1], a[2]));
  }
  return lobe;
}

// The residual of a point's channel c by the parameters. gathered [nodes][3]:
// the light that the point gathers.
std::vector<Real> CookTorranceCostRow(const CookTorranceVector& p,
                                      const std::vector<RealDual>& lobe,
                                      const std::vector<Real>& gathered, int c,
                                      double log_observed, double floor) {
  Real matte = 0, sums[3] = {0, 0, 0};
  for (size_t n = 0; n < lobe.size(); ++n) {
    const Real g = gathered[3 * n + c];
    matte += g / kRealPi;
    sums[0] += g * lobe[n].value;
    for (int k = 0; k < 2; ++k) sums[1 + k] += g * lobe[n].derivatives[k];
  }
  const Real diffuse = std::exp(Real(p[c])) * matte;
  const Real colour = std::exp(Real(p[3 + c]));
  const Real L_o = diffuse + colour * sums[0] + Real(floor);
  const Real d = std::log(L_o) - Real(log_observed);
  const Real s = Real(kCostScale), root = std::sqrt(d * d + s * s);
  const Real slope = std::sqrt((root + s) / 2) / root / L_o;
  std::vector<Real> row(kCookTorranceParameters, 0);
  row[c] = slope * diffuse;
  row[3 + c] = slope * colour * sums[0];
  row[6] = slope * colour * sums[1];
  row[7] = slope * colour * sums[2];
  return row;
}

void StudyCookTorranceCost(ErrorTable* table) {
  const ReferenceScene scene(testing::SpherePoints(4),
                             testing::SmoothMap(8, 16));
  LogObservations observed;
  observed.floor = 1e-4;
  observed.values.assign(3 * scene.points().size(), 0.3);
  CookTorranceCost cost(scene.transport(), scene.map(), observed, kCostScale,
                        0);
  const std::vector<Real> light(scene.map().rgb.begin(), scene.map().rgb.end());
  for (const double roughness : {-0.5, -2.0, -5.0, -20.0}) {
    CookTorranceVector p;
    p << -1, -1.5, -2, 0.1, 0.2, 0, roughness, -2;
    std::vector<double> r(observed.values.size()),
        J(r.size() * kCookTorranceParameters);
    const double* block[] = {p.data()};
    double* jacobians[] = {J.data()};
    CHECK(cost.Evaluate(block, r.data(), jacobians)) << roughness;
    const std::vector<RealDual> lobe = LobeAtNodes(scene.options().grid, p);
    for (size_t i = 0; i < scene.points().size(); ++i) {
      const std::vector<Real> gathered =
          scene.reference().Gather(static_cast<int>(i), light);
      for (int c = 0; c < 3; ++c) {
        const size_t at = 3 * i + c;
        const auto begin = J.begin() + static_cast<std::ptrdiff_t>(
                                           at * kCookTorranceParameters);
        table->Add("Cook-Torrance cost by parameters",
                   "log roughness " + Coordinates({roughness}),
                   "value " + std::to_string(at),
                   {begin, begin + kCookTorranceParameters},
                   CookTorranceCostRow(p, lobe, gathered, c,
                                       observed.values[at], observed.floor));
      }
    }
  }
}

}  // namespace

void StudyBaselines(const StudyOptions& options, ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  StudyCookTorrance(options.points, &rng, table);
  StudyDsbrdf(options.points, &rng, table);
  StudyTableCost(options.points, &rng, table);
  StudyLogTableCost(options.points, &rng, table);
  StudyCookTorranceCost(table);
}

}  // namespace derivatives
}  // namespace ibrdf

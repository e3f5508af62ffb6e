#include "experiments/validation/stability/lobe_fits.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/validation/stability/naive_flow.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/merl_columns.h"
#include "ibrdf/flow/triangular_reference.h"
#include "ibrdf/solvers/joint/reflectance_solver.h"
#include "ibrdf/solvers/solve/exposure.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace stability {
namespace {

TransportOptions SceneOptions() {
  TransportOptions options;
  options.quadrature.near_rings = 10;
  options.quadrature.near_ring_samples = 32;
  options.grid = {18, 9, 6};
  return options;
}

// What solvers/estimate does with the scale and epsilon of the likelihood.
constexpr double kFirstScale = 0.1, kSmallestScale = 3e-3;
constexpr double kScaleStep = 3.0;
constexpr double kEpsilonShare = 1e-5;  // of the mean radiance
constexpr int kRounds = 8, kRoundSteps = 10;

double Misfit(const SphereScene& scene, const LobeModel& lobes,
              const std::vector<double>& parameters, const Image& map,
              const Observations& observed,
              const RobustLogLikelihood& likelihood) {
  std::vector<double> L_o;
  RenderLobeModel(scene.transport, lobes, parameters.data(), map.rgb.data(),
                  &L_o, nullptr);
  return EvaluateLikelihood(L_o, observed, likelihood, nullptr).misfit;
}

const float* GreenCode(const NeuralBrdfModel& model, int material) {
  return &model.codes[static_cast<size_t>(3 * material + 1) * kCodeSize];
}

using Lobe = std::vector<float>;

// The image of one lobe in float, and its Jacobian.
class NaiveImage {
 public:
  NaiveImage(const NeuralBrdfModel& model, const SphereScene& scene,
             const Image& map)
      : exponent_(static_cast<float>(model.exponent)),
        flow_(model.shape.triangular, model.weights.data()),
        grid_(scene.options.grid) {
    for (size_t i = 0; i < scene.points.size(); ++i) {
      light_.push_back(scene.naive.Gather(i, map.rgb));
    }
  }

  // L_o [points * 3], dL_o [points * 3, parameters].
  void Evaluate(const Lobe& lobe, Eigen::VectorXf* L_o,
                Eigen::MatrixXf* dL_o) const {
    const int nodes = grid_.num_nodes(), columns = grid_.d * grid_.p;
    std::vector<CodeJet> code(kCodeSize), field(nodes);
    for (int k = 0; k < kCodeSize; ++k) code[k] = CodeJet(lobe[k], k);
    std::vector<float> x_h(grid_.h);
    for (int c = 0; c < columns; ++c) {
      for (int i = 0; i < grid_.h; ++i) {
        x_h[i] = static_cast<float>(
            WithinMerlBins(grid_.NodePoint(i * columns + c))[0]);
      }
      const Eigen::Vector3f x =
          WithinMerlBins(grid_.NodePoint(c)).cast<float>();
      flow_.DensityOnColumn(x[1], x[2], x_h, code.data(),
                            [&](size_t i, const CodeJet& q) {
                              field[i * columns + c] = pow(q, exponent_);
                            });
    }
    L_o->resize(static_cast<Eigen::Index>(3 * light_.size()));
    dL_o->resize(L_o->size(), kCodeSize + 3);
    dL_o->setZero();
    for (Eigen::Index row = 0; row < L_o->size(); ++row) {
      const std::vector<float>& light = light_[row / 3];
      const int c = static_cast<int>(row % 3);
      CodeJet sum(0.0f);
      for (int n = 0; n < nodes; ++n) sum += field[n] * light[3 * n + c];
      const float colour =
          std::exp(lobe[kCodeSize + c]) * static_cast<float>(kMerlScale[c]);
      (*L_o)[row] = colour * sum.a;
      dL_o->row(row).head<kCodeSize>() = colour * sum.v.transpose();
      (*dL_o)(row, kCodeSize + c) = colour * sum.a;
    }
  }

 private:
  const float exponent_;
  const NaiveFlow flow_;
  const BrdfGridShape grid_;
  std::vector<std::vector<float>> light_;  // [points][nodes * 3]
};

}  // namespace

SphereScene::SphereScene(int size)
    : image_size(size),
      points(testing::SpherePoints(size)),
      options(SceneOptions()),
      transport(points, kMapHeight, kMapWidth, options),
      precise(points, kMapHeight, kMapWidth, options),
      naive(points, kMapHeight, kMapWidth, options) {}

std::vector<double> SphereScene::RadianceOf(const Image& image) const {
  std::vector<double> radiance;
  for (const ShadingPoint& p : points) {
    const float* rgb = &image.rgb[static_cast<size_t>(3) * p.pixel];
    radiance.insert(radiance.end(), rgb, rgb + 3);
  }
  return radiance;
}

Image SphereScene::ImageOf(const std::vector<double>& radiance) const {
  Image image(image_size, image_size);
  for (size_t i = 0; i < radiance.size(); ++i) {
    image.rgb[static_cast<size_t>(3) * points[i / 3].pixel + i % 3] =
        static_cast<float>(radiance[i]);
  }
  return image;
}

std::vector<double> TrueLobe(const NeuralBrdfModel& model) {
  std::vector<double> lobe = StartLobe(model);
  const float* second = GreenCode(model, 3 * model.num_materials() / 5);
  for (int k = 0; k < kCodeSize; ++k) lobe[k] += 0.5 * (second[k] - lobe[k]);
  const double tint[] = {0.8, 0.5, 0.1};
  for (int c = 0; c < 3; ++c) lobe[kCodeSize + c] += tint[c];
  return lobe;
}

std::vector<double> StartLobe(const NeuralBrdfModel& model) {
  CHECK_EQ(model.shape.code_size(), kCodeSize);
  const float* first = GreenCode(model, model.num_materials() / 5);
  std::vector<double> lobe(first, first + kCodeSize);
  lobe.resize(kCodeSize + 3, MeanLogColour(model));
  return lobe;
}

double MeanLogColour(const NeuralBrdfModel& model) {
  double sum = 0.0;
  for (const float colour : model.log_colours) sum += colour;
  return sum / static_cast<double>(model.log_colours.size());
}

std::vector<Real> PreciseField(const NeuralBrdfModel& model,
                               const BrdfGridShape& grid,
                               const std::vector<double>& lobe) {
  const TriangularReference<Real> flow(model.shape.triangular,
                                       model.weights.data());
  const std::vector<Real> code(lobe.begin(), lobe.end() - 3);
  std::vector<Real> field(grid.num_nodes());
  for (int i = 0; i < grid.num_nodes(); ++i) {
    const Eigen::Vector3d x = WithinMerlBins(grid.NodePoint(i));
    const Real p[3] = {x[0], x[1], x[2]};
    field[i] = std::exp(Real(model.exponent) * flow.LogDensity(p, code.data()));
  }
  return field;
}

std::vector<float> NaiveField(const NeuralBrdfModel& model,
                              const BrdfGridShape& grid,
                              const std::vector<double>& lobe) {
  const NaiveFlow flow(model.shape.triangular, model.weights.data());
  const std::vector<float> code(lobe.begin(), lobe.end() - 3);
  std::vector<float> field(grid.num_nodes());
  for (int i = 0; i < grid.num_nodes(); ++i) {
    const Eigen::Vector3f x = WithinMerlBins(grid.NodePoint(i)).cast<float>();
    field[i] = std::pow(flow.Density(x.data(), code.data()),
                        static_cast<float>(model.exponent));
  }
  return field;
}

std::vector<Real> PreciseRadiance(const SphereScene& scene,
                                  const std::vector<Real>& field,
                                  const std::vector<double>& lobe,
                                  const Image& map) {
  const std::vector<Real> light(map.rgb.begin(), map.rgb.end());
  std::vector<Real> L_o;
  for (size_t i = 0; i < scene.points.size(); ++i) {
    const std::vector<Real> gathered = scene.precise.Gather(i, light);
    for (int c = 0; c < 3; ++c) {
      Real sum = 0;
      for (size_t n = 0; n < field.size(); ++n) {
        sum += field[n] * gathered[3 * n + c];
      }
      L_o.push_back(PlainColour<Real>(lobe, c) * sum);
    }
  }
  return L_o;
}

std::vector<double> FitLibrary(const NeuralBrdfModel& model,
                               const SphereScene& scene, const Image& image,
                               const Image& map, const LobePrior& prior) {
  InverseProblem problem;
  problem.kind = ProblemKind::kReflectance;
  problem.image = image;
  problem.points = scene.points;
  problem.known_map = map;
  problem = InUnitsOf(ExposureOf(problem), problem);
  const Observations observed =
      MakeObservations(scene.RadianceOf(problem.image));
  double mean = 0.0;
  for (size_t i = 0; i < observed.radiance.size(); ++i) {
    if (observed.valid[i / 3]) mean += observed.radiance[i];
  }
  ReflectanceStepOptions o;
  o.likelihood.epsilon = kEpsilonShare * mean / (3.0 * observed.num_valid);
  o.likelihood.scale = kFirstScale;
  o.prior = prior;
  o.max_iterations = kRoundSteps;
  const FlowLobes lobes(model, 1, scene.options.grid, 1);
  std::vector<double> parameters = StartLobe(model);
  for (int round = 0; round < kRounds; ++round) {
    SolveReflectance(scene.transport, lobes, problem.known_map->rgb, observed,
                     o, &parameters);
    const double misfit = Misfit(scene, lobes, parameters, *problem.known_map,
                                 observed, o.likelihood);
    o.trust_region_radius = 300.0;
    o.likelihood.scale = std::min(
        o.likelihood.scale,
        std::max({misfit, o.likelihood.scale / kScaleStep, kSmallestScale}));
  }
  return parameters;
}

std::vector<double> FitNaive(const NeuralBrdfModel& model,
                             const SphereScene& scene, const Image& image,
                             const Image& map, bool leave_out) {
  constexpr int kMaxTrials = 60;
  const NaiveImage naive(model, scene, map);
  const std::vector<double> radiance = scene.RadianceOf(image);
  const auto rows = static_cast<Eigen::Index>(radiance.size());
  Eigen::VectorXf use = Eigen::VectorXf::Ones(rows), log_observed(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double* pixel = &radiance[i / 3 * 3];
    if (leave_out && *std::min_element(pixel, pixel + 3) <= 0.0) use[i] = 0.0f;
    log_observed[i] =
        use[i] > 0 ? std::log(static_cast<float>(radiance[i])) : 0.0f;
  }
  const auto evaluate = [&](const Lobe& lobe, Eigen::VectorXf* r,
                            Eigen::MatrixXf* J) {
    Eigen::VectorXf L_o;
    naive.Evaluate(lobe, &L_o, J);
    *r = use.cwiseProduct((L_o.array().log() - log_observed.array()).matrix());
    *J = (use.array() / L_o.array()).matrix().asDiagonal() * *J;
    return r->squaredNorm();
  };
  const std::vector<double> start = StartLobe(model);
  Lobe lobe(start.begin(), start.end());
  Eigen::VectorXf r, next_r;
  Eigen::MatrixXf J, next_J;
  float cost = evaluate(lobe, &r, &J);
  if (!std::isfinite(cost)) {
    return std::vector<double>(lobe.size(),
                               std::numeric_limits<double>::quiet_NaN());
  }
  float lambda = 1e-3f;
  for (int trial = 0; trial < kMaxTrials && lambda < 1e8f; ++trial) {
    Eigen::MatrixXf A = J.transpose() * J;
    A.diagonal() *= 1.0f + lambda;
    const Eigen::LLT<Eigen::MatrixXf> cholesky(A);
    const Eigen::VectorXf step = cholesky.solve(J.transpose() * r);
    Lobe next = lobe;
    for (size_t k = 0; k < next.size(); ++k) next[k] -= step[k];
    const float next_cost =
        cholesky.info() == Eigen::Success && step.allFinite()
            ? evaluate(next, &next_r, &next_J)
            : std::numeric_limits<float>::infinity();
    if (!(next_cost < cost)) {
      lambda *= 10.0f;
      continue;
    }
    const bool settled = cost - next_cost < 1e-7f * cost;
    lobe = next;
    cost = next_cost;
    r = next_r;
    J = next_J;
    lambda *= 0.1f;
    if (settled) break;
  }
  return std::vector<double>(lobe.begin(), lobe.end());
}

double BrdfError(const NeuralBrdfModel& model, const BrdfGridShape& grid,
                 const std::vector<double>& truth,
                 const std::vector<double>& estimate) {
  const TriangularReference<double> flow(model.shape.triangular,
                                         model.weights.data());
  const double least = std::cos(80.0 * M_PI / 180.0);
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < grid.num_nodes(); ++i) {
    Eigen::Vector3d wi, wo;
    const Eigen::Vector3d a = grid.NodeAngles(i);
    FromHalfDiff({a[0], a[1], a[2]}, &wi, &wo);
    if (wi.z() < least || wo.z() < least) continue;
    const Eigen::Vector3d x = WithinMerlBins(grid.NodePoint(i));
    const double shape =
        model.exponent * (flow.LogDensity(x.data(), estimate.data()) -
                          flow.LogDensity(x.data(), truth.data()));
    for (int c = 0; c < 3; ++c) {
      const size_t at = truth.size() - 3 + c;
      const double d = shape + estimate[at] - truth[at];
      sum += d * d;
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

}  // namespace stability
}  // namespace ibrdf

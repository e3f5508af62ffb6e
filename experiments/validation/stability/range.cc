// Dynamic range of the light, and units of radiance.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/stability/lobe_fits.h"
#include "experiments/validation/stability/sweeps.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/solve/exposure.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace stability {
namespace {

constexpr double kScale = 0.02, kDelta = 0.5;  // of the likelihood

// Log-normal radiance of mean 1 with a sun of R in one texel, in units of
// 1 / unit.
Image SunnyMap(double R, double unit) {
  Image map =
      testing::RandomMap(SphereScene::kMapHeight, SphereScene::kMapWidth, 3);
  double sum = 0.0;
  for (const float v : map.rgb) sum += v;
  const double mean = sum / static_cast<double>(map.rgb.size());
  const double sun[] = {1.0, 0.9, 0.7};
  for (float& v : map.rgb) v = static_cast<float>(v / mean * unit);
  for (int c = 0; c < 3; ++c) {
    map.At(5, 4)[c] = static_cast<float>(R * sun[c] * unit);
  }
  return map;
}

// Radiance L_o, the gradient of the likelihood by log L [texels * 3] and the
// product of its Gauss-Newton matrix with a direction.
template <typename T>
struct Likelihood {
  std::vector<T> L_o, gradient, product;
};

// By plain loops; `epsilon` as RobustLogLikelihood's.
template <typename Scene>
Likelihood<typename Scene::T> PlainLikelihood(
    const Scene& scene, const std::vector<typename Scene::T>& field,
    const std::vector<double>& lobe, const Image& map,
    const std::vector<double>& observed, double epsilon,
    const std::vector<float>& direction) {
  using T = typename Scene::T;
  const size_t texels = scene.num_texels();
  const std::vector<T> L(map.rgb.begin(), map.rgb.end());
  const T b = static_cast<T>(kScale), delta = static_cast<T>(kDelta);
  const T eps = static_cast<T>(epsilon);
  Likelihood<T> out;
  out.gradient.assign(3 * texels, T(0));
  out.product.assign(3 * texels, T(0));
  for (size_t i = 0; i < scene.num_points(); ++i) {
    const std::vector<T> row = scene.MapRow(i, field);
    for (int c = 0; c < 3; ++c) {
      const T colour = PlainColour<T>(lobe, c);
      T L_o = 0, dL_o = 0;
      for (size_t t = 0; t < texels; ++t) {
        const T share = colour * row[t] * L[3 * t + c];
        L_o += share;
        dL_o += share * static_cast<T>(direction[3 * t + c]);
      }
      out.L_o.push_back(L_o);
      const T I = static_cast<T>(observed[3 * i + c]);
      const T d = (std::log(L_o + eps) - std::log(I + eps)) / b;
      const T root = std::sqrt(d * d + delta * delta);
      const T slope = d / root / (b * (L_o + eps));
      // rho'(t) / t (dt/dL_o)^2.
      const T weight = 1 / (b * b * (L_o + eps) * (L_o + eps)) / root;
      for (size_t t = 0; t < texels; ++t) {
        const T by_log = colour * row[t] * L[3 * t + c];
        out.gradient[3 * t + c] += slope * by_log;
        out.product[3 * t + c] += by_log * weight * dL_o;
      }
    }
  }
  return out;
}

struct Problem {
  const NeuralBrdfModel& model;
  const SphereScene& scene;
  std::vector<double> lobe;
  std::vector<Real> field;
  std::vector<float> naive_field, direction;
};

// The library's, in units of the image's exposure and back.
Likelihood<double> LibraryLikelihood(const Problem& p, const Image& map,
                                     const Image& image, double* epsilon) {
  InverseProblem problem;
  problem.image = image;
  problem.points = p.scene.points;
  problem.known_map = map;
  const double exposure = ExposureOf(problem);
  problem = InUnitsOf(exposure, problem);
  const std::vector<float>& L = problem.known_map->rgb;
  const std::vector<double> radiance = p.scene.RadianceOf(problem.image);
  RobustLogLikelihood likelihood;
  likelihood.scale = kScale;
  likelihood.delta = kDelta;
  likelihood.epsilon = 0.0;
  for (const double v : radiance) {
    likelihood.epsilon += 1e-5 * v / static_cast<double>(radiance.size());
  }
  *epsilon = likelihood.epsilon * exposure;
  const FlowLobes lobes(p.model, 1, p.scene.options.grid, 1);
  Likelihood<double> out;
  RenderLobeModel(p.scene.transport, lobes, p.lobe.data(), L.data(), &out.L_o,
                  nullptr);
  LikelihoodDerivatives d;
  EvaluateLikelihood(out.L_o, MakeObservations(radiance), likelihood, &d);
  std::vector<float> fields;
  lobes.Tabulate(p.lobe.data(), false, &fields);
  const LightOperator light =
      p.scene.transport.ByLight(lobes.Combine(p.lobe.data(), fields, 1));
  std::vector<double> adjoint(out.L_o.size()), tangent(out.L_o.size());
  std::vector<float> moved = L, back(L.size());
  for (size_t i = 0; i < adjoint.size(); ++i) {
    adjoint[i] = d.residual[i] * d.d_residual[i];
  }
  light.ApplyTranspose(adjoint.data(), back.data());
  for (size_t t = 0; t < L.size(); ++t) {
    out.gradient.push_back(static_cast<double>(back[t]) * L[t]);
    moved[t] *= p.direction[t];
  }
  light.Apply(moved.data(), tangent.data());
  for (size_t i = 0; i < tangent.size(); ++i) tangent[i] *= d.weight[i];
  light.ApplyTranspose(tangent.data(), back.data());
  for (size_t t = 0; t < L.size(); ++t) {
    out.product.push_back(static_cast<double>(back[t]) * L[t]);
  }
  for (double& L_o : out.L_o) L_o *= exposure;
  return out;
}

// |difference| / |reference|, Euclidean norms of the texels of each row of the
// map: rows without the sun count as much as its own.
template <typename T>
std::vector<double> RowErrors(const std::vector<T>& values,
                              const std::vector<Real>& reference) {
  const size_t width = size_t{3} * SphereScene::kMapWidth;
  std::vector<double> errors;
  for (size_t begin = 0; begin < values.size(); begin += width) {
    Real square = 0, difference = 0;
    for (size_t i = begin; i < begin + width; ++i) {
      const Real d = values[i] - reference[i];
      difference += d * d;
      square += reference[i] * reference[i];
    }
    errors.push_back(static_cast<double>(std::sqrt(difference / square)));
  }
  return errors;
}

template <typename T>
void AddErrors(const std::string& sweep, double x,
               const std::string& implementation, const Likelihood<T>& values,
               const Likelihood<Real>& reference, bool product,
               SweepTable* table) {
  std::vector<double> errors;
  for (size_t i = 0; i < values.L_o.size(); ++i) {
    errors.push_back(RelativeError(values.L_o[i], reference.L_o[i]));
  }
  table->Add(sweep, x, "radiance", implementation, errors);
  table->Add(sweep, x, "gradient by log map", implementation,
             RowErrors(values.gradient, reference.gradient));
  if (!product) return;
  table->Add(sweep, x, "Gauss-Newton product", implementation,
             RowErrors(values.product, reference.product));
}

Problem MakeProblem(const NeuralBrdfModel& model, const SphereScene& scene) {
  Problem p{model, scene, TrueLobe(model), {}, {}, {}};
  // LobeModel gives its flow codes in float.
  for (double& v : p.lobe) v = static_cast<float>(v);
  p.field = PreciseField(model, scene.options.grid, p.lobe);
  p.naive_field = NaiveField(model, scene.options.grid, p.lobe);
  std::mt19937 rng(5);
  std::normal_distribution<float> normal;
  for (size_t i = 0; i < 3 * scene.precise.num_texels(); ++i) {
    p.direction.push_back(normal(rng));
  }
  return p;
}

// One place on an axis. The image has 2 % log-normal noise.
void AddCase(const std::string& sweep, double x, const Image& map,
             const Problem& p, bool product, SweepTable* table) {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  std::vector<double> observed;
  for (const Real L_o : PreciseRadiance(p.scene, p.field, p.lobe, map)) {
    observed.push_back(static_cast<double>(L_o) * std::exp(0.02 * normal(rng)));
  }
  const Image image = p.scene.ImageOf(observed);
  observed = p.scene.RadianceOf(image);
  const auto reference = [&](double epsilon) {
    return PlainLikelihood(p.scene.precise, p.field, p.lobe, map, observed,
                           epsilon, p.direction);
  };
  double epsilon = 0.0;
  const Likelihood<double> ours = LibraryLikelihood(p, map, image, &epsilon);
  AddErrors(sweep, x, kOurs, ours, reference(epsilon), product, table);
  AddErrors(sweep, x, kNaive,
            PlainLikelihood(p.scene.naive, p.naive_field, p.lobe, map, observed,
                            0.0, p.direction),
            reference(0.0), product, table);
}

}  // namespace

void SweepRange(const NeuralBrdfModel& model, const SweepOptions&,
                SweepTable* table) {
  const SphereScene scene(8);
  const Problem p = MakeProblem(model, scene);
  LobePrior weak;
  weak.sigma = weak.colour_sigma = 100.0;
  weak.wall = 0.0;
  for (int power = 0; power <= 12; ++power) {
    const double R = std::pow(10.0, power);
    const Image map = SunnyMap(R, 1.0);
    AddCase("range", R, map, p, false, table);
    // Without noise: what is left is arithmetic.
    std::vector<double> exact;
    for (const Real L_o : PreciseRadiance(scene, p.field, p.lobe, map)) {
      exact.push_back(static_cast<double>(L_o));
    }
    const Image image = scene.ImageOf(exact);
    const auto error = [&](const std::vector<double>& lobe) {
      return std::vector<double>{
          BrdfError(model, scene.options.grid, p.lobe, lobe)};
    };
    table->Add("range", R, "fitted reflectance", kOurs,
               error(FitLibrary(model, scene, image, map, weak)));
    table->Add("range", R, "fitted reflectance", kNaive,
               error(FitNaive(model, scene, image, map, false)));
  }
}

void SweepUnits(const NeuralBrdfModel& model, const SweepOptions&,
                SweepTable* table) {
  const SphereScene scene(8);
  const Problem p = MakeProblem(model, scene);
  for (int power = -36; power <= 36; power += 3) {
    const double unit = std::pow(10.0, power);
    AddCase("units", unit, SunnyMap(100.0, unit), p, true, table);
  }
}

}  // namespace stability
}  // namespace ibrdf

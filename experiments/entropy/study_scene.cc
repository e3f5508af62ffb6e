#include "experiments/entropy/study_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/uncertainty/band_limit.h"

namespace ibrdf {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> FibonacciSphere(int count) {
  std::vector<Vector3d> out;
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / count;
    const double phi = k * kPi * (3.0 - std::sqrt(5.0));
    const double s = std::sqrt(1.0 - z * z);
    out.emplace_back(s * std::cos(phi), z, s * std::sin(phi));
  }
  return out;
}

// Axes x, y, z = normal, as columns.
Eigen::Matrix3d FrameOf(const Vector3d& normal) {
  const Vector3d up =
      std::abs(normal.y()) > 0.9 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0);
  Eigen::Matrix3d out;
  out.col(0) = up.cross(normal).normalized();
  out.col(1) = normal.cross(out.col(0));
  out.col(2) = normal;
  return out;
}

double Smith(double cosine, double alpha) {
  const double tan2 = 1.0 / (cosine * cosine) - 1.0;
  return 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * tan2));
}

// What a GGX surface reflects to `w` (in the frame): with F_0 = 0, and more by
// F_0. Half vectors are drawn from D cos, low discrepancy, turned at random.
struct Gloss {
  Eigen::Array3d fixed{0, 0, 0}, slope{0, 0, 0};
};

Gloss Reflect(const Image& map, const Eigen::Matrix3d& frame, const Vector3d& w,
              double roughness, int samples, std::mt19937* rng) {
  // The alpha of a mirror: its lobe is a texel.
  const double alpha = std::max(1e-3, roughness * roughness);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const double first = u(*rng), turn = u(*rng);
  Gloss out;
  for (int k = 0; k < samples; ++k) {
    const double v = std::fmod(first + (k + 0.5) / samples, 1.0);
    const double phi =
        2.0 * kPi * std::fmod(turn + k * 0.6180339887498949, 1.0);
    const double tan2 = alpha * alpha * v / std::max(1e-9, 1.0 - v);
    const double z = 1.0 / std::sqrt(1.0 + tan2), s = std::sqrt(1.0 - z * z);
    const Vector3d h(s * std::cos(phi), s * std::sin(phi), z);
    const double d = h.dot(w);
    const Vector3d wi = 2.0 * d * h - w;
    if (d <= 0.0 || wi.z() <= 0.0) continue;
    const double weight =
        Smith(w.z(), alpha) * Smith(wi.z(), alpha) * d / (w.z() * z) / samples;
    const Eigen::Array3d L = weight * LookUpMap(map, frame * wi);
    const double schlick = std::pow(1.0 - d, 5);
    out.fixed += schlick * L;
    out.slope += (1.0 - schlick) * L;
  }
  return out;
}

Eigen::Array3d Irradiance(const Image& map, const Vector3d& normal) {
  Eigen::Array3d out(0, 0, 0);
  for (int r = 0; r < map.height; ++r) {
    const double solid = TexelSolidAngle(r, map.height, map.width);
    for (int c = 0; c < map.width; ++c) {
      const double cosine =
          normal.dot(MapDirection(r + 0.5, c + 0.5, map.height, map.width));
      if (cosine <= 0.0) continue;
      const float* const L = map.At(c, r);
      out += solid * cosine * Eigen::Array3d(L[0], L[1], L[2]);
    }
  }
  return out;
}

std::vector<StudyMaterial> Materials(const SceneOptions& options,
                                     std::mt19937* rng) {
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<StudyMaterial> out;
  for (int k = 0; k < options.num_texels; ++k) {
    if (k > 0 && options.one_material) {
      out.push_back(out[0]);
      continue;
    }
    StudyMaterial m;
    m.roughness = 0.1 + 0.8 * u(*rng);
    for (int c = 0; c < 3; ++c) {
      m.Ks[c] = u(*rng);
      m.Kd[c] = (1.0 - m.Ks[c]) * u(*rng);
    }
    out.push_back(m);
  }
  return out;
}

// The map smoothed as the published code smooths it: degrees below 2 / alpha.
class SmoothMap {
 public:
  SmoothMap(const Image& map, double alpha)
      : basis_(std::min(100, static_cast<int>(2.0 / alpha)) - 1) {
    const int order = basis_.order();
    L_ = HarmonicProjection(order, map.height, map.width)
             .Project(map.rgb.data());
    for (int l = 0; l <= order; ++l) {
      L_.middleRows(l * l, 2 * l + 1) *= std::exp(-alpha * l * alpha * l);
    }
  }
  Eigen::Array3d At(const Vector3d& direction) const {
    Eigen::VectorXd Y(basis_.count());
    basis_.Evaluate(direction, Y.data());
    return (Y.transpose() * L_).transpose().array();
  }

 private:
  HarmonicBasis basis_;
  HarmonicColours L_;
};

// Directions within a cap of one of these are hidden.
struct Cap {
  Vector3d axis;
  double cosine;
};

std::vector<Cap> Caps(const Vector3d& normal, double mean, std::mt19937* rng) {
  std::poisson_distribution<int> count(mean);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> angle(0.3, 0.9);
  std::vector<Cap> out;
  for (int k = count(*rng); k > 0; --k) {
    Vector3d axis =
        Vector3d(gauss(*rng), gauss(*rng), gauss(*rng)).normalized();
    if (axis.dot(normal) < 0.0) axis = -axis;
    out.push_back({axis, std::cos(angle(*rng))});
  }
  return out;
}

// All views of one texel.
void FillTexel(const Image& map, const SmoothMap& smooth,
               const SceneOptions& options, const Vector3d& normal, int texel,
               StudyScene* scene) {
  std::mt19937 rng(options.seed * 7919 + texel);
  std::normal_distribution<double> gauss;
  const Eigen::Matrix3d frame = FrameOf(normal);
  const std::vector<Cap> caps = Caps(normal, options.occluders, &rng);
  const StudyMaterial& m = scene->materials[texel];
  const Eigen::Array3d white = Irradiance(map, normal) / kPi;
  TexelSamples& samples = scene->samples;
  for (int c = 0; c < 3; ++c) {
    samples.irradiance[3 * texel + c] = static_cast<float>(white[c] * kPi);
  }
  for (int view = 0; view < options.num_views; ++view) {
    const size_t at = static_cast<size_t>(texel) * options.num_views + view;
    const Vector3d world = (scene->cameras[view] - normal).normalized();
    const Vector3d w = frame.transpose() * world;
    bool seen = w.z() > 1e-3;
    for (const Cap& cap : caps) {
      seen = seen && world.dot(cap.axis) < cap.cosine;
    }
    samples.weight[at] = seen ? 1.0f : 0.0f;
    for (int k = 0; k < 3; ++k) {
      samples.directions[3 * at + k] = static_cast<float>(w[k]);
    }
    if (!seen) continue;
    const Gloss truth =
        Reflect(map, frame, w, m.roughness, 2 * options.samples, &rng);
    const Eigen::Array3d B = m.Kd * white + truth.fixed + m.Ks * truth.slope;
    const Eigen::Array3d L =
        smooth.At(2.0 * normal.dot(world) * normal - world);
    for (int c = 0; c < 3; ++c) {
      samples.outgoing[3 * at + c] =
          static_cast<float>(B[c] * std::exp(options.noise * gauss(rng)));
      samples.incoming[3 * at + c] = static_cast<float>(L[c]);
    }
    for (int i = 0; i < kBruteRoughnesses; ++i) {
      const Gloss gloss = Reflect(map, frame, w, i / (kBruteRoughnesses - 1.0),
                                  options.samples, &rng);
      for (int c = 0; c < 3; ++c) {
        const size_t to = (at * kBruteRoughnesses + i) * 3 + c;
        scene->fixed[to] = static_cast<float>(gloss.fixed[c]);
        scene->slope[to] = static_cast<float>(gloss.slope[c]);
      }
    }
  }
}

}  // namespace

StudyScene MakeStudyScene(const Image& stored, const SceneOptions& options) {
  Image map = ResizeMap(stored, 128, 256);
  const double unit = MeanRadiance(map).mean();
  for (float& x : map.rgb) x = static_cast<float>(x / unit);
  StudyScene out;
  std::mt19937 rng(options.seed);
  out.materials = Materials(options, &rng);
  for (const Vector3d& v : FibonacciSphere(options.num_views)) {
    out.cameras.push_back(4.0 * v);
  }
  TexelSamples& samples = out.samples;
  samples.num_texels = options.num_texels;
  samples.num_views = options.num_views;
  const size_t count =
      static_cast<size_t>(options.num_texels) * options.num_views;
  samples.directions.assign(3 * count, 0.0f);
  samples.outgoing.assign(3 * count, 0.0f);
  samples.incoming.assign(3 * count, 0.0f);
  samples.weight.assign(count, 0.0f);
  samples.irradiance.assign(3 * static_cast<size_t>(options.num_texels), 0.0f);
  samples.prefilter_alpha = PrefilterAlpha(options.num_views);
  out.fixed.assign(count * kBruteRoughnesses * 3, 0.0f);
  out.slope.assign(count * kBruteRoughnesses * 3, 0.0f);
  const SmoothMap smooth(map, samples.prefilter_alpha);
  const std::vector<Vector3d> normals = FibonacciSphere(options.num_texels);
  ParallelFor(options.num_texels, 0, [&](int64_t texel, int) {
    FillTexel(map, smooth, options, normals[texel], static_cast<int>(texel),
              &out);
  });
  return out;
}

}  // namespace ibrdf

#include "ibrdf/solvers/entropy_study/study_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/surface/texel_irradiance.h"
#include "ibrdf/uncertainty/band_limit.h"

namespace ibrdf {
namespace {

using Eigen::Vector3d;

constexpr double kCameraDistance = 4.0;  // in radii of the surface
constexpr double kLeastCosine = 1e-3;    // of a view that sees a texel

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

std::vector<StudyMaterial> Materials(int num_texels, bool one_material,
                                     std::mt19937* rng) {
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<StudyMaterial> out;
  for (int k = 0; k < num_texels; ++k) {
    if (k > 0 && one_material) {
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

// The map without the texels that the surface hides from a point.
Image UnhiddenMap(const Scene& scene, const SurfacePoint& point,
                  const Image& map) {
  if (!scene.CastsShadows()) return map;
  std::vector<Eigen::Vector3f> directions;
  for (int r = 0; r < map.height; ++r) {
    for (int c = 0; c < map.width; ++c) {
      directions.push_back(
          MapDirection(r + 0.5, c + 0.5, map.height, map.width).cast<float>());
    }
  }
  std::vector<uint8_t> hidden(directions.size());
  scene.Occluded(point.position, directions, hidden.data());
  Image out = map;
  for (size_t i = 0; i < hidden.size(); ++i) {
    for (int c = 0; c < 3 && hidden[i] != 0; ++c) out.rgb[3 * i + c] = 0.0f;
  }
  return out;
}

// Fills the rows of the scene's texels, one by one. Safe to share between
// threads, each with texels of its own.
class SceneFiller {
 public:
  SceneFiller(const StudySurface& surface, const Image& map,
              const SceneOptions& options, StudyScene* scene)
      : surface_(surface),
        map_(map),
        smooth_(map, scene->samples.prefilter_alpha),
        open_(surface.scene, map, false),
        unhidden_(surface.scene, map, true),
        options_(options),
        scene_(scene) {}

  void FillTexel(int texel) const {
    std::mt19937 rng(options_.seed * 7919 + texel);
    const SurfacePoint& point = surface_.points[texel];
    const Image light = UnhiddenMap(surface_.scene, point, map_);
    const std::vector<Cap> caps = Caps(point.normal, options_.occluders, &rng);
    const Eigen::Array3d matte = Irradiance(light, point.normal) / kPi;
    const Eigen::Array3d open = open_.At(point.position, point.normal);
    const Eigen::Array3d unhidden = unhidden_.At(point.position, point.normal);
    for (int c = 0; c < 3; ++c) {
      const size_t at = 3 * static_cast<size_t>(texel) + c;
      scene_->matte[at] = static_cast<float>(matte[c]);
      scene_->open_irradiance[at] = static_cast<float>(open[c]);
      scene_->unhidden_irradiance[at] = static_cast<float>(unhidden[c]);
    }
    for (int view = 0; view < options_.num_views; ++view) {
      FillView(texel, view, light, caps, &rng);
    }
  }

 private:
  bool Sees(const SurfacePoint& point, const Vector3d& to_camera,
            const std::vector<Cap>& caps) const {
    if (to_camera.dot(point.normal) <= kLeastCosine) return false;
    for (const Cap& cap : caps) {
      if (to_camera.dot(cap.axis) >= cap.cosine) return false;
    }
    return !surface_.scene.CastsShadows() ||
           !surface_.scene.Occluded(point.position, to_camera);
  }

  void FillView(int texel, int view, const Image& light,
                const std::vector<Cap>& caps, std::mt19937* rng) const {
    const SurfacePoint& point = surface_.points[texel];
    TexelSamples& samples = scene_->samples;
    const size_t at = static_cast<size_t>(texel) * options_.num_views + view;
    const Vector3d world =
        (scene_->cameras[view] - point.position).normalized();
    const Eigen::Matrix3d frame = FrameOf(point.normal);
    const Vector3d w = frame.transpose() * world;
    for (int k = 0; k < 3; ++k) {
      samples.directions[3 * at + k] = static_cast<float>(w[k]);
    }
    if (!Sees(point, world, caps)) return;
    samples.weight[at] = 1.0f;
    const Vector3d mirror =
        2.0 * point.normal.dot(world) * point.normal - world;
    const bool hidden = surface_.scene.CastsShadows() &&
                        surface_.scene.Occluded(point.position, mirror);
    const Eigen::Array3d L = smooth_.At(mirror);
    for (int c = 0; c < 3; ++c) {
      samples.incoming[3 * at + c] = static_cast<float>(L[c]);
      scene_->unhidden_incoming[3 * at + c] =
          hidden ? 0.0f : samples.incoming[3 * at + c];
    }
    Expose(texel, at, light, frame, w, rng);
  }

  // What the camera sees, and what it would see of each roughness.
  void Expose(int texel, size_t at, const Image& light,
              const Eigen::Matrix3d& frame, const Vector3d& w,
              std::mt19937* rng) const {
    const StudyMaterial& m = scene_->materials[texel];
    std::normal_distribution<double> gauss;
    const Gloss truth =
        Reflect(light, frame, w, m.roughness, 2 * options_.samples, rng);
    for (int c = 0; c < 3; ++c) {
      const double B = m.Kd[c] * scene_->matte[3 * texel + c] + truth.fixed[c] +
                       m.Ks[c] * truth.slope[c];
      scene_->samples.outgoing[3 * at + c] =
          static_cast<float>(B * std::exp(options_.noise * gauss(*rng)));
    }
    for (int i = 0; i < kBruteRoughnesses; ++i) {
      const Gloss gloss =
          Reflect(light, frame, w, i / (kBruteRoughnesses - 1.0),
                  options_.samples, rng);
      for (int c = 0; c < 3; ++c) {
        const size_t to = (at * kBruteRoughnesses + i) * 3 + c;
        scene_->fixed[to] = static_cast<float>(gloss.fixed[c]);
        scene_->slope[to] = static_cast<float>(gloss.slope[c]);
      }
    }
  }

  const StudySurface& surface_;
  const Image& map_;
  const SmoothMap smooth_;
  const TexelIrradiance open_, unhidden_;
  const SceneOptions& options_;
  StudyScene* const scene_;
};

StudyScene EmptyScene(int num_texels, int num_views) {
  StudyScene out;
  TexelSamples& samples = out.samples;
  samples.num_texels = num_texels;
  samples.num_views = num_views;
  const size_t count = static_cast<size_t>(num_texels) * num_views;
  samples.directions.assign(3 * count, 0.0f);
  samples.outgoing.assign(3 * count, 0.0f);
  samples.incoming.assign(3 * count, 0.0f);
  samples.weight.assign(count, 0.0f);
  samples.prefilter_alpha = PrefilterAlpha(num_views);
  out.unhidden_incoming.assign(3 * count, 0.0f);
  out.matte.assign(3 * static_cast<size_t>(num_texels), 0.0f);
  out.open_irradiance = out.unhidden_irradiance = out.matte;
  out.fixed.assign(count * kBruteRoughnesses * 3, 0.0f);
  out.slope.assign(count * kBruteRoughnesses * 3, 0.0f);
  return out;
}

}  // namespace

StudyScene MakeStudyScene(const StudySurface& surface, const Image& stored,
                          const SceneOptions& options) {
  Image map = ResizeMap(stored, 128, 256);
  const double unit = MeanRadiance(map).mean();
  for (float& x : map.rgb) x = static_cast<float>(x / unit);
  const int texels = static_cast<int>(surface.points.size());
  StudyScene out = EmptyScene(texels, options.num_views);
  std::mt19937 rng(options.seed);
  out.materials = Materials(texels, options.one_material, &rng);
  for (const Vector3d& v : FibonacciSphere(options.num_views)) {
    out.cameras.push_back(kCameraDistance * v);
  }
  const SceneFiller filler(surface, map, options, &out);
  ParallelFor(texels, options.num_threads, [&](int64_t texel, int) {
    filler.FillTexel(static_cast<int>(texel));
  });
  return out;
}

}  // namespace ibrdf

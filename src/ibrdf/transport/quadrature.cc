#include "ibrdf/transport/quadrature.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "ibrdf/base/fast_atan2.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

// Steps of the view angle and fineness of the rings for the share of the cosine
// integral that belongs to near: 0.01 % of pi at any view angle.
constexpr int kIntegralSteps = 90;
constexpr int kIntegralRings = 120;
constexpr int kIntegralRingSamples = 240;

// Moves wi, at cosine c in a cell of half-extent a, to the cosine-weighted
// centre of the cell's part above the horizon.
Eigen::Vector3d CentreAboveHorizon(const Eigen::Vector3d& wi,
                                   const Eigen::Vector3d& n, double c,
                                   double a) {
  const double wanted = c < a ? (c + a) * (2.0 / 3.0) : c + a * a / (3.0 * c);
  return (wi + (wanted - c) * n).normalized();
}

}  // namespace

void ViewFrame(const Eigen::Vector3d& n, const Eigen::Vector3d& wo,
               Eigen::Vector3d* t, Eigen::Vector3d* b) {
  *t = wo - n.dot(wo) * n;
  if (t->norm() < 1e-7) {
    *t = (std::abs(n.x()) < 0.9 ? Eigen::Vector3d::UnitX()
                                : Eigen::Vector3d::UnitY())
             .cross(n);
  }
  t->normalize();
  *b = n.cross(*t);
}

double NearShare(double theta_h, const QuadratureOptions& options) {
  const double begin = options.near_begin_degrees * kDegree;
  const double end = options.near_end_degrees * kDegree;
  const double x = std::clamp((theta_h - begin) / (end - begin), 0.0, 1.0);
  return 1.0 - x * x * (3.0 - 2.0 * x);
}

double MeanClippedCosine(double c, double a) {
  if (c >= a) return c;
  if (c <= -a) return 0.0;
  return (c + a) * (c + a) / (4.0 * a);
}

int FarBlockSize(int map_height, int map_width, int far_width) {
  int block = 1;
  while (map_width / block > far_width && map_width % (2 * block) == 0 &&
         map_height % (2 * block) == 0) {
    block *= 2;
  }
  return block;
}

int NumFarCells(int map_height, int map_width, int far_width) {
  const int block = FarBlockSize(map_height, map_width, far_width);
  return (map_height / block) * (map_width / block);
}

std::vector<FarCell> MapCells(int map_height, int map_width, int block) {
  CHECK(map_height % block == 0 && map_width % block == 0);
  const int rows = map_height / block, columns = map_width / block;
  std::vector<FarCell> cells;
  cells.reserve(static_cast<size_t>(rows) * columns);
  for (int r = 0; r < rows; ++r) {
    const double theta = kPi * (r + 0.5) / rows;
    for (int c = 0; c < columns; ++c) {
      const double phi = 2.0 * kPi * (c + 0.5) / columns;
      FarCell cell;
      cell.direction = MapDirection(r + 0.5, c + 0.5, rows, columns);
      cell.half_theta =
          Eigen::Vector3d(std::cos(theta) * std::sin(phi), -std::sin(theta),
                          std::cos(theta) * std::cos(phi)) *
          (0.5 * kPi / rows);
      cell.half_phi = Eigen::Vector3d(std::cos(phi), 0.0, -std::sin(phi)) *
                      (std::sin(theta) * kPi / columns);
      cell.solid_angle = TexelSolidAngle(r, rows, columns);
      cells.push_back(cell);
    }
  }
  return cells;
}

FarDirections::FarDirections(const std::vector<FarCell>& cells) {
  for (const FarCell& cell : cells) {
    for (int k = 0; k < 3; ++k) {
      values_[k].push_back(cell.direction[k]);
      values_[3 + k].push_back(cell.half_theta[k]);
      values_[6 + k].push_back(cell.half_phi[k]);
    }
  }
}

FarCellColumns FarDirections::columns() const {
  FarCellColumns columns{};
  for (int k = 0; k < 3; ++k) {
    columns.direction[k] = values_[k].data();
    columns.half_theta[k] = values_[3 + k].data();
    columns.half_phi[k] = values_[6 + k].data();
  }
  return columns;
}

PointQuadrature::PointQuadrature(const std::vector<FarCell>& cells,
                                 const QuadratureOptions& options)
    : options_(options),
      directions_(cells),
      half_vectors_(
          Rings(options.near_rings, options.near_ring_samples, options)) {
  for (const FarCell& cell : cells) solid_angles_.push_back(cell.solid_angle);
  CHECK(options.near_begin_degrees >= 0.0 &&
        options.near_begin_degrees < options.near_end_degrees &&
        options.near_end_degrees <= 90.0 && options.near_rings > 0 &&
        options.near_ring_samples > 0);
  near_integral_ = NearIntegrals(options);
}

std::shared_ptr<const std::vector<double>> PointQuadrature::NearIntegrals(
    const QuadratureOptions& options) {
  static std::mutex mutex;
  static double begin = 0.0, end = 0.0;
  static std::shared_ptr<const std::vector<double>> last;
  const std::lock_guard<std::mutex> lock(mutex);
  if (last != nullptr && begin == options.near_begin_degrees &&
      end == options.near_end_degrees) {
    return last;
  }
  const std::vector<HalfVector> fine =
      Rings(kIntegralRings, kIntegralRingSamples, options);
  std::vector<double> integrals(kIntegralSteps + 1);
  for (int i = 0; i <= kIntegralSteps; ++i) {
    const double theta_o = 0.5 * kPi * i / kIntegralSteps;
    integrals[i] = NearSum(fine, std::cos(theta_o), std::sin(theta_o));
  }
  begin = options.near_begin_degrees;
  end = options.near_end_degrees;
  last = std::make_shared<const std::vector<double>>(std::move(integrals));
  return last;
}

std::vector<PointQuadrature::HalfVector> PointQuadrature::Rings(
    int rings, int ring_samples, const QuadratureOptions& options) {
  const double end = options.near_end_degrees * kDegree;
  const auto edge = [&](int i) {
    const double e = static_cast<double>(i) / rings;
    return e * e * e * end;
  };
  std::vector<HalfVector> half_vectors;
  for (int i = 0; i < rings; ++i) {
    const double inner = edge(i), outer = edge(i + 1);
    const double middle = 0.5 * (inner + outer);
    const int count = std::max(
        6, static_cast<int>(std::lround(ring_samples * (i + 1.0) / rings)));
    HalfVector h{};
    h.theta_h = middle;
    h.cos_h = std::cos(middle);
    h.sin_h = std::sin(middle);
    h.half_theta = 0.5 * (outer - inner);
    h.half_phi = h.sin_h * kPi / count;
    h.measure = NearShare(middle, options) * 2.0 * std::sin(middle) *
                std::sin(h.half_theta) * 2.0 * kPi / count;
    for (int k = 0; k < count; ++k) {
      h.phi_h = 2.0 * kPi * (k + 0.5) / count;
      h.cos_p = std::cos(h.phi_h);
      h.sin_p = std::sin(h.phi_h);
      half_vectors.push_back(h);
    }
  }
  return half_vectors;
}

namespace {
// In the frame with n = +z and wo = (sin_o, 0, cos_o): the cosine of
// wi = reflect(wo, h), and how far it varies over the cell of h.
struct NearCosine {
  double oh;      // o.h
  double centre;  // cos(theta_i)
  double extent;
};
template <typename HalfVector>
NearCosine CosineOf(const HalfVector& h, double cos_o, double sin_o) {
  NearCosine out{};
  out.oh = sin_o * h.sin_h * h.cos_p + cos_o * h.cos_h;
  out.centre = 2.0 * out.oh * h.cos_h - cos_o;
  const double o_theta = sin_o * h.cos_h * h.cos_p - cos_o * h.sin_h;
  const double o_phi = -sin_o * h.sin_p;
  const double along_theta =
      2.0 * (o_theta * h.cos_h - out.oh * h.sin_h) * h.half_theta;
  const double along_phi = 2.0 * o_phi * h.cos_h * h.half_phi;
  out.extent = std::sqrt(along_theta * along_theta + along_phi * along_phi);
  return out;
}
}  // namespace

double PointQuadrature::NearSum(const std::vector<HalfVector>& half_vectors,
                                double cos_o, double sin_o) {
  double sum = 0.0;
  for (const HalfVector& h : half_vectors) {
    const NearCosine cosine = CosineOf(h, cos_o, sin_o);
    if (cosine.oh <= 0.0) continue;
    sum += 4.0 * cosine.oh * MeanClippedCosine(cosine.centre, cosine.extent) *
           h.measure;
  }
  return sum;
}

double PointQuadrature::NearIntegral(double theta_o) const {
  const double x = std::clamp(theta_o / (0.5 * kPi), 0.0, 1.0) * kIntegralSteps;
  const int i = std::min(static_cast<int>(x), kIntegralSteps - 1);
  const std::vector<double>& integral = *near_integral_;
  return integral[i] + (x - i) * (integral[i + 1] - integral[i]);
}

double PointQuadrature::SampleNear(double cos_o, double sin_o,
                                   std::vector<NearSample>* samples) const {
  samples->clear();
  const Eigen::Vector3d o_local(sin_o, 0.0, cos_o);
  double sum = 0.0;
  for (const HalfVector& h : half_vectors_) {
    if (h.measure <= 0.0) continue;
    const NearCosine cosine = CosineOf(h, cos_o, sin_o);
    if (cosine.oh <= 0.0 || cosine.centre <= -cosine.extent) continue;
    const double weight = 4.0 * cosine.oh *
                          MeanClippedCosine(cosine.centre, cosine.extent) *
                          h.measure;
    if (weight <= 0.0) continue;
    sum += weight;
    NearSample s;
    s.weight = weight;
    s.wi = Eigen::Vector3d(2.0 * cosine.oh * h.sin_h * h.cos_p - sin_o,
                           2.0 * cosine.oh * h.sin_h * h.sin_p, cosine.centre);
    if (cosine.centre < cosine.extent) {
      s.wi = CentreAboveHorizon(s.wi, Eigen::Vector3d::UnitZ(), cosine.centre,
                                cosine.extent);
      const HalfDiff angles = ToHalfDiff(s.wi, o_local);
      s.theta_h = angles.theta_h;
      s.theta_d = angles.theta_d;
      s.phi_d = angles.phi_d;
      s.x_h = ToUnitCube(s.theta_h, s.theta_d, s.phi_d)[0];
    } else {
      // wo and wi are half a turn apart about h: phi_d mod pi is that of wo.
      const double x = sin_o * h.cos_p * h.cos_h - cos_o * h.sin_h;
      const double y = -sin_o * h.sin_p;
      s.theta_h = h.theta_h;
      s.theta_d = FastAtan2(std::sqrt(x * x + y * y), cosine.oh);
      s.phi_d = FoldPhi(FastAtan2(y, x));
      // ThetaHBound: x is sin(theta_d) cos(phi_d) of wo.
      const double bound = FastAtan2(cosine.oh, std::abs(x));
      s.x_h = std::sqrt(std::min(s.theta_h / bound, 1.0));
    }
    samples->push_back(s);
  }
  const double integral = NearIntegral(std::atan2(sin_o, cos_o));
  const double correction = sum > 0.0 ? integral / sum : 1.0;
  for (NearSample& s : *samples) s.weight *= correction;
  return correction;
}

void PointQuadrature::SampleCells(const FarDirections& cells,
                                  const Eigen::Vector3d& n,
                                  const Eigen::Vector3d& wo,
                                  std::vector<FarSample>* samples) const {
  samples->clear();
  const SampleFarFunction sample = IBRDF_ACTIVE_KERNEL(SampleFar);
  const FarCellColumns columns = cells.columns();
  FarView view{};
  Eigen::Map<Eigen::Vector3d>(view.n) = n;
  Eigen::Map<Eigen::Vector3d>(view.wo) = wo;
  view.near_begin = options_.near_begin_degrees * kDegree;
  view.near_end = options_.near_end_degrees * kDegree;
  FarBlock block;
  for (int begin = 0; begin < cells.count(); begin += kFarBlock) {
    const int count = std::min(kFarBlock, cells.count() - begin);
    sample(columns, begin, count, view, &block);
    for (int i = 0; i < count; ++i) {
      if (!(block.weight[i] > 0.0)) continue;
      samples->push_back({block.theta_h[i], block.theta_d[i], block.phi_d[i],
                          block.x_h[i], begin + i, block.weight[i]});
    }
  }
}

double PointQuadrature::SampleFar(const Eigen::Vector3d& n,
                                  const Eigen::Vector3d& wo,
                                  std::vector<FarSample>* samples) const {
  SampleCells(directions_, n, wo, samples);
  double sum = 0.0;
  for (const FarSample& s : *samples) {
    sum += s.weight * solid_angles_[s.cell];
  }
  Eigen::Vector3d t, b;
  ViewFrame(n, wo, &t, &b);
  const double integral =
      kPi - NearIntegral(std::atan2(std::max(wo.dot(t), 0.0),
                                    std::clamp(n.dot(wo), 0.0, 1.0)));
  const double correction = sum > 0.0 ? integral / sum : 1.0;
  for (FarSample& s : *samples) s.weight *= correction;
  return correction;
}

void PointQuadrature::Sample(const Eigen::Vector3d& n,
                             const Eigen::Vector3d& wo,
                             PointSamples* samples) const {
  Eigen::Vector3d t, b;
  ViewFrame(n, wo, &t, &b);
  samples->near_correction =
      SampleNear(std::clamp(n.dot(wo), 0.0, 1.0), std::max(wo.dot(t), 0.0),
                 &samples->near);
  for (NearSample& s : samples->near) {
    s.wi = (s.wi.x() * t + s.wi.y() * b + s.wi.z() * n).normalized();
  }
  samples->far_correction = SampleFar(n, wo, &samples->far);
}

}  // namespace ibrdf

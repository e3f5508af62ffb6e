#include "ibrdf/approximation/harmonic_transport.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/image/darkest.h"
#include "ibrdf/scene/view_angles.h"

namespace ibrdf {
namespace {
using namespace view_angles;  // NOLINT

}  // namespace

HarmonicTransport::HarmonicTransport(const std::vector<ShadingPoint>& points,
                                     int map_height, int map_width,
                                     const HarmonicOptions& options)
    : options_(options),
      basis_(options.order),
      map_(options.order, map_height, map_width),
      cells_(options.order, options.quadrature.far_width / 2,
             options.quadrature.far_width),
      rotation_(options.order) {
  CHECK_GE(options.view_angles, 4);
  Eigen::Vector3f last_wo = Eigen::Vector3f::Zero();
  for (const ShadingPoint& p : points) {
    AddPoint(p.normal.cast<double>().normalized(),
             p.wo.cast<double>().normalized(),
             points_.empty() || p.wo != last_wo);
    last_wo = p.wo;
  }
  const PointQuadrature quadrature(MapCells(options.quadrature.far_width / 2,
                                            options.quadrature.far_width, 1),
                                   options.quadrature);
  pairs_.resize(options.view_angles);
  ParallelFor(options.view_angles, options.num_threads, [&](int64_t k, int) {
    AddPairs(quadrature, static_cast<double>(k) * ViewStep(), &pairs_[k]);
  });
}

double HarmonicTransport::ViewStep() const {
  return MaxViewAngle() / (options_.view_angles - 1);
}

void HarmonicTransport::AddPoint(const Eigen::Vector3d& n,
                                 const Eigen::Vector3d& wo, bool is_new_pole) {
  if (is_new_pole) poles_.push_back(HarmonicRotation::PoleAt(wo));
  Point point{};
  point.pole = static_cast<int>(poles_.size()) - 1;
  Eigen::Vector3d t, b;
  ViewFrame(n, wo, &t, &b);
  const double sine = std::max(wo.dot(t), 0.0), cosine = n.dot(wo);
  // From wo towards n, at right angles to wo.
  point.turn = HarmonicRotation::AngleOf(poles_.back(), sine * n - cosine * t);
  const double at =
      std::min(std::atan2(sine, cosine), MaxViewAngle()) / ViewStep();
  point.first =
      std::clamp(static_cast<int>(at) - 1, 0, options_.view_angles - 4);
  CubicWeights(at - point.first, point.weight);
  points_.push_back(point);
}

void HarmonicTransport::AddPairs(const PointQuadrature& quadrature,
                                 double view_angle,
                                 std::vector<Pair>* pairs) const {
  // The point's frame is the map's: the view along +y.
  const Eigen::Vector3d n(0.0, std::cos(view_angle), std::sin(view_angle));
  PointSamples samples;
  quadrature.Sample(n, Eigen::Vector3d::UnitY(), &samples);
  const auto add = [&](const auto& sample, int cell,
                       const Eigen::Vector3d& direction) {
    Pair pair{};
    const BrdfGridTaps taps =
        GridTaps(options_.grid,
                 ToUnitCube(sample.theta_h, sample.theta_d, sample.phi_d));
    for (int corner = 0; corner < 8; ++corner) {
      pair.node[corner] = taps.node[corner];
      pair.weight[corner] = static_cast<float>(taps.weight[corner]);
    }
    pair.cell = cell;
    pair.share = sample.weight;
    pair.direction = direction;
    pairs->push_back(pair);
  };
  for (const NearSample& s : samples.near) add(s, -1, s.wi);
  for (const FarSample& s : samples.far) {
    add(s, s.cell, Eigen::Vector3d::Zero());
  }
}

void HarmonicTransport::PairHarmonics(const Pair& pair, double* Y) const {
  if (pair.cell < 0) {
    basis_.Evaluate(pair.direction, Y);
  } else {
    const int columns = options_.quadrature.far_width;
    cells_.Texel(pair.cell / columns, pair.cell % columns, Y);
  }
  for (int k = 0; k < basis_.count(); ++k) Y[k] *= pair.share;
}

HarmonicTransport::Slices HarmonicTransport::SlicesOf(
    const BrdfGrid& grid) const {
  CHECK(grid.shape == options_.grid);
  Slices slices(pairs_.size());
  ParallelFor(static_cast<int64_t>(pairs_.size()), options_.num_threads,
              [&](int64_t k, int) {
                slices[k] = HarmonicColours::Zero(basis_.count(), 3);
                Eigen::VectorXd Y(basis_.count());
                for (const Pair& pair : pairs_[k]) {
                  Eigen::RowVector3d f = Eigen::RowVector3d::Zero();
                  for (int c = 0; c < 3; ++c) {
                    const float* const values = grid.Channel(c);
                    for (int j = 0; j < 8; ++j) {
                      f[c] += double{pair.weight[j]} * values[pair.node[j]];
                    }
                  }
                  PairHarmonics(pair, Y.data());
                  slices[k].noalias() += Y * f;
                }
              });
  return slices;
}

HarmonicColours HarmonicTransport::SliceAt(const Slices& slices,
                                           const Point& point) const {
  HarmonicColours S = point.weight[0] * slices[point.first];
  for (int j = 1; j < 4; ++j) S += point.weight[j] * slices[point.first + j];
  return S;
}

template <typename Use>
void HarmonicTransport::ForLight(const float* map, const Use& use) const {
  const HarmonicColours light = map_.Project(map);
  ParallelFor(kChunks, options_.num_threads, [&](int64_t chunk, int) {
    int pole = -1;
    HarmonicColours at_pole, turned;
    const int64_t end = ChunkBegin(chunk + 1, points_.size());
    for (int64_t i = ChunkBegin(chunk, points_.size()); i < end; ++i) {
      if (points_[i].pole != pole) {
        pole = points_[i].pole;
        at_pole = light;
        rotation_.ToPole(poles_[pole], &at_pole);
      }
      turned = at_pole;
      rotation_.Turn(points_[i].turn, &turned);
      use(chunk, i, turned);
    }
  });
}

void HarmonicTransport::Render(const BrdfGrid& grid, const float* map,
                               double* L_o) const {
  RenderSlices(SlicesOf(grid), map, L_o);
}

HarmonicOperator HarmonicTransport::ByLight(const BrdfGrid& grid) const {
  return HarmonicOperator(*this, grid);
}

void HarmonicOperator::ApplyLinear(const float* map, double* L_o) const {
  transport_.RenderSlices(slices_, map, L_o);
}

void HarmonicOperator::ApplyTranspose(const double* adjoint,
                                      float* gradient) const {
  transport_.MapGradient(slices_, adjoint, gradient);
}

void HarmonicTransport::RenderSlices(const Slices& slices, const float* map,
                                     double* L_o) const {
  ForLight(map, [&](int64_t, int64_t i, const HarmonicColours& light) {
    const Eigen::RowVector3d radiance =
        SliceAt(slices, points_[i]).cwiseProduct(light).colwise().sum();
    for (int c = 0; c < 3; ++c) L_o[3 * i + c] = radiance[c];
  });
}

void HarmonicTransport::GridGradient(const float* map, const double* adjoint,
                                     float* gradient) const {
  const HarmonicColours zero = HarmonicColours::Zero(basis_.count(), 3);
  std::vector<std::vector<HarmonicColours>> partial(
      kChunks, std::vector<HarmonicColours>(pairs_.size(), zero));
  ForLight(map, [&](int64_t chunk, int64_t i, const HarmonicColours& light) {
    const Eigen::Map<const Eigen::RowVector3d> a(adjoint + 3 * i);
    const HarmonicColours share =
        light.cwiseProduct(a.replicate(basis_.count(), 1));
    const Point& p = points_[i];
    for (int j = 0; j < 4; ++j)
      partial[chunk][p.first + j] += p.weight[j] * share;
  });
  for (int64_t chunk = 1; chunk < kChunks; ++chunk) {
    for (size_t k = 0; k < pairs_.size(); ++k)
      partial[0][k] += partial[chunk][k];
  }
  // What each pair's value of the BRDF adds.
  std::vector<std::vector<Eigen::Vector3d>> by_pair(pairs_.size());
  ParallelFor(static_cast<int64_t>(pairs_.size()), options_.num_threads,
              [&](int64_t k, int) {
                Eigen::VectorXd Y(basis_.count());
                for (const Pair& pair : pairs_[k]) {
                  PairHarmonics(pair, Y.data());
                  by_pair[k].push_back(partial[0][k].transpose() * Y);
                }
              });
  const size_t nodes = options_.grid.num_nodes();
  std::vector<double> sums(3 * nodes, 0.0);
  for (size_t k = 0; k < pairs_.size(); ++k) {
    for (size_t i = 0; i < pairs_[k].size(); ++i) {
      const Pair& pair = pairs_[k][i];
      for (int c = 0; c < 3; ++c) {
        for (int j = 0; j < 8; ++j) {
          sums[c * nodes + pair.node[j]] +=
              double{pair.weight[j]} * by_pair[k][i][c];
        }
      }
    }
  }
  for (size_t k = 0; k < sums.size(); ++k) {
    gradient[k] = static_cast<float>(sums[k]);
  }
}

void HarmonicTransport::MapGradient(const Slices& slices, const double* adjoint,
                                    float* gradient) const {
  const HarmonicColours zero = HarmonicColours::Zero(basis_.count(), 3);
  std::vector<HarmonicColours> partial(kChunks, zero);
  ParallelFor(kChunks, options_.num_threads, [&](int64_t chunk, int) {
    const int64_t begin = ChunkBegin(chunk, points_.size());
    const int64_t end = ChunkBegin(chunk + 1, points_.size());
    HarmonicColours at_pole = zero, share;
    for (int64_t i = begin; i < end; ++i) {
      const Eigen::Map<const Eigen::RowVector3d> a(adjoint + 3 * i);
      share = SliceAt(slices, points_[i])
                  .cwiseProduct(a.replicate(basis_.count(), 1));
      rotation_.TurnBack(points_[i].turn, &share);
      at_pole += share;
      if (i + 1 == end || points_[i + 1].pole != points_[i].pole) {
        rotation_.FromPole(poles_[points_[i].pole], &at_pole);
        partial[chunk] += at_pole;
        at_pole.setZero();
      }
    }
  });
  for (int64_t chunk = 1; chunk < kChunks; ++chunk) {
    partial[0] += partial[chunk];
  }
  map_.Transpose(partial[0], gradient);
}

std::vector<double> HarmonicTransport::PredictLogErrors(
    const BrdfGrid& grid, const float* map) const {
  const int order = options_.order;
  std::vector<double> L_o(3 * points_.size()), errors(order + 1, 0.0);
  Render(grid, map, L_o.data());
  double mean = 0.0;
  for (const double e : L_o) mean += e / static_cast<double>(L_o.size());
  if (!(mean > 0.0)) return errors;
  const Slices slices = SlicesOf(grid);
  const HarmonicColours light = map_.Project(map);
  for (size_t i = 0; i < points_.size(); ++i) {
    const HarmonicColours S = SliceAt(slices, points_[i]);
    for (int c = 0; c < 3; ++c) {
      // A normal distribution's mean magnitude over standard deviation.
      const double scale =
          std::sqrt(2.0 / kPi) / std::max(L_o[3 * i + c], kDarkestShare * mean);
      double variance = 0.0;
      for (int l = order; l >= 0; --l) {
        errors[l] += std::log1p(scale * std::sqrt(variance)) /
                     static_cast<double>(L_o.size());
        variance += S.col(c).segment(l * l, 2 * l + 1).squaredNorm() *
                    light.col(c).segment(l * l, 2 * l + 1).squaredNorm() /
                    (2 * l + 1);
      }
    }
  }
  return errors;
}

}  // namespace ibrdf

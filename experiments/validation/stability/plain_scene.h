// The renderer's sums as plain loops, in the arithmetic of a policy: the same
// samples, weights and tables as Transport's, with fractions as they are
// (Transport rounds them to 1/65535).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "experiments/validation/stability/naive_brdf.h"
#include "experiments/validation/stability/sweep_table.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/map_sources.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace stability {

struct PreciseArithmetic {
  using Scalar = Real;
  static std::array<Real, 3> Angles(const HalfDiff& a) {
    return {a.theta_h, a.theta_d, a.phi_d};
  }
  static std::array<Real, 2> MapPlace(const Eigen::Vector3d& wi, int height,
                                      int width) {
    double row = 0.0, column = 0.0;
    MapPosition(wi, height, width, &row, &column);
    return {row, column};
  }
};

struct NaiveArithmetic {
  using Scalar = float;
  static std::array<float, 3> Angles(const HalfDiff& a) {
    Eigen::Vector3d wi, wo;
    FromHalfDiff(a, &wi, &wo);
    return NaiveHalfDiff(wi.cast<float>(), wo.cast<float>());
  }
  static std::array<float, 2> MapPlace(const Eigen::Vector3d& wi, int height,
                                       int width) {
    const Eigen::Vector3f d = wi.cast<float>();
    const float pi = static_cast<float>(M_PI);
    float phi = std::atan2(d.x(), d.z());
    if (phi < 0.0f) phi += 2.0f * pi;
    return {AngleBetween(d, Eigen::Vector3f::UnitY()) / pi *
                static_cast<float>(height),
            phi / (2.0f * pi) * static_cast<float>(width)};
  }
};

template <typename Arithmetic>
class PlainScene {
 public:
  using T = typename Arithmetic::Scalar;

  // The map is not wider than QuadratureOptions::far_width.
  PlainScene(const std::vector<ShadingPoint>& points, int map_height,
             int map_width, const TransportOptions& options)
      : grid_(options.grid),
        num_texels_(static_cast<size_t>(map_height) * map_width) {
    const PointQuadrature quadrature(MapCells(map_height, map_width, 1),
                                     options.quadrature);
    const std::vector<int> padded = PaddedTexels(map_height, map_width);
    PointSamples samples;
    for (const ShadingPoint& point : points) {
      quadrature.Sample(point.normal.cast<double>().normalized(),
                        point.wo.cast<double>().normalized(), &samples);
      for (const FarSample& s : samples.far) {
        Pair pair = Looked({s.theta_h, s.theta_d, s.phi_d});
        const T area = static_cast<T>(
            TexelSolidAngle(s.cell / map_width, map_height, map_width));
        pair.weight = static_cast<T>(s.weight) * area;
        pair.texel.fill(s.cell);
        pair.texel_share = {1, 0, 0, 0};
        pairs_.push_back(pair);
      }
      for (const NearSample& s : samples.near) {
        Pair pair = Looked({s.theta_h, s.theta_d, s.phi_d});
        pair.weight = static_cast<T>(s.weight);
        const auto place = Arithmetic::MapPlace(s.wi, map_height, map_width);
        const T half = static_cast<T>(0.5);
        const T y0 = std::floor(place[0] - half);
        const T x0 = std::floor(place[1] - half);
        const T y = place[0] - half - y0, x = place[1] - half - x0;
        const int column = (static_cast<int>(x0) + map_width) % map_width;
        const int row = static_cast<int>(y0) + 1;
        for (int k = 0; k < 4; ++k) {
          const int down = k >> 1, right = k & 1;
          pair.texel[k] =
              padded[(row + down) * (map_width + 1) + column + right];
          pair.texel_share[k] = (down ? y : 1 - y) * (right ? x : 1 - x);
        }
        pairs_.push_back(pair);
      }
      end_.push_back(pairs_.size());
    }
  }

  size_t num_points() const { return end_.size(); }
  size_t num_nodes() const { return grid_.num_nodes(); }
  size_t num_texels() const { return num_texels_; }

  // The light that a point gathers at each node [nodes][3]: its radiance is
  // sum_n f_c(n) light_nc.
  std::vector<T> Gather(size_t point, const std::vector<T>& map) const {
    std::vector<T> light(3 * num_nodes(), T(0));
    for (size_t i = Begin(point); i < end_[point]; ++i) {
      const Pair& p = pairs_[i];
      for (int c = 0; c < 3; ++c) {
        T L = 0;
        for (int k = 0; k < 4; ++k) {
          L += p.texel_share[k] * map[size_t{3} * p.texel[k] + c];
        }
        for (int k = 0; k < 8; ++k) {
          light[size_t{3} * p.node[k] + c] += p.weight * p.node_share[k] * L;
        }
      }
    }
    return light;
  }

  // What a point sees of each texel [texels] by a field [nodes]: its radiance
  // is sum_t row_t L_t.
  std::vector<T> MapRow(size_t point, const std::vector<T>& field) const {
    std::vector<T> row(num_texels_, T(0));
    for (size_t i = Begin(point); i < end_[point]; ++i) {
      const Pair& p = pairs_[i];
      T f = 0;
      for (int k = 0; k < 8; ++k) f += p.node_share[k] * field[p.node[k]];
      for (int k = 0; k < 4; ++k) {
        row[p.texel[k]] += p.weight * f * p.texel_share[k];
      }
    }
    return row;
  }

 private:
  struct Pair {
    std::array<int32_t, 8> node;
    std::array<T, 8> node_share;
    std::array<int32_t, 4> texel;
    std::array<T, 4> texel_share;
    T weight;
  };

  size_t Begin(size_t point) const { return point == 0 ? 0 : end_[point - 1]; }

  // With nodes and their shares.
  Pair Looked(const HalfDiff& angles) const {
    const std::array<T, 3> a = Arithmetic::Angles(angles);
    const T pi = static_cast<T>(3.14159265358979323846L);
    // See ThetaHBound and ToUnitCube.
    const T bound = std::atan2(std::max(std::cos(a[1]), T(0)),
                               std::sin(a[1]) * std::abs(std::cos(a[2])));
    const T ratio = bound > 0 ? std::clamp(a[0] / bound, T(0), T(1)) : T(0);
    const T h = std::sqrt(ratio) * static_cast<T>(grid_.h - 1);
    const T d =
        std::clamp(a[1] / (pi / 2), T(0), T(1)) * static_cast<T>(grid_.d - 1);
    const T p = a[2] / pi * static_cast<T>(grid_.p);
    const int ih = std::min(static_cast<int>(h), grid_.h - 2);
    const int id = std::min(static_cast<int>(d), grid_.d - 2);
    const int ip = std::min(static_cast<int>(p), grid_.p - 1);
    const T fh = h - static_cast<T>(ih), fd = d - static_cast<T>(id),
            fp = p - static_cast<T>(ip);
    Pair pair{};
    for (int k = 0; k < 8; ++k) {
      const int up = k >> 2, far = (k >> 1) & 1, on = k & 1;
      pair.node[k] = grid_.Node(ih + up, id + far, (ip + on) % grid_.p);
      pair.node_share[k] =
          (up ? fh : 1 - fh) * (far ? fd : 1 - fd) * (on ? fp : 1 - fp);
    }
    return pair;
  }

  const BrdfGridShape grid_;
  const size_t num_texels_;
  std::vector<Pair> pairs_;
  std::vector<size_t> end_;
};

}  // namespace stability
}  // namespace ibrdf

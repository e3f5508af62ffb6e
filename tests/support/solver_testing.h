// A small scene and numeric derivatives shared by the solvers' tests.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/light/illumination_unet.h"
#include "ibrdf/solvers/illumination/illumination_model.h"
#include "ibrdf/transport/transport.h"
#include "tests/support/render_testing.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace testing {

inline TransportOptions TinyTransportOptions() {
  TransportOptions options;
  options.quadrature.near_rings = 6;
  options.quadrature.near_ring_samples = 16;
  options.grid.h = 12;
  options.grid.d = 8;
  options.grid.p = 6;
  options.num_threads = 1;
  return options;
}

inline IlluminationUnetOptions TinyUnetOptions() {
  IlluminationUnetOptions options;
  options.width = 16;
  options.height = 8;
  options.scales = 2;
  options.channels = 4;
  options.skip_channels = 2;
  options.noise_channels = 2;
  options.num_threads = 1;
  return options;
}

// Two lobes of a tiny model: different codes inside the ball, colours of a
// mid-grey surface.
inline std::vector<double> TinyLobes() {
  return {0.3,  -0.4, 0.2, 0.1,  4.0, 4.3, 3.8,
          -0.5, 0.1,  0.3, -0.2, 3.0, 2.5, 3.3};
}

// L_o [points][3] of TinyLobes under a map, tables of TinyTransportOptions and
// the default quadrature.
inline std::vector<double> RenderTinyLobes(
    const NeuralBrdfModel& model, const std::vector<ShadingPoint>& points,
    const Image& map) {
  TransportOptions options;
  options.grid = TinyTransportOptions().grid;
  options.num_threads = 1;
  std::vector<double> L_o(3 * points.size());
  Transport(points, map.height, map.width, options)
      .Render(FlowLobes(model, 2, options.grid, 1).Grid(TinyLobes().data()),
              map.rgb.data(), L_o.data());
  return L_o;
}

// d log map / d parameters [outputs][parameters] of a linear model, by unit
// vectors.
inline Eigen::MatrixXd JacobianOf(IlluminationModel* model) {
  const int n = model->num_parameters(), m = model->num_outputs();
  Eigen::MatrixXd jacobian(m, n);
  std::vector<float> unit(n, 0.0f);
  LogMap column;
  for (int i = 0; i < n; ++i) {
    unit[i] = 1.0f;
    model->Jvp(unit.data(), &column);
    unit[i] = 0.0f;
    jacobian.col(i) =
        Eigen::Map<const Eigen::VectorXf>(column.data(), m).cast<double>();
  }
  return jacobian;
}

// A sphere of some 20 points under a map of 16x8, two lobes of a smooth random
// model.
struct TinyScene {
  const std::vector<ShadingPoint> points = SpherePoints(5);
  const Transport transport{points, 8, 16, TinyTransportOptions()};
  const NeuralBrdfModel model = SmoothTinyModel(2);
  const FlowLobes lobes{model, 2, TinyTransportOptions().grid, 1};

  std::vector<double> Parameters() const { return TinyLobes(); }
  // L_o of the parameters under a map.
  std::vector<double> Render(const std::vector<double>& parameters,
                             const std::vector<float>& map) const {
    std::vector<double> L_o(3 * points.size());
    transport.Render(lobes.Grid(parameters.data()), map.data(), L_o.data());
    return L_o;
  }
};

using VectorFunction = std::function<std::vector<double>(double)>;

// d f / d t at 0 by Ridders' method: central differences of halved steps from
// `step` on, extrapolated to step 0; of the tableau's entries the one that its
// neighbours confirm best, so that neither truncation nor the rounding of the
// float kernels rules.
inline std::vector<double> Differentiate(const VectorFunction& f, double step,
                                         int halvings = 5) {
  const auto central = [&](double h) {
    std::vector<double> up = f(h);
    const std::vector<double> down = f(-h);
    for (size_t i = 0; i < up.size(); ++i) up[i] = (up[i] - down[i]) / (2 * h);
    return up;
  };
  const auto distance = [](const std::vector<double>& a,
                           const std::vector<double>& b) {
    double most = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
      most = std::max(most, std::abs(a[i] - b[i]));
    }
    return most;
  };
  std::vector<std::vector<double>> before{central(step)};
  std::vector<double> best = before[0];
  double least = std::numeric_limits<double>::infinity();
  for (int n = 1; n <= halvings; ++n) {
    std::vector<std::vector<double>> row{central(step * std::pow(0.5, n))};
    double factor = 1.0;
    for (int m = 1; m <= n; ++m) {
      factor *= 4.0;
      std::vector<double> next(row[0].size());
      for (size_t i = 0; i < next.size(); ++i) {
        next[i] =
            row[m - 1][i] + (row[m - 1][i] - before[m - 1][i]) / (factor - 1.0);
      }
      const double error =
          std::max(distance(next, row[m - 1]), distance(next, before[m - 1]));
      if (error < least) {
        least = error;
        best = next;
      }
      row.push_back(std::move(next));
    }
    before = std::move(row);
  }
  return best;
}

inline double Norm(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

}  // namespace testing
}  // namespace ibrdf

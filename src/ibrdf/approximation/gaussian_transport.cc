#include "ibrdf/approximation/gaussian_transport.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/fast_atan2.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/scene/view_angles.h"

namespace ibrdf {
namespace {
using namespace view_angles;  // NOLINT

constexpr int kMostRows = 80;
// Tables bend as a Gaussian so much sharper does: by the cosine.
constexpr double kCosineSharpness = 8.0;
// Exponent of a Gaussian at the horizon below which nothing is left of it.
constexpr double kBelowHorizon = 12.0;
// Nodes and weights of Gauss and Laguerre in sharpness (1 - cosine), each with
// so many directions around the axis.
constexpr double kLaguerreNode[] = {0.58578643762690495, 3.4142135623730950};
constexpr double kLaguerreWeight[] = {0.85355339059327376, 0.14644660940672624};
constexpr int kSpokes = 5;

}  // namespace

// Axes of ViewFrame and n, and the view angle between tables.
struct GaussianTransport::Frame {
  Eigen::Vector3d t, b, n;
  Eigen::Vector3d wo;  // in this frame
  int first_view;
  float view_weight[4];
};

GaussianTransport::GaussianTransport(std::vector<SphericalGaussian> lobes,
                                     const GaussianOptions& options)
    : options_(options), lobes_(std::move(lobes)) {
  CHECK_GE(options.view_angles, 4);
  CHECK_GE(options.broad, 8.0);
  for (int k = 0; k < num_lobes(); ++k) {
    CHECK(std::isfinite(lobes_[k].sharpness) && lobes_[k].sharpness >= 0.0);
    if (lobes_[k].sharpness <= options.broad) {
      broad_.push_back(k);
      level_of_.push_back(LevelFor(lobes_[k].sharpness));
    } else {
      AddRays(k);
    }
  }
  if (!levels_.empty()) SampleViews();
}

int GaussianTransport::LevelFor(double sharpness) {
  int level = 0;
  while (level < num_tables() && levels_[level].sharpness != sharpness) {
    ++level;
  }
  if (level == num_tables()) {
    const int rows = std::min(
        static_cast<int>(std::ceil(options_.axis_steps *
                                   std::sqrt(kCosineSharpness + sharpness))),
        kMostRows);
    levels_.push_back({sharpness, rows, 2 * rows});
  }
  return level;
}

void GaussianTransport::AddRays(int lobe) {
  const Eigen::Vector3d& axis = lobes_[lobe].axis;
  const double sharpness = lobes_[lobe].sharpness;
  const Eigen::Vector3d t = axis.unitOrthogonal();
  const Eigen::Vector3d b = axis.cross(t);
  for (int ring = 0; ring < 2; ++ring) {
    const double cosine = std::max(1.0 - kLaguerreNode[ring] / sharpness, -1.0);
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double phi = 2.0 * kPi * (spoke + 0.5 * ring) / kSpokes;
      rays_.push_back(
          {cosine * axis + sine * (std::cos(phi) * t + std::sin(phi) * b),
           kLaguerreWeight[ring] * GaussianIntegral(sharpness) / kSpokes,
           lobe});
    }
  }
}

void GaussianTransport::SampleViews() {
  const int far_rows = options_.quadrature.far_width / 2;
  const std::vector<FarCell> cells =
      MapCells(far_rows, options_.quadrature.far_width, 1);
  // The map's pole is the normal, so that the horizon is an edge of cells.
  const auto local = [](const Eigen::Vector3d& w) {
    return Eigen::Vector3f(w.cast<float>()[2], w.cast<float>()[0],
                           w.cast<float>()[1]);
  };
  // None below it count.
  const size_t above =
      size_t{1} * ((far_rows + 1) / 2) * options_.quadrature.far_width;
  far_directions_.resize(3, static_cast<Eigen::Index>(above));
  for (size_t k = 0; k < above; ++k) {
    far_directions_.col(static_cast<Eigen::Index>(k)) =
        local(cells[k].direction);
  }
  const PointQuadrature quadrature(cells, options_.quadrature);
  views_.resize(options_.view_angles);
  const double step = MaxViewAngle() / (options_.view_angles - 1);
  ParallelFor(options_.view_angles, options_.num_threads, [&](int64_t v, int) {
    const double angle = static_cast<double>(v) * step;
    PointSamples samples;
    quadrature.Sample(Eigen::Vector3d::UnitY(),
                      {0.0, std::cos(angle), std::sin(angle)}, &samples);
    View& view = views_[v];
    view.near_directions.resize(3,
                                static_cast<Eigen::Index>(samples.near.size()));
    for (const NearSample& s : samples.near) {
      view.near_directions.col(static_cast<Eigen::Index>(view.near.size())) =
          local(s.wi);
      view.near.push_back({s.theta_h, s.theta_d, s.phi_d, s.weight});
    }
    for (const FarSample& s : samples.far) {
      CHECK_LT(s.cell, far_directions_.cols());
      view.cells.push_back(s.cell);
      view.far.push_back({s.theta_h, s.theta_d, s.phi_d,
                          s.weight * cells[s.cell].solid_angle});
    }
  });
}

Eigen::MatrixXf GaussianTransport::RowOfGaussians(
    const Level& level, int row, const Eigen::Matrix3Xf& directions) {
  const double theta = kPi * row / level.rows;
  Eigen::MatrixX3f axes(level.columns, 3);
  for (int c = 0; c < level.columns; ++c) {
    const double phi = 2.0 * kPi * c / level.columns;
    axes.row(c) << static_cast<float>(std::sin(theta) * std::cos(phi)),
        static_cast<float>(std::sin(theta) * std::sin(phi)),
        static_cast<float>(std::cos(theta));
  }
  const Eigen::MatrixXf cosines = axes * directions;
  // Products that are denormal numbers are slow: none is, from here on.
  return (static_cast<float>(level.sharpness) * (cosines.array() - 1.0f))
      .max(-60.0f)
      .exp()
      .matrix();
}

void GaussianTransport::TabulateLevels(
    const Eigen::MatrixXf& far, const std::vector<Eigen::MatrixX3f>& near,
    Tables* tables) const {
  const int views = options_.view_angles;
  for (const Level& level : levels_) {
    std::vector<float> table(TableSize(level), 0.0f);
    ParallelFor(level.rows + 1, options_.num_threads, [&](int64_t row, int) {
      const int r = static_cast<int>(row);
      Eigen::MatrixXf T = RowOfGaussians(level, r, far_directions_) * far;
      for (int v = 0; v < views; ++v) {
        T.middleCols<3>(3 * v) +=
            RowOfGaussians(level, r, views_[v].near_directions) * near[v];
      }
      float* out = &table[size_t{4} * r * level.columns * views];
      for (int c = 0; c < level.columns; ++c) {
        for (int v = 0; v < views; ++v, out += 4) {
          for (int k = 0; k < 3; ++k) out[k] = T(c, 3 * v + k);
        }
      }
    });
    tables->levels.push_back(std::move(table));
  }
}

GaussianTransport::Tables GaussianTransport::Tabulate(
    const BrdfFunction& brdf) const {
  Tables tables;
  tables.brdf = brdf;
  if (levels_.empty()) return tables;
  const int views = options_.view_angles;
  Eigen::MatrixXf far =
      Eigen::MatrixXf::Zero(far_directions_.cols(), Eigen::Index{3} * views);
  std::vector<Eigen::MatrixX3f> near(views);
  ParallelFor(views, options_.num_threads, [&](int64_t v, int) {
    const View& view = views_[v];
    const auto value = [&](const Sample& s) {
      return (s.weight * brdf(s.theta_h, s.theta_d, s.phi_d))
          .cast<float>()
          .matrix()
          .transpose()
          .eval();
    };
    near[v].resize(static_cast<Eigen::Index>(view.near.size()), 3);
    for (size_t k = 0; k < view.near.size(); ++k) {
      near[v].row(static_cast<Eigen::Index>(k)) = value(view.near[k]);
    }
    for (size_t k = 0; k < view.far.size(); ++k) {
      far.block<1, 3>(view.cells[k], 3 * v) = value(view.far[k]);
    }
  });
  TabulateLevels(far, near, &tables);
  return tables;
}

GaussianTransport::Tables GaussianTransport::Tabulate(
    const BrdfGrid& grid) const {
  CHECK(grid.shape == options_.grid);
  return Tabulate([&grid](double theta_h, double theta_d, double phi_d) {
    return grid.Evaluate(theta_h, theta_d, phi_d);
  });
}

GaussianTransport::Frame GaussianTransport::FrameOf(
    const ShadingPoint& point) const {
  Frame frame{};
  frame.n = point.normal.cast<double>().normalized();
  const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
  ViewFrame(frame.n, wo, &frame.t, &frame.b);
  const double sine = std::max(wo.dot(frame.t), 0.0);
  const double cosine = std::max(frame.n.dot(wo), double{kMinViewCosine});
  frame.wo = Eigen::Vector3d(sine, 0.0, cosine).normalized();
  const double at = std::min(std::atan2(sine, cosine), MaxViewAngle()) /
                    MaxViewAngle() * (options_.view_angles - 1);
  frame.first_view =
      std::clamp(static_cast<int>(at) - 1, 0, options_.view_angles - 4);
  CubicWeights(at - frame.first_view, frame.view_weight);
  return frame;
}

bool GaussianTransport::TapsOf(const Frame& frame, int lobe, Taps* taps) const {
  const Level& level = levels_[level_of_[lobe]];
  const Eigen::Vector3d& axis = lobes_[broad_[lobe]].axis;
  const double z = axis.dot(frame.n);
  if (z < 0.0 && 0.5 * level.sharpness * z * z > kBelowHorizon) return false;
  const double x = axis.dot(frame.t), y = axis.dot(frame.b);
  const double theta = FastAtan2(std::sqrt(x * x + y * y), z);
  const double row = theta * (level.rows / kPi);
  const int r = std::clamp(static_cast<int>(row), 0, level.rows - 1);
  const float fr = static_cast<float>(row) - static_cast<float>(r);
  double column = FastAtan2(y, x) * (level.columns / (2.0 * kPi));
  if (column < 0.0) column += level.columns;
  const int whole = static_cast<int>(column);
  const float fc = static_cast<float>(column) - static_cast<float>(whole);
  const int c = whole % level.columns;
  const int next = (c + 1) % level.columns;
  const auto offset = [&](int at_row, int at_column) {
    return size_t{4} * ((size_t{1} * at_row * level.columns + at_column) *
                            options_.view_angles +
                        frame.first_view);
  };
  *taps = {
      {offset(r, c), offset(r, next), offset(r + 1, c), offset(r + 1, next)},
      {(1 - fr) * (1 - fc), (1 - fr) * fc, fr * (1 - fc), fr * fc}};
  return true;
}

template <typename Use>
void GaussianTransport::ForRays(const Frame& frame, const Use& use) const {
  for (const Ray& ray : rays_) {
    const double cosine = ray.wi.dot(frame.n);
    if (cosine <= 0.0) continue;
    const HalfDiff angles = ToHalfDiff(
        {ray.wi.dot(frame.t), ray.wi.dot(frame.b), cosine}, frame.wo);
    use(angles.theta_h, angles.theta_d, angles.phi_d, cosine * ray.weight,
        ray.lobe);
  }
}

void GaussianTransport::Render(const std::vector<ShadingPoint>& points,
                               const Tables& tables,
                               const GaussianColours& amplitudes,
                               double* L_o) const {
  CHECK_EQ(amplitudes.rows(), num_lobes());
  CHECK_EQ(tables.levels.size(), levels_.size());
  using Vector4 = Eigen::Array4f;
  std::vector<Vector4> colours(broad_.size(), Vector4::Zero());
  for (size_t k = 0; k < broad_.size(); ++k) {
    colours[k].head<3>() =
        amplitudes.row(broad_[k]).transpose().array().cast<float>();
  }
  ParallelFor(kChunks, options_.num_threads, [&](int64_t chunk, int) {
    const int64_t end = ChunkBegin(chunk + 1, points.size());
    for (int64_t i = ChunkBegin(chunk, points.size()); i < end; ++i) {
      const Frame frame = FrameOf(points[i]);
      const Vector4 w0 = Vector4::Constant(frame.view_weight[0]);
      const Vector4 w1 = Vector4::Constant(frame.view_weight[1]);
      const Vector4 w2 = Vector4::Constant(frame.view_weight[2]);
      const Vector4 w3 = Vector4::Constant(frame.view_weight[3]);
      Vector4 broad = Vector4::Zero();
      for (size_t k = 0; k < broad_.size(); ++k) {
        Taps taps;
        if (!TapsOf(frame, static_cast<int>(k), &taps)) continue;
        const float* const table = tables.levels[level_of_[k]].data();
        Vector4 T = Vector4::Zero();
        for (int j = 0; j < 4; ++j) {
          const Eigen::Map<const Eigen::Array<float, 4, 4>> views(
              table + taps.offset[j]);
          T += taps.weight[j] * (w0 * views.col(0) + w1 * views.col(1) +
                                 w2 * views.col(2) + w3 * views.col(3));
        }
        broad += colours[k] * T;
      }
      Eigen::Array3d sum = broad.head<3>().cast<double>();
      ForRays(frame, [&](double theta_h, double theta_d, double phi_d,
                         double weight, int lobe) {
        sum += weight * tables.brdf(theta_h, theta_d, phi_d) *
               amplitudes.row(lobe).transpose().array();
      });
      for (int c = 0; c < 3; ++c) L_o[3 * i + c] = sum[c];
    }
  });
}

// The gradient in what Render reads: entries of the tables and, by nodes of
// the grid, what sharp lobes reflect.
struct GaussianTransport::GradientSums {
  std::vector<std::vector<double>> by_entry;  // by level, as Tables
  std::vector<double> by_node;                // [3, nodes]

  void Add(const GradientSums& other) {
    for (size_t k = 0; k < by_node.size(); ++k) by_node[k] += other.by_node[k];
    for (size_t l = 0; l < by_entry.size(); ++l) {
      for (size_t k = 0; k < by_entry[l].size(); ++k) {
        by_entry[l][k] += other.by_entry[l][k];
      }
    }
  }
};

void GaussianTransport::GridGradient(const std::vector<ShadingPoint>& points,
                                     const GaussianColours& amplitudes,
                                     const double* adjoint,
                                     float* gradient) const {
  CHECK_EQ(amplitudes.rows(), num_lobes());
  std::vector<GradientSums> partial(kChunks);
  ParallelFor(kChunks, options_.num_threads, [&](int64_t chunk, int) {
    GradientSums& sums = partial[chunk];
    for (const Level& level : levels_) {
      sums.by_entry.emplace_back(TableSize(level), 0.0);
    }
    sums.by_node.assign(size_t{3} * options_.grid.num_nodes(), 0.0);
    const int64_t end = ChunkBegin(chunk + 1, points.size());
    for (int64_t i = ChunkBegin(chunk, points.size()); i < end; ++i) {
      AddPointGradient(FrameOf(points[i]), amplitudes, adjoint + 3 * i, &sums);
    }
  });
  for (int64_t chunk = 1; chunk < kChunks; ++chunk) {
    partial[0].Add(partial[chunk]);
  }
  std::vector<double>& by_node = partial[0].by_node;
  AddTableGradient(partial[0].by_entry, &by_node);
  for (size_t k = 0; k < by_node.size(); ++k) {
    gradient[k] = static_cast<float>(by_node[k]);
  }
}

void GaussianTransport::AddPointGradient(const Frame& frame,
                                         const GaussianColours& amplitudes,
                                         const double* adjoint,
                                         GradientSums* sums) const {
  const Eigen::Map<const Eigen::Vector3d> a(adjoint);
  for (size_t k = 0; k < broad_.size(); ++k) {
    Taps taps;
    if (!TapsOf(frame, static_cast<int>(k), &taps)) continue;
    const Eigen::Vector3d share =
        amplitudes.row(broad_[k]).transpose().cwiseProduct(a);
    double* const table = sums->by_entry[level_of_[k]].data();
    for (int j = 0; j < 4; ++j) {
      for (int v = 0; v < 4; ++v) {
        const double w = double{taps.weight[j]} * frame.view_weight[v];
        for (int c = 0; c < 3; ++c) {
          table[taps.offset[j] + 4 * v + c] += w * share[c];
        }
      }
    }
  }
  ForRays(frame, [&](double theta_h, double theta_d, double phi_d,
                     double weight, int lobe) {
    AddToNodes({theta_h, theta_d, phi_d, weight},
               amplitudes.row(lobe).transpose().cwiseProduct(a),
               &sums->by_node);
  });
}

void GaussianTransport::AddToNodes(const Sample& sample,
                                   const Eigen::Vector3d& share,
                                   std::vector<double>* by_node) const {
  const size_t nodes = options_.grid.num_nodes();
  const BrdfGridTaps taps = GridTaps(
      options_.grid, ToUnitCube(sample.theta_h, sample.theta_d, sample.phi_d));
  for (int c = 0; c < 3; ++c) {
    for (int j = 0; j < 8; ++j) {
      (*by_node)[c * nodes + taps.node[j]] +=
          taps.weight[j] * (sample.weight * share[c]);
    }
  }
}

void GaussianTransport::AddTableGradient(
    const std::vector<std::vector<double>>& by_entry,
    std::vector<double>* by_node) const {
  std::vector<Eigen::MatrixX3d> near(views_.size()), far(views_.size());
  ParallelFor(static_cast<int64_t>(views_.size()), options_.num_threads,
              [&](int64_t v, int) {
                ToDirections(by_entry, static_cast<int>(v), &near[v], &far[v]);
              });
  for (size_t v = 0; v < views_.size(); ++v) {
    const View& view = views_[v];
    for (size_t k = 0; k < view.near.size(); ++k) {
      AddToNodes(view.near[k], near[v].row(static_cast<Eigen::Index>(k)),
                 by_node);
    }
    for (size_t k = 0; k < view.far.size(); ++k) {
      AddToNodes(view.far[k], far[v].row(view.cells[k]), by_node);
    }
  }
}

void GaussianTransport::ToDirections(
    const std::vector<std::vector<double>>& by_entry, int v,
    Eigen::MatrixX3d* near, Eigen::MatrixX3d* far) const {
  const View& view = views_[v];
  near->setZero(static_cast<Eigen::Index>(view.near.size()), 3);
  far->setZero(far_directions_.cols(), 3);
  for (size_t l = 0; l < levels_.size(); ++l) {
    const Level& level = levels_[l];
    for (int r = 0; r <= level.rows; ++r) {
      Eigen::MatrixX3d row(level.columns, 3);
      for (int c = 0; c < level.columns; ++c) {
        row.row(c) = Eigen::Map<const Eigen::RowVector3d>(
            &by_entry[l][size_t{4} * ((size_t{1} * r * level.columns + c) *
                                          options_.view_angles +
                                      v)]);
      }
      if (row.isZero(0.0)) continue;
      near->noalias() += RowOfGaussians(level, r, view.near_directions)
                             .transpose()
                             .cast<double>() *
                         row;
      far->noalias() +=
          RowOfGaussians(level, r, far_directions_).transpose().cast<double>() *
          row;
    }
  }
}

GaussianColours GaussianTransport::AmplitudeGradient(
    const std::vector<ShadingPoint>& points, const Tables& tables,
    const double* adjoint) const {
  CHECK_EQ(tables.levels.size(), levels_.size());
  std::vector<GaussianColours> partial(kChunks);
  ParallelFor(kChunks, options_.num_threads, [&](int64_t chunk, int) {
    GaussianColours& sum = partial[chunk];
    sum = GaussianColours::Zero(num_lobes(), 3);
    const int64_t end = ChunkBegin(chunk + 1, points.size());
    for (int64_t i = ChunkBegin(chunk, points.size()); i < end; ++i) {
      const Frame frame = FrameOf(points[i]);
      const Eigen::Map<const Eigen::Array3d> a(adjoint + 3 * i);
      for (size_t k = 0; k < broad_.size(); ++k) {
        Taps taps;
        if (!TapsOf(frame, static_cast<int>(k), &taps)) continue;
        const float* const table = tables.levels[level_of_[k]].data();
        Eigen::Array3d T = Eigen::Array3d::Zero();
        for (int j = 0; j < 4; ++j) {
          for (int v = 0; v < 4; ++v) {
            const Eigen::Map<const Eigen::Array3f> entry(
                table + taps.offset[j] + size_t{4} * v);
            T += double{taps.weight[j]} * frame.view_weight[v] *
                 entry.cast<double>();
          }
        }
        sum.row(broad_[k]) += (a * T).matrix().transpose();
      }
      ForRays(frame, [&](double theta_h, double theta_d, double phi_d,
                         double weight, int lobe) {
        sum.row(lobe) += (weight * a * tables.brdf(theta_h, theta_d, phi_d))
                             .matrix()
                             .transpose();
      });
    }
  });
  for (int64_t chunk = 1; chunk < kChunks; ++chunk) {
    partial[0] += partial[chunk];
  }
  return partial[0];
}

}  // namespace ibrdf

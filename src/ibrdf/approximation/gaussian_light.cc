#include "ibrdf/approximation/gaussian_light.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

// A texel belongs to a spot where it is brighter than this times what surrounds
// the spot.
constexpr double kAbove = 2.0;
// Surroundings reach so many radii of the spot.
constexpr double kSurroundings = 1.5;
constexpr double kMostSharp = 1e6;
constexpr int kTriesEach = 4;  // bright places looked at for a spot wanted

// Evenly spread directions (a Fibonacci lattice).
std::vector<Eigen::Vector3d> SpreadAxes(int count) {
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> axes;
  for (int k = 0; k < count; ++k) {
    const double y = 1.0 - (2.0 * k + 1.0) / count;
    const double sine = std::sqrt(std::max(1.0 - y * y, 0.0));
    axes.emplace_back(sine * std::sin(golden * k), y,
                      sine * std::cos(golden * k));
  }
  return axes;
}

double MeanOfChannels(const float* rgb) {
  return (double{rgb[0]} + rgb[1] + rgb[2]) / 3.0;
}

// Edges of n equal parts of [0, end].
std::vector<double> Edges(int n, double end) {
  std::vector<double> edges(n + 1);
  for (int k = 0; k <= n; ++k) edges[k] = end * k / n;
  return edges;
}

// Edges of latitudes, as what solid angle is proportional to.
std::vector<double> HeightEdges(int n) {
  std::vector<double> edges = Edges(n, kPi);
  for (double& e : edges) e = 1.0 - std::cos(e);
  return edges;
}

}  // namespace

double GaussianIntegral(double sharpness) {
  // expm1 has no cancellation; its quotient does not exist at 0.
  return sharpness < 1e-12
             ? 4.0 * kPi
             : -2.0 * kPi * std::expm1(-2.0 * sharpness) / sharpness;
}

GaussianLight::GaussianLight(const Image& map,
                             const GaussianFitOptions& options)
    : height_(map.height),
      width_(map.width),
      rows_(options.fit_height),
      columns_(2 * options.fit_height) {
  CHECK(map.height > 0 && map.width > 0 && options.spread > 0 &&
        options.fit_height > 0);
  lobes_.push_back({Eigen::Vector3d::UnitY(), 0.0});
  for (const Eigen::Vector3d& axis : SpreadAxes(options.spread)) {
    lobes_.push_back({axis, options.sharpness_each * options.spread});
  }
  num_spread_ = count();
  by_row_ = Overlaps(HeightEdges(rows_), HeightEdges(height_));
  by_column_ = Overlaps(Edges(columns_, 1.0), Edges(width_, 1.0));
  FindSpots(map, options);
  PrepareFit(options.ridge);
}

std::vector<GaussianLight::Overlap> GaussianLight::Overlaps(
    const std::vector<double>& cells, const std::vector<double>& lines) {
  std::vector<Overlap> out;
  size_t line = 0;
  for (size_t cell = 0; cell + 1 < cells.size(); ++cell) {
    while (line > 0 && lines[line] > cells[cell]) --line;
    for (; line + 1 < lines.size() && lines[line] < cells[cell + 1]; ++line) {
      const double shared = std::min(lines[line + 1], cells[cell + 1]) -
                            std::max(lines[line], cells[cell]);
      if (shared <= 0.0) continue;
      out.push_back({static_cast<int>(cell), static_cast<int>(line),
                     shared / (cells[cell + 1] - cells[cell])});
    }
  }
  return out;
}

// What FindSpots has not taken yet.
struct GaussianLight::SpotSearch {
  double radius, reach;       // of a spot and of its surroundings, radians
  std::vector<double> level;  // mean radiance of each texel
  std::vector<char> done;     // texels that are no peak any more
  double flux = 0.0;

  // The brightest texel; -1: none is left.
  int Peak() const {
    int peak = -1;
    for (int t = 0; t < static_cast<int>(level.size()); ++t) {
      if (done[t] == 0 && (peak < 0 || level[t] > level[peak])) peak = t;
    }
    return peak;
  }
};

void GaussianLight::FindSpots(const Image& map,
                              const GaussianFitOptions& options) {
  SpotSearch search;
  search.radius = options.peak_radius_degrees * kPi / 180.0;
  search.reach = std::min(kSurroundings * search.radius, kPi);
  const auto texels = static_cast<int>(map.num_pixels());
  search.done.resize(texels, 0);
  for (int t = 0; t < texels; ++t) {
    search.level.push_back(MeanOfChannels(&map.rgb[size_t{3} * t]));
    search.flux += search.level[t] * Area(t);
  }
  const double least = options.least_flux * search.flux;
  const int tries = kTriesEach * options.most_peaks;
  for (int k = 0; k < tries && num_peaks() < options.most_peaks; ++k) {
    const int peak = search.Peak();
    if (peak < 0 ||
        !(search.level[peak] > options.contrast * search.flux / (4.0 * kPi))) {
      return;
    }
    double background = 0.0;
    const std::vector<SpotTexel> spot = SpotAround(search, peak, &background);
    double flux = 0.0;
    for (const SpotTexel& s : spot) {
      flux += s.share * search.level[s.texel] * Area(s.texel);
    }
    search.done[peak] = 1;
    if (flux < least || spot.empty()) continue;
    AddSpot(map, spot);
    search.flux -= flux;
    for (const SpotTexel& s : spot) {
      search.done[s.texel] = 1;
      search.level[s.texel] = background;
    }
  }
}

double GaussianLight::Area(int texel) const {
  return TexelSolidAngle(texel / width_, height_, width_);
}

std::vector<GaussianLight::SpotTexel> GaussianLight::SpotAround(
    const SpotSearch& search, int peak, double* background) const {
  const double spot_cosine = std::cos(search.radius);
  const double reach_cosine = std::cos(search.reach);
  const int row = peak / width_;
  const Eigen::Vector3d centre =
      MapDirection(row + 0.5, peak % width_ + 0.5, height_, width_);
  const int near_rows = static_cast<int>(search.reach / kPi * height_) + 1;
  std::vector<int> inside;
  double around = 0.0, around_area = 0.0;
  for (int r = std::max(row - near_rows, 0);
       r <= std::min(row + near_rows, height_ - 1); ++r) {
    const double area = TexelSolidAngle(r, height_, width_);
    for (int c = 0; c < width_; ++c) {
      const double cosine =
          centre.dot(MapDirection(r + 0.5, c + 0.5, height_, width_));
      const int t = r * width_ + c;
      if (t == peak || cosine >= spot_cosine) {
        if (search.done[t] == 0) inside.push_back(t);
      } else if (cosine >= reach_cosine) {
        around += area * search.level[t];
        around_area += area;
      }
    }
  }
  *background = around_area > 0.0 ? around / around_area : 0.0;
  std::vector<SpotTexel> spot;
  for (const int t : inside) {
    if (!(search.level[t] > kAbove * *background)) continue;
    spot.push_back({t, count(), 1.0 - *background / search.level[t]});
  }
  return spot;
}

void GaussianLight::AddSpot(const Image& map,
                            const std::vector<SpotTexel>& texels) {
  // Resultant of the spot's directions over its flux; texels have an extent of
  // their own.
  Eigen::Vector3d resultant = Eigen::Vector3d::Zero();
  double flux = 0.0;
  for (const SpotTexel& s : texels) {
    const int row = s.texel / width_;
    const Eigen::Vector3d direction =
        MapDirection(row + 0.5, s.texel % width_ + 0.5, height_, width_);
    const double area = TexelSolidAngle(row, height_, width_);
    const double power =
        s.share * area * MeanOfChannels(&map.rgb[size_t{3} * s.texel]);
    const double high = kPi / height_, wide = area / high;
    resultant += power * (1.0 - (high * high + wide * wide) / 24.0) * direction;
    flux += power;
  }
  // The mean of a sharp Gaussian's directions is 1 - 1/lambda long.
  const double spread = 1.0 - resultant.norm() / flux;
  lobes_.push_back(
      {resultant.normalized(), 1.0 / std::max(spread, 1.0 / kMostSharp)});
  spots_.insert(spots_.end(), texels.begin(), texels.end());
}

void GaussianLight::PrepareFit(double ridge) {
  const int cells = rows_ * columns_;
  solid_angle_.resize(cells);
  basis_.resize(cells, num_spread_);
  // Means over cells by the products of two points of Gauss and Legendre.
  const double node = 0.5 / std::sqrt(3.0);
  for (int cell = 0; cell < cells; ++cell) {
    const int r = cell / columns_, c = cell % columns_;
    solid_angle_[cell] = TexelSolidAngle(r, rows_, columns_);
    Eigen::Matrix<double, 3, 4> directions;
    for (int k = 0; k < 4; ++k) {
      directions.col(k) =
          MapDirection(r + 0.5 + (k < 2 ? -node : node),
                       c + 0.5 + (k % 2 == 0 ? -node : node), rows_, columns_);
    }
    for (int k = 0; k < num_spread_; ++k) {
      basis_(cell, k) =
          (lobes_[k].sharpness *
           ((lobes_[k].axis.transpose() * directions).array() - 1.0))
              .exp()
              .mean();
    }
  }
  Eigen::MatrixXd normal =
      basis_.transpose() * solid_angle_.asDiagonal() * basis_;
  // The constant is free.
  normal.diagonal().tail(num_spread_ - 1) *= 1.0 + ridge;
  normal_.compute(normal);
  CHECK(normal_.info() == Eigen::Success);
  integrals_.resize(num_spread_);
  for (int k = 0; k < num_spread_; ++k) {
    integrals_[k] = GaussianIntegral(lobes_[k].sharpness);
  }
  solved_integrals_ = normal_.solve(integrals_);
}

GaussianLight::Cells GaussianLight::Gather(const float* map) const {
  std::vector<double> rest(map, map + size_t{3} * height_ * width_);
  for (const SpotTexel& s : spots_) {
    for (int c = 0; c < 3; ++c) rest[size_t{3} * s.texel + c] *= 1.0 - s.share;
  }
  std::vector<double> bands(size_t{3} * rows_ * width_, 0.0);
  for (const Overlap& o : by_row_) {
    for (int k = 0; k < 3 * width_; ++k) {
      bands[size_t{3} * o.cell * width_ + k] +=
          o.share * rest[size_t{3} * o.line * width_ + k];
    }
  }
  Cells cells = Cells::Zero(Eigen::Index{rows_} * columns_, 3);
  for (int r = 0; r < rows_; ++r) {
    for (const Overlap& o : by_column_) {
      for (int c = 0; c < 3; ++c) {
        cells(Eigen::Index{r} * columns_ + o.cell, c) +=
            o.share * bands[(size_t{1} * r * width_ + o.line) * 3 + c];
      }
    }
  }
  return cells;
}

void GaussianLight::Scatter(const Cells& adjoint,
                            std::vector<double>* gradient) const {
  std::vector<double> bands(size_t{3} * rows_ * width_, 0.0);
  for (int r = 0; r < rows_; ++r) {
    for (const Overlap& o : by_column_) {
      for (int c = 0; c < 3; ++c) {
        bands[(size_t{1} * r * width_ + o.line) * 3 + c] +=
            o.share * adjoint(Eigen::Index{r} * columns_ + o.cell, c);
      }
    }
  }
  gradient->assign(size_t{3} * height_ * width_, 0.0);
  for (const Overlap& o : by_row_) {
    for (int k = 0; k < 3 * width_; ++k) {
      (*gradient)[size_t{3} * o.line * width_ + k] +=
          o.share * bands[size_t{3} * o.cell * width_ + k];
    }
  }
  for (const SpotTexel& s : spots_) {
    for (int c = 0; c < 3; ++c) {
      (*gradient)[size_t{3} * s.texel + c] *= 1.0 - s.share;
    }
  }
}

GaussianColours GaussianLight::FitSpread(const Cells& cells) const {
  const Cells power = solid_angle_.asDiagonal() * cells;
  GaussianColours a = normal_.solve(basis_.transpose() * power);
  // Lagrange's multiplier of the energy.
  const Eigen::RowVector3d missing =
      power.colwise().sum() - integrals_.transpose() * a;
  a += solved_integrals_ * missing / integrals_.dot(solved_integrals_);
  return a;
}

GaussianColours GaussianLight::Fit(const float* map) const {
  GaussianColours a = GaussianColours::Zero(count(), 3);
  a.topRows(num_spread_) = FitSpread(Gather(map));
  for (const SpotTexel& s : spots_) {
    const double share = s.share *
                         TexelSolidAngle(s.texel / width_, height_, width_) /
                         GaussianIntegral(lobes_[s.lobe].sharpness);
    for (int c = 0; c < 3; ++c) {
      a(s.lobe, c) += share * map[size_t{3} * s.texel + c];
    }
  }
  return a;
}

void GaussianLight::Transpose(const GaussianColours& adjoint,
                              float* gradient) const {
  CHECK_EQ(adjoint.rows(), count());
  const GaussianColours spread = adjoint.topRows(num_spread_);
  const Eigen::RowVector3d energy = solved_integrals_.transpose() * spread /
                                    integrals_.dot(solved_integrals_);
  const GaussianColours solved =
      normal_.solve(spread) - solved_integrals_ * energy;
  Cells cells = basis_ * solved;
  cells.rowwise() += energy;
  cells = solid_angle_.asDiagonal() * cells;
  std::vector<double> sums;
  Scatter(cells, &sums);
  for (const SpotTexel& s : spots_) {
    const double share = s.share *
                         TexelSolidAngle(s.texel / width_, height_, width_) /
                         GaussianIntegral(lobes_[s.lobe].sharpness);
    for (int c = 0; c < 3; ++c) {
      sums[size_t{3} * s.texel + c] += share * adjoint(s.lobe, c);
    }
  }
  for (size_t k = 0; k < sums.size(); ++k) {
    gradient[k] = static_cast<float>(sums[k]);
  }
}

Image GaussianLight::Residual(const float* map) const {
  const Cells cells = Gather(map);
  const Cells left = cells - basis_ * FitSpread(cells);
  Image out(columns_, rows_);
  for (Eigen::Index k = 0; k < left.rows(); ++k) {
    for (int c = 0; c < 3; ++c) {
      out.rgb[3 * k + c] = static_cast<float>(left(k, c));
    }
  }
  return out;
}

}  // namespace ibrdf

#include "ibrdf/solvers/paint/albedo_fit.h"

#include <glog/logging.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ibrdf/solvers/paint/chroma_plane.h"

namespace ibrdf {
namespace {

// A pixel tells its albedo where at least this share of its radiance is matte.
constexpr double kLeastMatteShare = 0.05;
constexpr double kStudentDegrees = 3.0;
// Cells of chroma are this wide, in colour lengths; the kernel reaches so many.
constexpr double kCellWidth = 0.5;
constexpr int kReach = 6;

double Square(double x) { return x * x; }

// Log of what paint must do at a point for the image's value.
struct Apparent {
  Eigen::Array3d log_albedo = Eigen::Array3d::Zero();
  bool seen = false;
};

Apparent ApparentAlbedo(const UnpaintedRadiance& unpainted,
                        const Observations& observed, size_t point) {
  Apparent out;
  if (!observed.valid[point]) return out;
  for (int c = 0; c < 3; ++c) {
    const size_t i = 3 * point + c;
    const double I = observed.radiance[i];
    const double matte = I - unpainted.gloss[i];
    if (!(matte > kLeastMatteShare * I) || !(unpainted.matte[i] > 0.0)) {
      return out;
    }
    out.log_albedo[c] = std::log(matte / unpainted.matte[i]);
  }
  out.seen = out.log_albedo.isFinite().all();
  return out;
}

// Means of a value over points of like chroma, by cells of chroma.
class MeanByColour {
 public:
  MeanByColour(std::vector<Eigen::Array2d> chroma, double length)
      : chroma_(std::move(chroma)), width_(kCellWidth * length) {}

  // weights [points] >= 0; the mean of `values` for each point.
  std::vector<double> Of(const std::vector<double>& values,
                         const std::vector<double>& weights) const {
    std::map<std::pair<int, int>, std::pair<double, double>> cells;
    for (size_t i = 0; i < values.size(); ++i) {
      auto& cell = cells[CellOf(i)];
      cell.first += weights[i];
      cell.second += weights[i] * values[i];
    }
    std::map<std::pair<int, int>, double> means;
    std::vector<double> out;
    for (size_t i = 0; i < values.size(); ++i) {
      const auto cell = CellOf(i);
      const auto known = means.find(cell);
      out.push_back(known != means.end() ? known->second
                                         : means[cell] = Near(cells, cell));
    }
    return out;
  }

 private:
  std::pair<int, int> CellOf(size_t i) const {
    return {static_cast<int>(std::floor(chroma_[i][0] / width_)),
            static_cast<int>(std::floor(chroma_[i][1] / width_))};
  }

  static double Near(
      const std::map<std::pair<int, int>, std::pair<double, double>>& cells,
      const std::pair<int, int>& at) {
    double weight = 0.0, sum = 0.0;
    for (int x = -kReach; x <= kReach; ++x) {
      for (int y = -kReach; y <= kReach; ++y) {
        const auto cell = cells.find({at.first + x, at.second + y});
        if (cell == cells.end()) continue;
        const double k =
            std::exp(-0.5 * Square(kCellWidth) * (Square(x) + Square(y)));
        weight += k * cell->second.first;
        sum += k * cell->second.second;
      }
    }
    return weight > 0.0 ? sum / weight : 0.0;
  }

  std::vector<Eigen::Array2d> chroma_;
  double width_;
};

}  // namespace

std::vector<double> FitAlbedo(const UnpaintedRadiance& unpainted,
                              const Observations& observed,
                              const AlbedoFitOptions& options) {
  const size_t count = observed.valid.size();
  CHECK_EQ(unpainted.matte.size(), 3 * count);
  std::vector<Apparent> apparent;
  std::vector<Eigen::Array2d> chroma;
  std::vector<double> luminance, seen;
  for (size_t i = 0; i < count; ++i) {
    apparent.push_back(ApparentAlbedo(unpainted, observed, i));
    const Eigen::Array3d log_colour =
        apparent[i].seen
            ? apparent[i].log_albedo
            : Eigen::Map<const Eigen::Array3d>(&observed.radiance[3 * i])
                  .max(1e-30)
                  .min(1e30)
                  .log();
    chroma.push_back(ChromaPlane(log_colour));
    luminance.push_back(apparent[i].seen ? apparent[i].log_albedo.mean() : 0.0);
    seen.push_back(apparent[i].seen ? 1.0 : 0.0);
  }
  const MeanByColour mean(chroma, options.prior.colour_length);
  std::vector<double> weights = seen, of_colour;
  for (int k = 0; k < options.iterations; ++k) {
    of_colour = mean.Of(luminance, weights);
    for (size_t i = 0; i < count; ++i) {
      const double r = (luminance[i] - of_colour[i]) / options.shading_std;
      weights[i] =
          seen[i] * (kStudentDegrees + 1.0) / (kStudentDegrees + r * r);
    }
  }
  std::vector<double> out(3 * count);
  for (size_t i = 0; i < count; ++i) {
    const double r = luminance[i] - of_colour[i];
    // The variance of a point's own, of which the reweighting makes more where
    // what is left is large.
    const double own =
        (kStudentDegrees * Square(options.prior.own_luminance) + r * r) /
        (kStudentDegrees + 1.0);
    const double share = own / (own + Square(options.shading_std));
    const double l = of_colour[i] + share * r * seen[i];
    for (int c = 0; c < 3; ++c) {
      out[3 * i + c] =
          l +
          (apparent[i].seen ? apparent[i].log_albedo[c] - luminance[i] : 0.0);
    }
  }
  return out;
}

std::vector<double> PaintGain(const UnpaintedRadiance& unpainted,
                              const std::vector<double>& log_albedo) {
  std::vector<double> gain(log_albedo.size(), 1.0);
  for (size_t i = 0; i < gain.size(); ++i) {
    const double matte = unpainted.matte[i], gloss = unpainted.gloss[i];
    const double g =
        (std::exp(log_albedo[i]) * matte + gloss) / (matte + gloss);
    if (std::isfinite(g) && g > 0.0) gain[i] = g;
  }
  return gain;
}

}  // namespace ibrdf

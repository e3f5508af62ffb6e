#include "ibrdf/solvers/paint/albedo_fit.h"

#include <glog/logging.h>

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/scene/num_views.h"
#include "ibrdf/solvers/paint/chroma_plane.h"

namespace ibrdf {
namespace {

// A pixel tells its albedo where at least this share of its radiance is matte.
constexpr double kLeastMatteShare = 0.05;
constexpr double kStudentDegrees = 3.0;
// Cells of chroma are this wide, in colour lengths; the kernel reaches so many.
constexpr double kCellWidth = 0.5;
constexpr int kReach = 6;
// Where normals turn by more from pixel to pixel, radians, neighbours say
// little of each other.
constexpr double kCrease = 0.05;
constexpr double kLeastAnchor = 1e-9, kSeenAnchor = 1e3;
constexpr double kTolerance = 1e-5;
constexpr int kMostIterations = 1000;

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

// What the image says of each point's paint, if the light is right.
struct ApparentPaint {
  std::vector<Eigen::Array2d> chroma;
  std::vector<double> luminance;  // 0 where it is not seen
  std::vector<double> seen;       // 1 or 0
};

ApparentPaint ApparentPaintOf(const UnpaintedRadiance& unpainted,
                              const Observations& observed) {
  ApparentPaint out;
  for (size_t i = 0; i < observed.valid.size(); ++i) {
    const Apparent apparent = ApparentAlbedo(unpainted, observed, i);
    out.chroma.push_back(ChromaPlane(apparent.log_albedo));
    out.luminance.push_back(apparent.log_albedo.mean());
    out.seen.push_back(apparent.seen ? 1.0 : 0.0);
  }
  return out;
}

// The luminance of points of like chroma, outliers aside.
std::vector<double> LuminanceOfColour(const ApparentPaint& apparent,
                                      const AlbedoFitOptions& options) {
  const MeanByColour mean(apparent.chroma, options.colour_length);
  std::vector<double> weights = apparent.seen, of_colour;
  for (int k = 0; k < options.iterations; ++k) {
    of_colour = mean.Of(apparent.luminance, weights);
    for (size_t i = 0; i < weights.size(); ++i) {
      const double r =
          (apparent.luminance[i] - of_colour[i]) / options.shading_std;
      weights[i] = apparent.seen[i] * (kStudentDegrees + 1.0) /
                   (kStudentDegrees + r * r);
    }
  }
  return of_colour;
}

// x of the least sum over points of anchor_weight (x - anchor)^2 and over pairs
// of weight (x_second - x_first - step)^2; kLeastAnchor keeps it unique.
class SteppedField {
 public:
  explicit SteppedField(const std::vector<double>& anchor_weights)
      : weights_(anchor_weights.size()) {
    for (size_t i = 0; i < anchor_weights.size(); ++i) {
      weights_[i] = anchor_weights[i] + kLeastAnchor;
    }
  }

  std::vector<double> Solve(const std::vector<NeighbourPair>& pairs,
                            const std::vector<double>& pair_weights,
                            const std::vector<double>& steps,
                            const std::vector<double>& anchors) const {
    const auto count = static_cast<Eigen::Index>(weights_.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = weights_.cwiseProduct(ToEigen(anchors));
    for (Eigen::Index i = 0; i < count; ++i) {
      entries.emplace_back(i, i, weights_[i]);
    }
    for (size_t k = 0; k < pairs.size(); ++k) {
      const int a = pairs[k].first, b = pairs[k].second;
      const double w = pair_weights[k];
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
      entries.emplace_back(a, b, -w);
      entries.emplace_back(b, a, -w);
      right[a] -= w * steps[k];
      right[b] += w * steps[k];
    }
    Eigen::SparseMatrix<double> A(count, count);
    A.setFromTriplets(entries.begin(), entries.end());
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>,
                             Eigen::Lower | Eigen::Upper>
        solver(A);
    solver.setTolerance(kTolerance);
    solver.setMaxIterations(kMostIterations);
    return ToVector(solver.solveWithGuess(right, ToEigen(anchors)));
  }

 private:
  Eigen::VectorXd weights_;
};

// How much of a pair's step is paint's, 0 to 1, smoothly from one to
// the other about the edges of the options.
double PaintShare(double step, double chroma_step, double turn,
                  const AlbedoFitOptions& options) {
  const double x =
      std::max(Square(step / (options.edge + options.edge_by_turn * turn)),
               Square(chroma_step / options.chroma_edge));
  return x * x / (1.0 + x * x);
}

// Pairs of neighbours with what of their steps is paint's.
struct PaintSteps {
  std::vector<double> weights, luminance;
  std::vector<Eigen::Array2d> chroma;
};

PaintSteps StepsOf(const ApparentPaint& apparent,
                   const std::vector<NeighbourPair>& neighbours,
                   const AlbedoFitOptions& options) {
  PaintSteps steps;
  for (const NeighbourPair& pair : neighbours) {
    const int a = pair.first, b = pair.second;
    if (apparent.seen[a] == 0.0 || apparent.seen[b] == 0.0) {
      steps.weights.push_back(1.0);
      steps.luminance.push_back(0.0);
      steps.chroma.push_back(Eigen::Array2d::Zero());
      continue;
    }
    const double luminance = apparent.luminance[b] - apparent.luminance[a];
    const Eigen::Array2d chroma = apparent.chroma[b] - apparent.chroma[a];
    const double share =
        PaintShare(luminance, chroma.matrix().norm(), pair.turn, options);
    steps.weights.push_back(1.0 / (1.0 + Square(pair.turn / kCrease)));
    steps.luminance.push_back(share * luminance);
    steps.chroma.push_back(share * chroma);
  }
  return steps;
}

// Chroma where it is seen, filled in from around where it is not; or, where it
// drifts, what its steps make.
std::vector<Eigen::Array2d> FittedChroma(
    const ApparentPaint& apparent, const PaintSteps& steps,
    const std::vector<NeighbourPair>& neighbours, bool drifts) {
  const size_t count = apparent.seen.size();
  if (!drifts &&
      std::count(apparent.seen.begin(), apparent.seen.end(), 0.0) == 0) {
    return apparent.chroma;
  }
  std::vector<double> weights = apparent.seen;
  for (double& w : weights) w *= drifts ? 0.0 : kSeenAnchor;
  const SteppedField field(weights);
  std::vector<Eigen::Array2d> fitted = apparent.chroma;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> anchors(count), of_axis(neighbours.size(), 0.0);
    for (size_t i = 0; i < count; ++i) anchors[i] = apparent.chroma[i][axis];
    for (size_t k = 0; drifts && k < neighbours.size(); ++k) {
      of_axis[k] = steps.chroma[k][axis];
    }
    const std::vector<double> x =
        field.Solve(neighbours, steps.weights, of_axis, anchors);
    for (size_t i = 0; i < count; ++i) {
      if (drifts || apparent.seen[i] == 0.0) fitted[i][axis] = x[i];
    }
  }
  return fitted;
}

}  // namespace

AlbedoFitOptions InViews(AlbedoFitOptions options,
                         const std::vector<ShadingPoint>& points) {
  options.reach /= std::sqrt(static_cast<double>(NumViews(points)));
  return options;
}

std::vector<double> FitAlbedo(const UnpaintedRadiance& unpainted,
                              const Observations& observed,
                              const std::vector<NeighbourPair>& neighbours,
                              const AlbedoFitOptions& options) {
  const size_t count = observed.valid.size();
  CHECK_EQ(unpainted.matte.size(), 3 * count);
  ApparentPaint apparent = ApparentPaintOf(unpainted, observed);
  const PaintSteps steps = StepsOf(apparent, neighbours, options);
  apparent.chroma =
      FittedChroma(apparent, steps, neighbours, options.chroma_drifts);
  const std::vector<double> of_colour = LuminanceOfColour(apparent, options);
  std::vector<double> anchor_weights = apparent.seen;
  for (double& w : anchor_weights) {
    w /= Square(options.reach) * static_cast<double>(count);
  }
  const std::vector<double> luminance =
      SteppedField(anchor_weights)
          .Solve(neighbours, steps.weights, steps.luminance, of_colour);
  std::vector<double> out(3 * count);
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Array3d log_colour = FromChromaPlane(apparent.chroma[i]);
    for (int c = 0; c < 3; ++c) out[3 * i + c] = luminance[i] + log_colour[c];
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

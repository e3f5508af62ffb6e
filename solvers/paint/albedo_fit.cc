#include "ibrdf/solvers/paint/albedo_fit.h"

#include <glog/logging.h>

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/median.h"
#include "ibrdf/scene/num_views.h"
#include "ibrdf/solvers/paint/chroma_plane.h"
#include "ibrdf/solvers/paint/colour_means.h"

namespace ibrdf {
namespace {

// A pixel tells its albedo where at least this share of its radiance is matte.
constexpr double kLeastMatteShare = 0.05;
constexpr double kStudentDegrees = 3.0;
// Paints of one chroma differ by no more from their mean, in log luminance;
// where the light is hardly known the image seems to say so.
constexpr double kMostOfPaint = 3.0;
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

// The median; of an even number what is nearest to 0 between the middle two.
double MedianStep(std::vector<double> steps) {
  std::sort(steps.begin(), steps.end());
  return std::clamp(0.0, steps[(steps.size() - 1) / 2],
                    steps[steps.size() / 2]);
}

// Luminance and the two axes of chroma.
using PaintColour = std::array<double, 3>;

PaintColour ColourAt(const ApparentPaint& paint, size_t point) {
  return {paint.luminance[point], paint.chroma[point][0],
          paint.chroma[point][1]};
}

PaintColour Minus(const PaintColour& a, const PaintColour& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// By coordinate; `median` of a list of numbers. colours: at least one.
template <typename Median>
PaintColour MedianColour(const std::vector<PaintColour>& colours,
                         Median median) {
  if (colours.size() == 1) return colours[0];
  PaintColour out;
  for (size_t axis = 0; axis < out.size(); ++axis) {
    std::vector<double> values;
    for (const PaintColour& colour : colours) values.push_back(colour[axis]);
    out[axis] = median(std::move(values));
  }
  return out;
}

// Moves an image's paint to the level and hue of another's.
void TakeLevelOf(const ApparentPaint& first, ApparentPaint* image) {
  std::vector<PaintColour> apart;
  for (size_t i = 0; i < first.seen.size(); ++i) {
    if (first.seen[i] == 0.0 || image->seen[i] == 0.0) continue;
    apart.push_back(Minus(ColourAt(*image, i), ColourAt(first, i)));
  }
  if (apart.empty()) return;
  const auto [level, u, v] = MedianColour(apart, UpperMedian<double>);
  for (size_t i = 0; i < first.seen.size(); ++i) {
    image->luminance[i] -= level;
    image->chroma[i] -= Eigen::Array2d(u, v);
  }
}

// What the images say together, all of one level. The brighter of two: an image
// has shadows that the render has not.
ApparentPaint Together(const std::vector<ApparentPaint>& images) {
  ApparentPaint out = images.front();
  for (size_t i = 0; images.size() > 1 && i < out.seen.size(); ++i) {
    std::vector<PaintColour> colours;
    for (const ApparentPaint& image : images) {
      if (image.seen[i] != 0.0) colours.push_back(ColourAt(image, i));
    }
    if (colours.empty()) continue;
    const auto [luminance, u, v] = MedianColour(colours, UpperMedian<double>);
    out.seen[i] = 1.0;
    out.luminance[i] = luminance;
    out.chroma[i] = {u, v};
  }
  return out;
}

// Weights of what points show, that of outliers about `expected` less.
std::vector<double> RobustWeights(const ApparentPaint& apparent,
                                  const std::vector<double>& expected,
                                  double deviation) {
  std::vector<double> weights = apparent.seen;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double r = (apparent.luminance[i] - expected[i]) / deviation;
    weights[i] *= (kStudentDegrees + 1.0) / (kStudentDegrees + r * r);
  }
  return weights;
}

// The luminance of points of like chroma, outliers aside.
std::vector<double> LuminanceOfChroma(const ColourMeans& means,
                                      const ApparentPaint& apparent,
                                      const AlbedoFitOptions& options) {
  std::vector<double> weights = apparent.seen, of_chroma;
  for (int k = 0; k < options.iterations; ++k) {
    of_chroma = means.OfLikeChroma(apparent.luminance, weights);
    weights = RobustWeights(apparent, of_chroma, options.shading_std);
  }
  return of_chroma;
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
                            const std::vector<double>& anchors,
                            const std::vector<double>& guess) const {
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
    return ToVector(solver.solveWithGuess(right, ToEigen(guess)));
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

// A step that the images have between two points.
struct ImageStep {
  double luminance = 0.0;
  Eigen::Array2d chroma = Eigen::Array2d::Zero();
  bool seen = false;
};

ImageStep StepOf(const std::vector<ApparentPaint>& images,
                 const NeighbourPair& pair) {
  const size_t a = pair.first, b = pair.second;
  std::vector<PaintColour> steps;
  for (const ApparentPaint& image : images) {
    if (image.seen[a] == 0.0 || image.seen[b] == 0.0) continue;
    steps.push_back(Minus(ColourAt(image, b), ColourAt(image, a)));
  }
  if (steps.empty()) return {};
  const auto [luminance, u, v] = MedianColour(steps, MedianStep);
  return {luminance, {u, v}, true};
}

PaintSteps StepsOf(const std::vector<ApparentPaint>& images,
                   const std::vector<NeighbourPair>& neighbours,
                   const AlbedoFitOptions& options) {
  PaintSteps steps;
  for (const NeighbourPair& pair : neighbours) {
    const auto [luminance, chroma, seen] = StepOf(images, pair);
    const double share =
        PaintShare(luminance, chroma.matrix().norm(), pair.turn, options);
    steps.weights.push_back(seen ? 1.0 / (1.0 + Square(pair.turn / kCrease))
                                 : 1.0);
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
        field.Solve(neighbours, steps.weights, of_axis, anchors, anchors);
    for (size_t i = 0; i < count; ++i) {
      if (drifts || apparent.seen[i] == 0.0) fitted[i][axis] = x[i];
    }
  }
  return fitted;
}

// A field whose points may leave their anchors over this share of their
// number's square root.
SteppedField FieldOfReach(double reach, const ApparentPaint& apparent) {
  std::vector<double> weights = apparent.seen;
  for (double& w : weights) {
    w /= Square(reach) * static_cast<double>(weights.size());
  }
  return SteppedField(weights);
}

// Luminance by its steps, drawn to what its colour has.
std::vector<double> FittedLuminance(
    const ApparentPaint& apparent, const PaintSteps& steps,
    const std::vector<NeighbourPair>& neighbours,
    const AlbedoFitOptions& options) {
  const ColourMeans means(apparent.chroma, options.colour_length);
  const std::vector<double> of_chroma =
      LuminanceOfChroma(means, apparent, options);
  std::vector<double> anchors = of_chroma;
  const bool part = options.luminance_turns > 0;
  std::vector<double> luminance =
      FieldOfReach(part ? options.parting_reach : options.reach, apparent)
          .Solve(neighbours, steps.weights, steps.luminance, anchors, anchors);
  // White and black paint have one chroma. Once steps have parted them, each is
  // drawn to its own.
  const SteppedField field = FieldOfReach(options.reach, apparent);
  for (int k = 0; k < options.luminance_turns; ++k) {
    anchors = means.OfLikeColour(
        apparent.luminance,
        RobustWeights(apparent, luminance, options.shading_std), luminance,
        options.luminance_length);
    for (size_t i = 0; i < anchors.size(); ++i) {
      anchors[i] = std::clamp(anchors[i], of_chroma[i] - kMostOfPaint,
                              of_chroma[i] + kMostOfPaint);
    }
    luminance = field.Solve(neighbours, steps.weights, steps.luminance, anchors,
                            luminance);
  }
  return luminance;
}

}  // namespace

AlbedoFitOptions UnderKnownShading() {
  AlbedoFitOptions options;
  options.edge = 0.03;
  options.edge_by_turn = 1.0;
  options.reach = 0.3;
  return options;
}

AlbedoFitOptions InViews(AlbedoFitOptions options,
                         const std::vector<ShadingPoint>& points) {
  const double views = std::sqrt(static_cast<double>(NumViews(points)));
  options.reach /= views;
  options.parting_reach /= views;
  return options;
}

std::vector<double> FitAlbedo(const std::vector<PaintedImage>& images,
                              const std::vector<NeighbourPair>& neighbours,
                              const AlbedoFitOptions& options) {
  CHECK(!images.empty());
  const size_t count = images.front().observed->valid.size();
  std::vector<ApparentPaint> of_images;
  for (const auto& [unpainted, observed] : images) {
    CHECK_EQ(observed->valid.size(), count);
    CHECK_EQ(unpainted->matte.size(), 3 * count);
    of_images.push_back(ApparentPaintOf(*unpainted, *observed));
    if (of_images.size() > 1) TakeLevelOf(of_images[0], &of_images.back());
  }
  ApparentPaint apparent = Together(of_images);
  const PaintSteps steps = StepsOf(of_images, neighbours, options);
  apparent.chroma =
      FittedChroma(apparent, steps, neighbours, options.chroma_drifts);
  const std::vector<double> luminance =
      FittedLuminance(apparent, steps, neighbours, options);
  std::vector<double> out(3 * count);
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Array3d log_colour = FromChromaPlane(apparent.chroma[i]);
    for (int c = 0; c < 3; ++c) out[3 * i + c] = luminance[i] + log_colour[c];
  }
  return out;
}

std::vector<double> MatteGain(std::vector<double> log_albedo) {
  for (double& a : log_albedo) a = std::exp(a);
  return log_albedo;
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

#include "ibrdf/solvers/paint/albedo_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ibrdf/scene/num_views.h"
#include "ibrdf/solvers/paint/chroma_plane.h"
#include "ibrdf/solvers/paint/colour_means.h"
#include "ibrdf/solvers/paint/stepped_field.h"

namespace ibrdf {
namespace {

// Steps of this much are paint's: all of what no shading explains.
constexpr double kAnyStep = 0.005;
constexpr double kStudentDegrees = 3.0;
constexpr double kSeenAnchor = 1e3;

double Square(double x) { return x * x; }

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

PaintSteps StepsOf(const std::vector<ApparentPaint>& images,
                   const std::vector<NeighbourPair>& neighbours,
                   const AlbedoFitOptions& options) {
  PaintSteps steps;
  for (const NeighbourPair& pair : neighbours) {
    const auto [luminance, chroma, seen] = StepOf(images, pair);
    const double share =
        PaintShare(luminance, chroma.matrix().norm(), pair.turn, options);
    steps.weights.push_back(seen ? WeightOfTurn(pair.turn) : 1.0);
    steps.luminance.push_back(share * luminance);
    steps.chroma.push_back(share * chroma);
  }
  return steps;
}

// Chroma where it is seen, filled in from around where it is not; or, where
// what drifts is not paint's, what its steps make.
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

// Standard deviation, per axis, of chroma that is not what its steps make.
double ChromaDrift(const ApparentPaint& apparent, const PaintSteps& steps,
                   const std::vector<NeighbourPair>& neighbours) {
  const std::vector<Eigen::Array2d> stepped =
      FittedChroma(apparent, steps, neighbours, true);
  Eigen::Array2d sum = Eigen::Array2d::Zero(), squares = sum;
  double count = 0.0;
  for (size_t i = 0; i < stepped.size(); ++i) {
    if (apparent.seen[i] == 0.0) continue;
    const Eigen::Array2d drift = apparent.chroma[i] - stepped[i];
    sum += drift;
    squares += drift.square();
    count += 1.0;
  }
  if (count == 0.0) return 0.0;
  return std::sqrt(
      std::max(0.5 * (squares / count - (sum / count).square()).sum(), 0.0));
}

// How much of what the image says beyond its colours' luminance, and says
// smoothly, is paint: its variance over that of paint and shading. Paint that
// drifts in chroma drifts in luminance as well, by more as the prior has it.
double ShareOfDrift(const ApparentPaint& apparent, const PaintSteps& steps,
                    const std::vector<NeighbourPair>& neighbours,
                    const AlbedoFitOptions& options) {
  if (!options.luminance_drifts || options.chroma_drifts) return 0.0;
  const AlbedoPrior prior;
  const double of_paint = Square(prior.luminance_std / prior.chroma_std *
                                 ChromaDrift(apparent, steps, neighbours));
  return of_paint / (of_paint + Square(options.shading_std));
}

// That drift of luminance.
std::vector<double> SmoothDrift(const ApparentPaint& apparent,
                                const std::vector<double>& luminance,
                                const PaintSteps& steps,
                                const std::vector<NeighbourPair>& neighbours,
                                const AlbedoFitOptions& options) {
  std::vector<double> beyond(luminance.size());
  for (size_t i = 0; i < beyond.size(); ++i) {
    beyond[i] = apparent.seen[i] * (apparent.luminance[i] - luminance[i]);
  }
  return FieldOfReach(options.drift_reach,
                      RobustWeights(apparent, luminance, options.shading_std))
      .Solve(neighbours, steps.weights,
             std::vector<double>(neighbours.size(), 0.0), beyond, beyond);
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
      FieldOfReach(part ? options.parting_reach : options.reach, apparent.seen)
          .Solve(neighbours, steps.weights, steps.luminance, anchors, anchors);
  // White and black paint have one chroma. Once steps have parted them, each is
  // drawn to its own.
  const SteppedField field = FieldOfReach(options.reach, apparent.seen);
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
  options.luminance_drifts = false;
  return options;
}

AlbedoFitOptions OfPaintThatFades() {
  AlbedoFitOptions options;
  options.edge = options.chroma_edge = kAnyStep;
  options.edge_by_turn = 0.0;
  options.reach = 1.0;
  options.luminance_drifts = false;
  return options;
}

AlbedoFitOptions InViews(AlbedoFitOptions options,
                         const std::vector<ShadingPoint>& points) {
  const double views = std::sqrt(static_cast<double>(NumViews(points)));
  options.reach /= views;
  options.parting_reach /= views;
  options.error_reach /= views;
  options.chroma_reach /= views;
  options.drift_reach /= views;
  return options;
}

std::vector<double> FitAlbedo(const std::vector<PaintedImage>& images,
                              const std::vector<NeighbourPair>& neighbours,
                              const AlbedoFitOptions& options) {
  const std::vector<ApparentPaint> of_images = ApparentPaintsOf(images);
  ApparentPaint apparent = Together(of_images);
  const PaintSteps steps = StepsOf(of_images, neighbours, options);
  const double share_of_drift =
      ShareOfDrift(apparent, steps, neighbours, options);
  apparent.chroma =
      FittedChroma(apparent, steps, neighbours, options.chroma_drifts);
  std::vector<double> luminance =
      FittedLuminance(apparent, steps, neighbours, options);
  if (share_of_drift > 0.0) {
    const std::vector<double> drift =
        SmoothDrift(apparent, luminance, steps, neighbours, options);
    for (size_t i = 0; i < drift.size(); ++i) {
      luminance[i] += share_of_drift * drift[i];
    }
  }
  std::vector<double> out(3 * luminance.size());
  for (size_t i = 0; i < luminance.size(); ++i) {
    const Eigen::Array3d log_colour = FromChromaPlane(apparent.chroma[i]);
    for (int c = 0; c < 3; ++c) out[3 * i + c] = luminance[i] + log_colour[c];
  }
  return out;
}

double PaintShareOfDrift(const std::vector<PaintedImage>& images,
                         const std::vector<NeighbourPair>& neighbours,
                         const AlbedoFitOptions& options) {
  const std::vector<ApparentPaint> of_images = ApparentPaintsOf(images);
  return ShareOfDrift(Together(of_images),
                      StepsOf(of_images, neighbours, options), neighbours,
                      options);
}

std::vector<double> MatteGain(std::vector<double> log_albedo) {
  for (double& a : log_albedo) a = std::exp(a);
  return log_albedo;
}

std::vector<double> PaintGain(const UnpaintedRadiance& unpainted,
                              const std::vector<double>& log_albedo) {
  return PaintGain(unpainted, log_albedo, unpainted.gloss);
}

std::vector<double> PaintGain(const UnpaintedRadiance& unpainted,
                              const std::vector<double>& log_albedo,
                              const std::vector<double>& gloss) {
  std::vector<double> gain(log_albedo.size(), 1.0);
  for (size_t i = 0; i < gain.size(); ++i) {
    const double matte = unpainted.matte[i];
    const double g = (std::exp(log_albedo[i]) * matte + gloss[i]) /
                     (matte + unpainted.gloss[i]);
    if (std::isfinite(g) && g > 0.0) gain[i] = g;
  }
  return gain;
}

}  // namespace ibrdf

// Log albedo at every pixel, given the reflectance and the light.
#pragma once
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/paint/apparent_paint.h"
#include "ibrdf/solvers/paint/neighbours.h"
#include "ibrdf/solvers/priors/albedo_prior.h"

namespace ibrdf {

// Paints of one chroma differ by no more from their mean, in log luminance;
// where the light is hardly known the image seems to say so.
inline constexpr double kMostOfPaint = 3.0;

struct AlbedoFitOptions {
  double colour_length = AlbedoPrior().colour_length;
  // What counts as like luminance where steps have parted paints of one chroma:
  // two points differ by twice shading_std and more. So often they are parted.
  double luminance_length = 0.4;
  int luminance_turns = 4;
  // As `reach`, while they are being parted.
  double parting_reach = 0.5;
  // Deviation of log radiance between image and render that is not paint's: of
  // the reflectance, the light and the normals.
  double shading_std = 0.15;
  int iterations = 5;
  // From pixel to pixel, a step of log luminance above `edge` and what the
  // normals' turn allows, or one of log chroma above `chroma_edge`, is paint's.
  double edge = 0.1, edge_by_turn = 5.0, chroma_edge = 0.1;
  // Whether chroma that drifts is the light's, as luminance's is, and sharp
  // steps alone are paint's; else all of the image's chroma is.
  bool chroma_drifts = false;
  // Over this share of the object's size, the square root of its pixels, paint
  // may leave the albedo of its colour.
  double reach = 0.15;
  // Whether luminance that drifts beyond its colour's is paint's in part: as
  // far as the chroma of this object drifts, too. One image does not tell it
  // from an error of the shading. It drifts over `drift_reach` of the object's
  // size.
  bool luminance_drifts = true;
  double drift_reach = 0.035;
  // Over this share the error of shading is about as large (AlbedoLogStd). It
  // was chosen on the apple, the turtle and the squirrel of
  // experiments/painted; 0.02 to 0.05 do as well.
  double error_reach = 0.03;
  // Relative error of the gloss's radiance (AlbedoLogStd). Its energy came out
  // between 0.4 and 3.3 times the true one on these three.
  double gloss_error = 1.0;
  // Over this share paint has about one chroma (SeparateGloss).
  double chroma_reach = 0.035;
  // Standard deviation of the log of gloss between image and render, beside
  // their error of shading (SeparateGloss).
  double gloss_std = 0.5;
};

// The options where little of what changes over the object is shading's that
// the render has not.
AlbedoFitOptions UnderKnownShading();

// The options where all of what changes over the object and the render has not
// is paint's, however gently it changes. Broad gloss that the render lacks is
// then paint, too.
AlbedoFitOptions OfPaintThatFades();

// The options where the object's size is that of one of the points' views.
AlbedoFitOptions InViews(AlbedoFitOptions options,
                         const std::vector<ShadingPoint>& points);

// Log albedo a [points * 3], I = e^a matte + gloss. Chroma is the image's, or
// what steps in it. Luminance has two cues. Points of like colour have like
// albedo, wherever they are, but for outliers. And beside each other, pixels
// differ by paint where they differ sharply (Retinex), by shading where they do
// not: shading drifts with the normals, paint has edges. So a is the least
// squares' solution of sharp steps (a print's, of the same chroma too), drawn
// over `reach` to what its colour has: first what its chroma has, then what
// points do that are of like luminance too in the solution before. Where the
// gloss is nearly all of the image, or nothing was observed, paint is filled in
// from around.
//
// Several images show the same points, each under its own light, at least one:
// shading and shadows change with the light, paint does not. So a step is the
// median of theirs (Weiss 2001), and so is a point's paint, each image's level
// taken off by the median of its quotient with the first's.
std::vector<double> FitAlbedo(const std::vector<PaintedImage>& images,
                              const std::vector<NeighbourPair>& neighbours,
                              const AlbedoFitOptions& options);

// The share in [0, 1) of a smooth drift of luminance that FitAlbedo takes for
// paint; 0 where the options have none.
double PaintShareOfDrift(const std::vector<PaintedImage>& images,
                         const std::vector<NeighbourPair>& neighbours,
                         const AlbedoFitOptions& options);

// e^a [points * 3]: PaintGain where nothing is gloss.
std::vector<double> MatteGain(std::vector<double> log_albedo);

// (e^a matte + gloss) / (matte + gloss) [points * 3].
std::vector<double> PaintGain(const UnpaintedRadiance& unpainted,
                              const std::vector<double>& log_albedo);

// The same where the painted object shows another gloss [points * 3].
std::vector<double> PaintGain(const UnpaintedRadiance& unpainted,
                              const std::vector<double>& log_albedo,
                              const std::vector<double>& gloss);

}  // namespace ibrdf

#include "ibrdf/solvers/paint/gloss_separation.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/solvers/paint/chroma_plane.h"
#include "ibrdf/solvers/paint/stepped_field.h"

namespace ibrdf {
namespace {

constexpr int kRounds = 3;  // of the paint's chroma and the gloss
// Between these the log of gloss over its render is sought.
constexpr double kLeastLogFactor = -4.0, kMostLogFactor = 3.0;
constexpr int kFactors = 41;
// Standard deviation of what makes pixels' chroma differ beside paint: noise.
constexpr double kLeastChromaStd = 0.02;

using Colours = std::vector<Eigen::Array3d>;  // of points

Colours ToColours(const std::vector<double>& values) {
  Colours out(values.size() / 3);
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] = Eigen::Map<const Eigen::Array3d>(&values[3 * i]);
  }
  return out;
}

// Weights of the channels, sum 1: lobes that explain an image know the gloss
// the better the less paint there is beside it.
Eigen::Array3d TrustInChannels(const Colours& log_albedo,
                               const Eigen::Array3d& matte_albedo) {
  Eigen::Array3d mean = Eigen::Array3d::Zero();
  for (const Eigen::Array3d& a : log_albedo) mean += a;
  mean /= static_cast<double>(log_albedo.size());
  const Eigen::Array3d trust = (mean.exp() * matte_albedo).square().inverse();
  return trust / trust.sum();
}

// One point: I, and what it would show were its paint grey.
struct PointModel {
  Eigen::Array3d I, matte, gloss;

  bool tells() const {
    return I.minCoeff() > 0.0 && matte.minCoeff() > 0.0 &&
           gloss.minCoeff() > 0.0;
  }
  Eigen::Array3d Paint(double factor) const {
    return (I - factor * gloss).max(kLeastMatteShare * I);
  }
  // -log posterior of log factor t, doubled, the paint of this log chroma.
  double Cost(double t, const Eigen::Array3d& log_chroma,
              double chroma_variance, double gloss_variance) const {
    const Eigen::Array3d g = std::exp(t) * gloss;
    const Eigen::Array3d of_paint = log_chroma.exp() * matte;
    const double level = (Paint(std::exp(t)) / of_paint).log().mean();
    const Eigen::Array3d r = ((std::exp(level) * of_paint + g) / I).log();
    return r.square().sum() / chroma_variance + t * t / gloss_variance;
  }
};

// The points with the render's gloss as the coat of a dielectric has it, under
// the image's shading.
std::vector<PointModel> PointsOf(const PaintedImage& image,
                                 const std::vector<double>& log_albedo,
                                 const Eigen::Array3d& matte_albedo) {
  const Colours I = ToColours(image.observed->radiance);
  const Colours matte = ToColours(image.unpainted->matte);
  const Colours gloss = ToColours(image.unpainted->gloss);
  const Colours a = ToColours(log_albedo);
  const Eigen::Array3d trust = TrustInChannels(a, matte_albedo);
  std::vector<PointModel> out(I.size());
  for (size_t i = 0; i < I.size(); ++i) {
    const bool valid = image.observed->valid[i];
    out[i] = {valid ? I[i] : Eigen::Array3d::Zero(), matte[i],
              Eigen::Array3d::Zero()};
    const Eigen::Array3d E = matte[i] / matte_albedo;
    const Eigen::Array3d render = a[i].exp() * matte[i] + gloss[i];
    if (!(E.minCoeff() > 0.0) || !(render.minCoeff() > 0.0)) continue;
    const double shading = valid ? I[i].mean() / render.mean() : 1.0;
    const Eigen::Array3d g = shading * (trust * gloss[i] / E).sum() * E;
    if (g.isFinite().all()) out[i].gloss = g;
  }
  return out;
}

// The most probable log factor: the least on a grid, its parabola refined.
double BestLogFactor(const PointModel& point, const Eigen::Array3d& log_chroma,
                     double chroma_variance, double gloss_variance) {
  const double most = std::min(
      kMostLogFactor,
      std::log((1.0 - kLeastMatteShare) * (point.I / point.gloss).minCoeff()));
  const double step = (std::max(most - kLeastLogFactor, 1.0)) / (kFactors - 1);
  std::vector<double> costs(kFactors);
  for (int k = 0; k < kFactors; ++k) {
    costs[k] = point.Cost(most - k * step, log_chroma, chroma_variance,
                          gloss_variance);
  }
  const auto k = std::min_element(costs.begin(), costs.end()) - costs.begin();
  const double t = most - static_cast<double>(k) * step;
  if (k == 0 || k == kFactors - 1) return t;
  const double slope = costs[k + 1] - costs[k - 1];
  const double curvature = costs[k + 1] - 2.0 * costs[k] + costs[k - 1];
  return curvature > 0.0 ? t + 0.5 * slope / curvature * step : t;
}

// What is matte of the points' images, by the gloss so far.
struct MatteChroma {
  std::vector<Eigen::Array2d> chroma;
  std::vector<double> weights;  // [0, 1]: how much of a point is matte, squared
};

MatteChroma ChromaBeside(const std::vector<double>& factors,
                         const std::vector<PointModel>& points) {
  MatteChroma out;
  for (size_t i = 0; i < points.size(); ++i) {
    out.chroma.emplace_back(0.0, 0.0);
    out.weights.push_back(0.0);
    if (!points[i].tells()) continue;
    const Eigen::Array3d paint = points[i].Paint(factors[i]);
    out.chroma.back() = ChromaPlane((paint / points[i].matte).log());
    const double share = (paint / points[i].I).minCoeff();
    out.weights.back() = share * share;
  }
  return out;
}

// As around each point.
std::vector<Eigen::Array2d> SmoothChroma(
    const MatteChroma& matte, const std::vector<NeighbourPair>& neighbours,
    double reach) {
  const SteppedField field = FieldOfReach(reach, matte.weights);
  const std::vector<double> alike(neighbours.size(), 1.0),
      level(neighbours.size(), 0.0);
  std::vector<Eigen::Array2d> out = matte.chroma;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> values;
    for (const Eigen::Array2d& c : matte.chroma) values.push_back(c[axis]);
    const std::vector<double> smooth =
        field.Solve(neighbours, alike, level, values, values);
    for (size_t i = 0; i < out.size(); ++i) out[i][axis] = smooth[i];
  }
  return out;
}

// By how much chroma differs from what is around it, per axis.
double ChromaVariance(const MatteChroma& matte,
                      const std::vector<Eigen::Array2d>& around) {
  double sum = 0.0, weight = 0.0;
  for (size_t i = 0; i < around.size(); ++i) {
    sum += matte.weights[i] * (matte.chroma[i] - around[i]).square().sum();
    weight += matte.weights[i];
  }
  return (weight > 0.0 ? 0.5 * sum / weight : 0.0) +
         kLeastChromaStd * kLeastChromaStd;
}

// What the gloss is over the render's, at each point.
std::vector<double> GlossFactors(const std::vector<PointModel>& points,
                                 const std::vector<NeighbourPair>& neighbours,
                                 const AlbedoFitOptions& options) {
  std::vector<double> factors(points.size(), 1.0);
  const double gloss_variance = options.gloss_std * options.gloss_std;
  const MatteChroma at_first = ChromaBeside(factors, points);
  MatteChroma matte = at_first;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Eigen::Array2d> around =
        SmoothChroma(matte, neighbours, options.chroma_reach);
    const double chroma_variance = ChromaVariance(at_first, around);
    for (size_t i = 0; i < points.size(); ++i) {
      if (!points[i].tells()) continue;
      factors[i] = std::exp(BestLogFactor(points[i], FromChromaPlane(around[i]),
                                          chroma_variance, gloss_variance));
    }
    matte = ChromaBeside(factors, points);
  }
  return factors;
}

}  // namespace

std::vector<double> SeparateGloss(const PaintedImage& image,
                                  const std::vector<double>& log_albedo,
                                  const Eigen::Array3d& matte_albedo,
                                  const std::vector<NeighbourPair>& neighbours,
                                  const AlbedoFitOptions& options) {
  const size_t count = image.observed->valid.size();
  CHECK_EQ(log_albedo.size(), 3 * count);
  CHECK(matte_albedo.minCoeff() > 0.0);
  const std::vector<PointModel> points =
      PointsOf(image, log_albedo, matte_albedo);
  const std::vector<double> factors = GlossFactors(points, neighbours, options);
  std::vector<double> out;
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Array3d g = factors[i] * points[i].gloss;
    out.insert(out.end(), {g[0], g[1], g[2]});
  }
  return out;
}

}  // namespace ibrdf

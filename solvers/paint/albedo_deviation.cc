#include "ibrdf/solvers/paint/albedo_deviation.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/median.h"
#include "ibrdf/solvers/paint/stepped_field.h"
#include "ibrdf/solvers/paint/unseen_points.h"

namespace ibrdf {
namespace {

constexpr double kMostVariance = kMostOfPaint * kMostOfPaint;

using Values = std::vector<double>;  // of points

// The mean over a point's channels.
double Mean(const Values& of_channels, size_t point) {
  const double* v = &of_channels[3 * point];
  return (v[0] + v[1] + v[2]) / 3.0;
}

Values Luminance(const Values& log_albedo) {
  Values out(log_albedo.size() / 3);
  for (size_t i = 0; i < out.size(); ++i) out[i] = Mean(log_albedo, i);
  return out;
}

// What the images say beyond the fitted albedo; 0 where a point is not seen.
Values Disagreement(const ApparentPaint& apparent, const Values& fitted) {
  Values out(fitted.size(), 0.0);
  for (size_t i = 0; i < out.size(); ++i) {
    if (apparent.seen[i] != 0.0) out[i] = apparent.luminance[i] - fitted[i];
  }
  return out;
}

Values Squares(Values values) {
  for (double& v : values) v *= v;
  return values;
}

// The squared standard error of the images' median; 0 of one image.
Values SquaredErrorOfMedian(const std::vector<ApparentPaint>& images,
                            const ApparentPaint& median) {
  Values out(median.seen.size(), 0.0);
  for (size_t i = 0; i < out.size(); ++i) {
    double sum = 0.0, count = 0.0;
    for (const ApparentPaint& image : images) {
      if (image.seen[i] == 0.0) continue;
      const double apart = image.luminance[i] - median.luminance[i];
      sum += apart * apart;
      count += 1.0;
    }
    if (count > 0.0) out[i] = sum / (count * count);
  }
  return out;
}

// Over the mean of the points that are seen; root mean square of the images.
Values RelativeIrradiance(const std::vector<PaintedImage>& images,
                          const Values& seen) {
  Values sum(seen.size(), 0.0);
  for (const PaintedImage& image : images) {
    double mean = 0.0, count = 0.0;
    for (size_t i = 0; i < seen.size(); ++i) {
      mean += seen[i] * Mean(image.unpainted->matte, i);
      count += seen[i];
    }
    if (!(mean > 0.0)) continue;
    mean /= count;
    for (size_t i = 0; i < seen.size(); ++i) {
      const double E = Mean(image.unpainted->matte, i) / mean;
      sum[i] += E * E;
    }
  }
  for (double& E : sum) {
    E = std::sqrt(E / static_cast<double>(images.size()));
  }
  return sum;
}

// The median of |r| E over the points that are seen.
double MissingIrradiance(const Values& r, const Values& E, const Values& seen) {
  Values errors;
  for (size_t i = 0; i < r.size(); ++i) {
    if (seen[i] != 0.0) errors.push_back(std::abs(r[i]) * E[i]);
  }
  return errors.empty() ? 0.0 : UpperMedian(std::move(errors));
}

// By how much log albedo would change if this share of the gloss were none: the
// median of the images.
double ChangeByGloss(const std::vector<PaintedImage>& images,
                     const Values& log_albedo, double share, size_t point) {
  Values changes;
  for (const PaintedImage& image : images) {
    double matte = 0.0, gloss = 0.0;
    for (size_t k = 3 * point; k < 3 * point + 3; ++k) {
      matte += std::exp(log_albedo[k]) * image.unpainted->matte[k];
      gloss += image.unpainted->gloss[k];
    }
    const double change = std::log1p(share * gloss / matte);
    changes.push_back(std::isfinite(change) ? change : kMostOfPaint);
  }
  return UpperMedian(std::move(changes));
}

// The mean over the points about each; 0 at least.
class LocalMean {
 public:
  LocalMean(const std::vector<NeighbourPair>& neighbours, const Values& seen,
            double reach)
      : neighbours_(neighbours),
        field_(FieldOfReach(reach, seen)),
        steps_(neighbours.size(), 0.0) {
    for (const NeighbourPair& pair : neighbours) {
      const bool both = seen[pair.first] * seen[pair.second] != 0.0;
      weights_.push_back(both ? WeightOfTurn(pair.turn) : 1.0);
    }
  }
  Values Of(const Values& values) const {
    Values out = field_.Solve(neighbours_, weights_, steps_, values, values);
    for (double& v : out) v = std::max(v, 0.0);
    return out;
  }

 private:
  const std::vector<NeighbourPair>& neighbours_;
  const SteppedField field_;
  const Values steps_;
  Values weights_;
};

// Mean square of the steps of x between neighbours that are seen.
double StepVariance(const std::vector<NeighbourPair>& neighbours,
                    const Values& x, const Values& seen) {
  double sum = 0.0, count = 0.0;
  for (const NeighbourPair& pair : neighbours) {
    const double both = seen[pair.first] * seen[pair.second];
    const double step = x[pair.second] - x[pair.first];
    sum += both * step * step;
    count += both;
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

std::vector<double> AlbedoLogStd(const std::vector<PaintedImage>& images,
                                 const std::vector<NeighbourPair>& neighbours,
                                 const std::vector<double>& log_albedo,
                                 const AlbedoFitOptions& options) {
  const std::vector<ApparentPaint> of_images = ApparentPaintsOf(images);
  const ApparentPaint apparent = Together(of_images);
  const Values fitted = Luminance(log_albedo);
  CHECK_EQ(fitted.size(), apparent.seen.size());
  const Values r = Disagreement(apparent, fitted);
  const LocalMean mean(neighbours, apparent.seen, options.error_reach);
  const Values of_shading = mean.Of(Squares(r));
  const Values of_median = mean.Of(SquaredErrorOfMedian(of_images, apparent));
  const Values E = RelativeIrradiance(images, apparent.seen);
  const double missing = MissingIrradiance(r, E, apparent.seen);
  // What is left of paint's variance, and of shading's, once their sum is
  // known.
  const double of_drift = PaintShareOfDrift(images, neighbours, options) *
                          options.shading_std * options.shading_std /
                          static_cast<double>(images.size());
  Values variance(fitted.size());
  for (size_t i = 0; i < variance.size(); ++i) {
    if (apparent.seen[i] == 0.0) continue;
    const double of_light = std::log1p(missing / E[i]);
    const double of_gloss =
        ChangeByGloss(images, log_albedo, options.gloss_error, i);
    variance[i] = of_shading[i] + of_median[i] + of_drift +
                  of_light * of_light + of_gloss * of_gloss;
    if (!(variance[i] < kMostVariance)) variance[i] = kMostVariance;
  }
  const UnseenPoints unseen(neighbours, apparent.seen);
  const double step = StepVariance(neighbours, fitted, apparent.seen);
  unseen.Scatter(
      unseen.MeanGiven(variance, kMostVariance) + step * unseen.Variances(),
      &variance);
  for (double& v : variance) v = std::sqrt(std::clamp(v, 0.0, kMostVariance));
  return variance;
}

}  // namespace ibrdf

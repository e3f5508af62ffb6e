#include "ibrdf/solvers/paint/smooth_shading.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/solvers/paint/chroma_plane.h"
#include "ibrdf/solvers/paint/like_colours.h"

namespace ibrdf {
namespace {

constexpr double kLeastFacing = 0.2;
constexpr int kOrder = 2;
// The constant harmonic is paint's level.
constexpr int kHarmonics = (kOrder + 1) * (kOrder + 1) - 1;
constexpr size_t kNeighbours = 6000;
// Both kinds of pairs weigh as much, whatever their number.
constexpr double kWeightOfKind = 5000.0;
// As in shading_light.cc: first of nearly one colour; then wider, as the
// light's colour is known.
constexpr double kFirstAlike = 0.06, kNextAlike = 0.09;
// Differences beyond are paint's: of log luminance and of log chroma, between
// points of one colour and between neighbours.
constexpr double kLuminanceOfColour = 0.15, kChromaOfColour = 0.05;
constexpr double kLuminanceOfStep = 0.03, kChromaOfStep = 0.015;
// Precisions of the coefficients; the light's colour varies less.
constexpr double kLuminanceRidge = 1.0, kChromaRidge = 500.0;
constexpr int kRounds = 3, kIterations = 8;
// Log albedo within this is one colour; so many points tell.
constexpr double kOneColour = 0.2;
constexpr size_t kSample = 1000;

// Log luminance and two coordinates of log chroma.
using Colour = Eigen::Array3d;
using Harmonics = Eigen::Matrix<double, kHarmonics, 1>;
using Coefficients = Eigen::Matrix<double, kHarmonics, 3>;

Colour ColourOf(const double* radiance) {
  const Eigen::Array3d log = Eigen::Map<const Eigen::Array3d>(radiance).log();
  const Eigen::Array2d chroma = ChromaPlane(log);
  return {log.mean(), chroma[0], chroma[1]};
}

Harmonics HarmonicsOf(const HarmonicBasis& basis, const ShadingPoint& point) {
  double Y[kHarmonics + 1];
  basis.Evaluate(point.normal.cast<double>().normalized(), Y);
  return Eigen::Map<const Harmonics>(Y + 1);
}

bool Faces(const ShadingPoint& point) {
  return point.normal.dot(point.wo) >= static_cast<float>(kLeastFacing);
}

// What two points differ by.
struct Difference {
  Harmonics harmonics;
  Colour colour, scale;
  double weight;
};

class ShadingFit {
 public:
  ShadingFit(const std::vector<ShadingPoint>& points,
             const Observations& observed,
             const std::vector<NeighbourPair>& neighbours)
      : basis_(kOrder) {
    used_.assign(points.size(), 0);
    harmonics_.resize(points.size());
    colours_.resize(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
      harmonics_[i] = HarmonicsOf(basis_, points[i]);
      if (!observed.valid[i] || !Faces(points[i])) continue;
      colours_[i] = ColourOf(&observed.radiance[3 * i]);
      if (!colours_[i].isFinite().all()) continue;
      used_[i] = 1;
      facing_.push_back(i);
    }
    AddNeighbours(neighbours);
  }

  // The coefficients of s; 0 where too few points have partners.
  Coefficients Run() {
    Coefficients s = Coefficients::Zero();
    if (facing_.size() < kFewestColourPairs) return s;
    for (int round = 0; round < kRounds; ++round) {
      const size_t steps = differences_.size();
      AddLikeColours(s, round == 0 ? kFirstAlike : kNextAlike);
      if (differences_.size() < steps + kFewestColourPairs) return s;
      for (int k = 0; k < kIterations; ++k) s = Reweighted(s);
      differences_.resize(steps);
    }
    return s;
  }

  // e^s [points * 3].
  std::vector<double> Shading(const Coefficients& s) const {
    std::vector<double> out;
    for (const Harmonics& y : harmonics_) {
      const Colour colour = s.transpose() * y;
      const Eigen::Array3d rgb =
          (colour[0] + FromChromaPlane({colour[1], colour[2]})).exp();
      out.insert(out.end(), rgb.begin(), rgb.end());
    }
    return out;
  }

 private:
  void Add(size_t a, size_t b, double weight, double luminance, double chroma) {
    differences_.push_back({harmonics_[b] - harmonics_[a],
                            colours_[b] - colours_[a],
                            {luminance, chroma, chroma},
                            weight});
  }

  // Divides the weights of those from `first` on by their sum.
  void Normalise(size_t first) {
    double sum = 0.0;
    for (size_t k = first; k < differences_.size(); ++k) {
      sum += differences_[k].weight;
    }
    for (size_t k = first; k < differences_.size(); ++k) {
      differences_[k].weight *= kWeightOfKind / sum;
    }
  }

  void AddNeighbours(const std::vector<NeighbourPair>& neighbours) {
    const size_t stride = neighbours.size() / kNeighbours + 1;
    for (size_t k = 0; k < neighbours.size(); k += stride) {
      const NeighbourPair& pair = neighbours[k];
      if (!used_[pair.first] || !used_[pair.second]) continue;
      Add(pair.first, pair.second, WeightOfTurn(pair.turn), kLuminanceOfStep,
          kChromaOfStep);
    }
    Normalise(0);
  }

  // Pairs whose chroma differs little without the shading at hand.
  void AddLikeColours(const Coefficients& s, double like) {
    const size_t first = differences_.size();
    std::vector<Eigen::Array2d> chroma;
    for (const size_t i : facing_) {
      const Colour shading = s.transpose() * harmonics_[i];
      chroma.push_back((colours_[i] - shading).tail<2>());
    }
    for (const ColourPair& pair : PairsOfLikeColour(chroma, like)) {
      Add(facing_[pair.first], facing_[pair.second], pair.weight,
          kLuminanceOfColour, kChromaOfColour);
    }
    Normalise(first);
  }

  // One step of iteratively reweighted least squares under Cauchy's loss.
  Coefficients Reweighted(const Coefficients& s) const {
    Coefficients next;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix<double, kHarmonics, kHarmonics> A =
          Eigen::Matrix<double, kHarmonics, kHarmonics>::Identity() *
          (axis == 0 ? kLuminanceRidge : kChromaRidge);
      Harmonics right = Harmonics::Zero();
      for (const Difference& d : differences_) {
        const double r =
            (d.colour[axis] - d.harmonics.dot(s.col(axis))) / d.scale[axis];
        const double w =
            d.weight / (d.scale[axis] * d.scale[axis] * (1.0 + r * r));
        A.noalias() += w * d.harmonics * d.harmonics.transpose();
        right += w * d.colour[axis] * d.harmonics;
      }
      next.col(axis) = A.ldlt().solve(right);
    }
    return next;
  }

  const HarmonicBasis basis_;
  std::vector<Harmonics> harmonics_;
  std::vector<Colour> colours_;
  std::vector<char> used_;
  std::vector<size_t> facing_;
  std::vector<Difference> differences_;
};

}  // namespace

std::vector<double> SmoothShading(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const std::vector<NeighbourPair>& neighbours) {
  ShadingFit fit(points, observed, neighbours);
  return fit.Shading(fit.Run());
}

double ColourEntropy(const std::vector<ShadingPoint>& points,
                     const Observations& observed,
                     const std::vector<double>& log_albedo) {
  std::vector<Eigen::Array3d> all, sample;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!observed.valid[i] || !Faces(points[i])) continue;
    all.emplace_back(&log_albedo[3 * i]);
  }
  const size_t stride = all.size() / kSample + 1;
  for (size_t i = 0; i < all.size(); i += stride) sample.push_back(all[i]);
  if (sample.empty()) return 0.0;
  double sum = 0.0;
  for (const Eigen::Array3d& a : sample) {
    for (const Eigen::Array3d& b : sample) {
      sum +=
          std::exp((a - b).square().sum() / (-4.0 * kOneColour * kOneColour));
    }
  }
  const auto count = static_cast<double>(sample.size());
  return -std::log(sum / (count * count));
}

}  // namespace ibrdf

// How points that nothing shadows are rendered, and why.
#pragma once
#include <string>

namespace ibrdf {

enum class Approximation {
  kQuadrature,      // each by itself
  kReflectanceMap,  // as many as it takes, the rest interpolated by normal
  kHarmonics,       // the map in spherical harmonics
  kGaussians,       // the map as a mixture of spherical Gaussians
};

// What became of harmonics and Gaussians.
enum class ApproximationVerdict {
  kNotConsidered,  // not allowed, or nothing to gain
  kNarrowLobe,     // the lobe has more detail than they have
  kPredictedOff,   // no candidate is predicted to be within the error
  kNonePays,       // those within are slower, or were found to be further off
  kTaken,
};

// An error is the mean of |log L_o - log reference| over points and channels.
struct ApproximationPlan {
  // The decision.
  Approximation approximation = Approximation::kQuadrature;
  int order = 0;                 // of the harmonics
  int gaussians = 0, spots = 0;  // in the mixture; bright spots among them

  // What it was taken from.
  ApproximationVerdict verdict = ApproximationVerdict::kNotConsidered;
  bool forced = false;           // the user asks for harmonics or Gaussians
  double log_error = 0.0;        // allowed
  double lobe_half_width = 0.0;  // radians, where it was asked for
  // Error of the harmonics or Gaussians taken, else of the best candidate, as
  // predicted from the light that is left out.
  double predicted_error = 0.0;
  // Errors of those taken and of the quadrature, with two standard errors, as
  // found at `checked` points of the image that are rendered at reference
  // quality.
  double found_error = 0.0, quadrature_error = 0.0;
  int checked = 0;
  // What the decision and the quadrature take on one core, as predicted from
  // counts, not by a clock.
  double seconds = 0.0, quadrature_seconds = 0.0;
};

// For the user, after the effects; begins with "; " unless it is empty.
std::string Describe(const ApproximationPlan& plan);

}  // namespace ibrdf

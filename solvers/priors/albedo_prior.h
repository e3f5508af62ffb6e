// Prior of paint: the albedo of a surface's points relative to their
// material's.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace ibrdf {

// Log albedo a of three channels, zero in the mean: its luminance, the mean of
// the channels, and its chroma, what is left. Points of like colour have like
// albedo, wherever they are: few things are painted in many colours, and two
// paints of one chroma and another luminance are rare (the cue of Shen, Tan and
// Lin, CVPR 2008, and of the palettes of Barron and Malik 2015, Sec. 4.2).
// Deviations in nats.
struct AlbedoPrior {
  double luminance_std = 0.6;   // of what colour explains
  double chroma_std = 0.3;      // likewise
  double own_luminance = 0.1;   // a point's own
  double own_chroma = 0.03;     // likewise
  double colour_length = 0.06;  // of log chroma: what counts as like
  // Luminance drifts over the surface by this, whatever the colour, and has
  // become another where unit normals are that far apart.
  double smooth_luminance = 0.0;
  double smooth_length = 0.5;

  // All deviations times `factor`.
  AlbedoPrior Scaled(double factor) const;
};

// What is known of an object's paint before its light is.
struct PaintPrior {
  AlbedoPrior albedo;
  // Its mean, log albedo [points * 3] of all points of the image; empty: 0.
  std::vector<double> mean;
  // Paint hides where less than this share of the light that the object
  // reflects is of the part that paint scales.
  double least_matte_share = 0.5;
};

// Colours of points: log radiance [3 * points], channel by channel, less the
// mean of its channels.
Eigen::MatrixX3d LogChroma(const std::vector<double>& log_radiance);

// Covariance [3 * points]^2 of a, channel by channel, of points with these log
// chromas [points][3]:
//   (luminance_std^2 k_pq + own_luminance^2 [p = q]) 1 1^T
//   + (chroma_std^2 k_pq + own_chroma^2 [p = q]) (I - 1 1^T / 3),
//   k_pq = 1 / (1 + |q_p - q_q|^2 / (2 colour_length^2)),
// a rational quadratic kernel: colours far from each other still tell a little.
// With normals [points][3], empty: none, the first bracket has also
//   smooth_luminance^2 exp(-|n_p - n_q|^2 / (2 smooth_length^2)).
Eigen::MatrixXd AlbedoCovariance(const AlbedoPrior& prior,
                                 const Eigen::MatrixX3d& chroma,
                                 const Eigen::MatrixX3d& normals = {});

}  // namespace ibrdf

// One interface for light transport as a function of the map: stored sums over
// the quadrature, harmonics, Gaussians.
#pragma once
#include <vector>

namespace ibrdf {

// Points, visibility and reflectance are fixed; the map L is the argument:
//
//   L_o = A L + b.
//
// A is linear. b is the radiance of light that is no part of the map: what
// SplitBrightTexels took out of a known one. It is 0 with most transports.
//
// Shapes: map [H, W, 3] radiance, row-major; L_o [points, 3] radiance. Both
// must be finite and may be negative (tangents, adjoints). One thread at a time
// may call a transport (it is parallel inside), with the same bits for any
// number of threads.
class LinearTransport {
 public:
  virtual ~LinearTransport() = default;

  virtual int num_points() const = 0;

  // A L + b: the radiance of the points under a map.
  void Apply(const float* map, double* L_o) const;

  // A L without b: for maps that are tangents.
  virtual void ApplyLinear(const float* map, double* L_o) const = 0;

  // gradient [H, W, 3] = A^T adjoint, adjoint [points, 3]: the derivative of
  // sum adjoint . L_o in the map.
  virtual void ApplyTranspose(const double* adjoint, float* gradient) const = 0;

  // row [H, W, 3]: what a unit of radiance of each texel adds to the radiance
  // of a point, bounces left out. False: the transport stores no such rows.
  virtual bool Row(int point, float* row) const {
    (void)point;
    (void)row;
    return false;
  }

  // b [points, 3]; empty where it is 0.
  const std::vector<double>& offset() const { return offset_; }

 protected:
  // Whoever has light besides the map's sets b at construction: Apply adds it.
  std::vector<double> offset_;
};

}  // namespace ibrdf

#include "ibrdf/transport/quadrature_kernels.h"

#include "ibrdf/base/fast_atan2.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {

namespace {

constexpr double kPi = 3.14159265358979323846;
// Cells that are looked at together: half of all are below the horizon.
constexpr int kTogether = 16;

// The cosines of cells' centres [n], and how far they vary over a cell.
struct Cosines {
  double centre[kTogether], extent[kTogether];
  bool any_above;
};

void FindCosines(const FarCellColumns& cells, int begin, int n,
                 const double* normal, Cosines* out) {
  const double nx = normal[0], ny = normal[1], nz = normal[2];
  const double* const dx = cells.direction[0] + begin;
  const double* const dy = cells.direction[1] + begin;
  const double* const dz = cells.direction[2] + begin;
  const double* const tx = cells.half_theta[0] + begin;
  const double* const ty = cells.half_theta[1] + begin;
  const double* const tz = cells.half_theta[2] + begin;
  const double* const px = cells.half_phi[0] + begin;
  const double* const py = cells.half_phi[1] + begin;
  const double* const pz = cells.half_phi[2] + begin;
  double highest = -1.0;
  for (int i = 0; i < n; ++i) {
    const double c = nx * dx[i] + ny * dy[i] + nz * dz[i];
    const double theta = nx * tx[i] + ny * ty[i] + nz * tz[i];
    const double phi = nx * px[i] + ny * py[i] + nz * pz[i];
    const double a = __builtin_sqrt(theta * theta + phi * phi);
    out->centre[i] = c;
    out->extent[i] = a;
    const double top = c + a;
    highest = top > highest ? top : highest;
  }
  out->any_above = highest > 0.0;
}

// Without branches, so that the loop becomes vector code: what a cell below the
// horizon leaves is not read.
void SampleCells(const FarCellColumns& cells, int begin, int n,
                 const Cosines& cosines, const FarView& view,
                 FarBlock* __restrict block, int at) {
  const double* const dx = cells.direction[0] + begin;
  const double* const dy = cells.direction[1] + begin;
  const double* const dz = cells.direction[2] + begin;
  const double nx = view.n[0], ny = view.n[1], nz = view.n[2];
  const double ox = view.wo[0], oy = view.wo[1], oz = view.wo[2];
  const double near_begin = view.near_begin;
  const double per_radian = 1.0 / (view.near_end - view.near_begin);
  for (int i = 0; i < n; ++i) {
    const double c = cosines.centre[i], a = cosines.extent[i];
    // MeanClippedCosine, and CentreAboveHorizon near the horizon.
    const double cut = (c + a) * (c + a) / (4.0 * a);
    const double cosine = c >= a ? c : c > -a ? cut : 0.0;
    const double wanted = c < a ? (c + a) * (2.0 / 3.0) : c + a * a / (3.0 * c);
    const double up = c < 4.0 * a ? wanted - c : 0.0;
    double wx = dx[i] + up * nx, wy = dy[i] + up * ny, wz = dz[i] + up * nz;
    const double per_length = 1.0 / __builtin_sqrt(wx * wx + wy * wy + wz * wz);
    wx *= per_length;
    wy *= per_length;
    wz *= per_length;
    const double hx = wx + ox, hy = wy + oy, hz = wz + oz;
    const double length = __builtin_sqrt(hx * hx + hy * hy + hz * hz);
    const double per_h = 1.0 / length;
    const double n_h = (nx * hx + ny * hy + nz * hz) * per_h;
    const double cos_h = n_h < 1.0 ? n_h : 1.0;
    const double sin_h = __builtin_sqrt(1.0 - cos_h * cos_h);
    const double theta_h = FastAtan2(sin_h, cos_h);
    const double step = (theta_h - near_begin) * per_radian;
    const double x = step < 0.0 ? 0.0 : step > 1.0 ? 1.0 : step;
    const double half = 0.5 * length;
    const double cos_d = half < 1.0 ? half : 1.0;
    const double sin_d = __builtin_sqrt(1.0 - cos_d * cos_d);
    // Components of wi across and along the direction of growing theta_h, both
    // times sin(theta_h), which is not small here.
    const double across = ((ny * hz - nz * hy) * wx + (nz * hx - nx * hz) * wy +
                           (nx * hy - ny * hx) * wz) *
                          per_h;
    const double along = cos_h * cos_d - (nx * wx + ny * wy + nz * wz);
    const double phi = FastAtan2(across, along);
    const double folded = phi < 0.0 ? phi + kPi : phi;
    // ThetaHBound: the component along is sin(theta_d) cos(phi_d).
    const double bound = FastAtan2(sin_h * cos_d, along < 0.0 ? -along : along);
    const double ratio = theta_h / bound;
    block->theta_h[at + i] = theta_h;
    block->theta_d[at + i] = FastAtan2(sin_d, cos_d);
    block->phi_d[at + i] = folded >= kPi ? 0.0 : folded;
    block->x_h[at + i] = __builtin_sqrt(ratio < 1.0 ? ratio : 1.0);
    block->weight[at + i] = cosine * x * x * (3.0 - 2.0 * x);
  }
}

}  // namespace

void SampleFar(const FarCellColumns& cells, int begin, int count,
               const FarView& view, FarBlock* block) {
  Cosines cosines;
  for (int at = 0; at < count; at += kTogether) {
    const int n = count - at < kTogether ? count - at : kTogether;
    FindCosines(cells, begin + at, n, view.n, &cosines);
    if (cosines.any_above) {
      SampleCells(cells, begin + at, n, cosines, view, block, at);
    } else {
      for (int i = 0; i < n; ++i) block->weight[at + i] = 0.0;
    }
  }
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf

// Inner loop of the far rule of PointQuadrature, one version per instruction
// set. Internal.
#pragma once

namespace ibrdf {

// FarCell's vectors by component, a value per cell.
struct FarCellColumns {
  const double* direction[3];
  const double* half_theta[3];
  const double* half_phi[3];
};

// What the angles of cells depend on beside the cells.
struct FarView {
  double n[3], wo[3];           // unit, n.wo > 0
  double near_begin, near_end;  // theta_h, radians, of NearShare
};

inline constexpr int kFarBlock = 64;  // cells at once

// As FarSample's, by cell; the weight is 0 where the far rule has no sample,
// and the angles are nothing there.
struct FarBlock {
  double theta_h[kFarBlock], theta_d[kFarBlock], phi_d[kFarBlock];
  double x_h[kFarBlock], weight[kFarBlock];
};

// Of `count` <= kFarBlock cells from `begin` on.
using SampleFarFunction = void (*)(const FarCellColumns& cells, int begin,
                                   int count, const FarView& view,
                                   FarBlock* block);

namespace portable {
void SampleFar(const FarCellColumns& cells, int begin, int count,
               const FarView& view, FarBlock* block);
}
namespace avx2 {
void SampleFar(const FarCellColumns& cells, int begin, int count,
               const FarView& view, FarBlock* block);
}
namespace avx512 {
void SampleFar(const FarCellColumns& cells, int begin, int count,
               const FarView& view, FarBlock* block);
}

}  // namespace ibrdf

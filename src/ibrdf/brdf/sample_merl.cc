#include "ibrdf/brdf/sample_merl.h"

namespace ibrdf {

MerlTable SampleMerl(const BrdfFunction& brdf) {
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, -1.0);
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      for (int k = 0; k < kMerlPhiD; ++k) {
        if (!MerlBinAboveHorizon(i, j, k)) continue;
        const Eigen::Array3d f =
            brdf(MerlThetaH(i), MerlThetaD(j), MerlPhiD(k));
        for (int c = 0; c < 3; ++c) {
          table.raw[static_cast<size_t>(c) * kMerlBins +
                    MerlTable::Bin(i, j, k)] = f[c] / kMerlScale[c];
        }
      }
    }
  }
  return table;
}

}  // namespace ibrdf

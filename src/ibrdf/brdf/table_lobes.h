// A known reflectance in the place of unknown lobes.
#pragma once
#include <vector>

#include "ibrdf/brdf/lobe_model.h"

namespace ibrdf {

// Three lobes without codes, one for each channel and black in the others:
// under KnownParameters they are the table's BRDF, at the nodes of any grid.
class TableLobes final : public LobeModel {
 public:
  TableLobes(const BrdfGrid& brdf, const BrdfGridShape& grid);

  // brdf must outlive it.
  static LobeFactory Factory(const BrdfGrid& brdf);

  void Tabulate(const double* parameters, bool derivatives,
                std::vector<float>* fields) const override;
  MerlTable ToMerl(const double* parameters) const override;

  static std::vector<double> KnownParameters();

 private:
  std::vector<float> shapes_;  // [3][nodes]
};

}  // namespace ibrdf

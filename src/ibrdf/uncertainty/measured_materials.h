// A prior of roughness and gloss from measured materials.
#pragma once
#include <array>
#include <vector>

namespace ibrdf {

struct MeasuredMaterial {
  double roughness;          // [0, 1]
  std::array<double, 3> Ks;  // red, green, blue, [0, 1]
};

// The 100 materials of the MERL database (Matusik et al. 2003, CC BY-SA 4.0),
// by name: roughness of principled fits, and what they reflect beyond their
// matte part. `ibrdf_bench material-parameters` makes the numbers.
const std::vector<MeasuredMaterial>& MeasuredMaterials();

// Their counts over the cells [num_alpha, num_ks] of values in increasing order
// (PriorOfMaterials), each channel of each material once. Every cell counts one
// more, the rule of succession: 300 counts do not make a cell impossible.
std::vector<double> PriorOfMeasuredMaterials(
    const std::vector<double>& alpha_values,
    const std::vector<double>& Ks_values);

}  // namespace ibrdf

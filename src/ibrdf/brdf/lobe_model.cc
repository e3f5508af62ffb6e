#include "ibrdf/brdf/lobe_model.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {

LobeModel::LobeModel(int num_lobes, int code_size, const BrdfGridShape& grid)
    : num_lobes_(num_lobes), code_size_(code_size), grid_(grid) {
  CHECK_GE(num_lobes, 1);
}

void LobeModel::ShiftColours(const double* shift, double* parameters) const {
  for (int k = 0; k < num_lobes_; ++k) {
    double* const colour =
        parameters + static_cast<size_t>(k) * lobe_size() + code_size();
    for (int c = 0; c < 3; ++c) colour[c] += shift[c];
  }
}

BrdfGrid LobeModel::Grid(const double* parameters) const {
  std::vector<float> fields;
  Tabulate(parameters, false, &fields);
  return Combine(parameters, fields, 1);
}

BrdfGrid LobeModel::Combine(const double* parameters,
                            const std::vector<float>& fields,
                            int stride) const {
  BrdfGrid grid(grid_);
  const size_t n = grid_.num_nodes();
  for (int k = 0; k < num_lobes_; ++k) {
    const float* shape = fields.data() + static_cast<size_t>(k) * stride * n;
    for (int c = 0; c < 3; ++c) {
      const double a =
          parameters[static_cast<size_t>(k) * lobe_size() + code_size() + c];
      const float colour = static_cast<float>(
          std::exp(std::min(a, kMaxLogColour)) * kMerlScale[c]);
      float* out = grid.Channel(c);
      for (size_t i = 0; i < n; ++i) out[i] += colour * shape[i];
    }
  }
  return grid;
}

}  // namespace ibrdf

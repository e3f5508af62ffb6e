#include "ibrdf/brdf/lobe_model.h"

#include <glog/logging.h>

namespace ibrdf {

LobeModel::LobeModel(const LobeLayout& layout, const BrdfGridShape& grid)
    : layout_(layout), grid_(grid) {
  CHECK_GE(layout.num_lobes, 1);
}

void LobeModel::ShiftColours(const double* shift, double* parameters) const {
  Mixture(parameters).ShiftColours(Eigen::Map<const Eigen::Array3d>(shift));
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
  const Eigen::Array3Xf colours = Mixture(parameters).Colours().cast<float>();
  for (int k = 0; k < num_lobes(); ++k) {
    const float* shape = fields.data() + static_cast<size_t>(k) * stride * n;
    for (int c = 0; c < 3; ++c) {
      float* out = grid.Channel(c);
      for (size_t i = 0; i < n; ++i) out[i] += colours(c, k) * shape[i];
    }
  }
  return grid;
}

}  // namespace ibrdf

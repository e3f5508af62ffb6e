#include "ibrdf/flow/coupling_shape.h"

namespace ibrdf {

int CouplingShape::ActivationRows() const {
  int rows = 2;
  for (size_t i = 0; i < widths.size(); ++i) {
    rows += widths[i] * (i + 1 < widths.size() ? 2 : 1);
  }
  return rows + SplineParameters();
}

std::vector<DenseLayer> CouplingShape::DenseLayers() const {
  const int levels = static_cast<int>(widths.size());
  std::vector<int> start(levels);  // first row of a level's way down
  int row = 2;
  for (int i = 0; i < levels; ++i) {
    start[i] = row;
    row += widths[i] * (i + 1 < levels ? 2 : 1);
  }
  std::vector<DenseLayer> dense;
  size_t offset = 0, padded = 0;
  const auto add = [&](int in, int in_count, int out, int out_count,
                       bool activation) {
    DenseLayer layer{in,         in_count, out, out_count,
                     activation, offset,   0,   padded};
    padded += static_cast<size_t>(out_count) * PaddedCount(in_count);
    offset += static_cast<size_t>(in_count) * out_count;
    layer.bias_offset = offset;
    offset += out_count;
    if (dense.empty()) offset += static_cast<size_t>(widths[0]) * code_size;
    dense.push_back(layer);
  };
  add(0, 2, start[0], widths[0], true);
  for (int i = 1; i < levels; ++i) {
    add(start[i - 1], widths[i - 1], start[i], widths[i], true);
  }
  for (int i = levels - 2; i >= 0; --i) {
    // The innermost level has no way up of its own.
    const int in_count = widths[i + 1] * (i + 1 == levels - 1 ? 1 : 2);
    add(start[i + 1], in_count, start[i] + widths[i], widths[i], true);
  }
  add(start[0], widths[0] * (levels > 1 ? 2 : 1), row, SplineParameters(),
      false);
  return dense;
}

size_t CouplingShape::CodeWeightOffset() const {
  return static_cast<size_t>(widths[0]) * 3;  // after W [w0][2] and b [w0]
}

size_t CouplingShape::WeightsPerLayer() const {
  const DenseLayer last = DenseLayers().back();
  return last.bias_offset + last.out_count;
}

std::string CouplingShape::Validate() const {
  if (layers < 3 || layers > 64) return "layers must be in [3, 64]";
  if (bins < 2 || bins > 32) return "bins must be in [2, 32]";
  if (code_size < 1 || code_size > 256) return "code size must be in [1, 256]";
  if (widths.empty() || widths.size() > 8) {
    return "conditioner needs 1 to 8 widths";
  }
  for (const int w : widths) {
    if (w < 1 || w > 1024) return "conditioner widths must be in [1, 1024]";
  }
  return "";
}

}  // namespace ibrdf

#include "ibrdf/flow/triangular_shape.h"

namespace ibrdf {
namespace {

ConditionerShape MakeConditioner(int features, int bins, bool periodic,
                                 int code_size,
                                 const std::vector<int>& widths) {
  ConditionerShape c;
  c.features = features;
  c.bins = bins;
  c.periodic = periodic;
  int row = 0, next = features;
  const auto add = [&](int count, bool activation) {
    DenseLayer d;
    d.in = row;
    d.in_count = next - row;
    d.out = next;
    d.out_count = count;
    d.activation = activation;
    d.weight_offset = c.num_weights;
    c.num_weights += static_cast<size_t>(d.in_count) * count;
    if (c.dense.empty()) {
      c.code_offset = c.num_weights;
      c.num_weights += static_cast<size_t>(code_size) * count;
    }
    d.bias_offset = c.num_weights;
    c.num_weights += count;
    d.padded_offset = c.padded_weights;
    c.padded_weights += static_cast<size_t>(count) * PaddedCount(d.in_count);
    row = next;
    next += count;
    c.dense.push_back(d);
  };
  for (const int w : widths) add(w, true);
  add(c.NumParameters(), false);
  c.output_row = row;
  c.rows = next;
  return c;
}

std::string CheckWidths(const std::vector<int>& widths) {
  if (widths.empty() || widths.size() > 8) {
    return "conditioner needs 1 to 8 widths";
  }
  for (const int w : widths) {
    if (w < 1 || w > 1024) return "conditioner widths must be in [1, 1024]";
  }
  return "";
}

}  // namespace

std::array<ConditionerShape, 3> TriangularShape::Conditioners() const {
  return {MakeConditioner(kNumFeatures[0], bins[0], false, code_size, widths),
          MakeConditioner(kNumFeatures[1], bins[1], false, code_size,
                          marginal_widths),
          MakeConditioner(kNumFeatures[2], bins[2], true, code_size,
                          marginal_widths)};
}

size_t TriangularShape::NumWeights() const {
  size_t sum = 0;
  for (const ConditionerShape& c : Conditioners()) sum += c.num_weights;
  return sum;
}

std::string TriangularShape::Validate() const {
  for (const int n : bins) {
    if (n < 2 || n > 64) return "bins must be in [2, 64]";
  }
  if (code_size < 1 || code_size > 256) return "code size must be in [1, 256]";
  const std::string wrong = CheckWidths(widths);
  return wrong.empty() ? CheckWidths(marginal_widths) : wrong;
}

}  // namespace ibrdf

#include "ibrdf/render/merl_table_stack.h"

#include <glog/logging.h>

#include <algorithm>
#include <utility>

namespace ibrdf {
namespace {
int RoundUp(int n) {
  return (n + kReferenceStride - 1) / kReferenceStride * kReferenceStride;
}
}  // namespace

MerlTableStack::MerlTableStack(int count)
    : count_(count),
      stride_(RoundUp(3 * count)),
      rows_(size_t{1} * kMerlBins * stride_, 0.0f),
      valid_in_all_(kMerlBins, 1) {
  CHECK_GT(count, 0);
}

void MerlTableStack::Set(int index, const MerlTable& table) {
  CHECK(index >= 0 && index < count_);
  CHECK_EQ(table.raw.size(), size_t{3} * kMerlBins);
  std::vector<uint8_t> valid(kMerlBins);
  for (int bin = 0; bin < kMerlBins; ++bin) {
    valid[bin] = table.Raw(0, bin) >= 0.0;
    float* const row = &rows_[static_cast<size_t>(bin) * stride_];
    for (int c = 0; c < 3; ++c) {
      const double raw = valid[bin] != 0 ? table.Raw(c, bin) : 0.0;
      row[c * count_ + index] =
          static_cast<float>(std::max(raw, 0.0) * kMerlScale[c]);
    }
  }
  for (Validity& v : validities_) {
    v.tables.erase(std::remove(v.tables.begin(), v.tables.end(), index),
                   v.tables.end());
  }
  const auto same =
      std::find_if(validities_.begin(), validities_.end(),
                   [&](const Validity& v) { return v.valid == valid; });
  if (same != validities_.end()) {
    same->tables.push_back(index);
    return;
  }
  for (int bin = 0; bin < kMerlBins; ++bin) valid_in_all_[bin] &= valid[bin];
  validities_.push_back({std::move(valid), {index}});
}

void MerlTableStack::Blend(const ReferenceKernels& kernels,
                           const MerlTaps* taps, int n, float* rows) const {
  kernels.blend_rows(rows_.data(), stride_, taps, n, rows);
  for (int i = 0; i < n; ++i) {
    const bool whole =
        std::all_of(std::begin(taps[i].bin), std::end(taps[i].bin),
                    [&](int bin) { return valid_in_all_[bin] != 0; });
    if (!whole) Renormalise(taps[i], rows + static_cast<size_t>(i) * stride_);
  }
}

void MerlTableStack::Renormalise(const MerlTaps& taps, float* row) const {
  for (const Validity& v : validities_) {
    float all = 0.0f, valid = 0.0f;
    for (int k = 0; k < 8; ++k) {
      all += taps.weight[k];
      if (v.valid[taps.bin[k]] != 0) valid += taps.weight[k];
    }
    const float scale = valid > 0.0f ? all / valid : 0.0f;
    for (const int table : v.tables) {
      for (int c = 0; c < 3; ++c) row[c * count_ + table] *= scale;
    }
  }
}

}  // namespace ibrdf

// Many MERL tables that are looked up at the same angles.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/render/reference_kernels.h"

namespace ibrdf {

// Measured BRDFs, interleaved: 4 bytes a channel and bin, 17.5 MB a table.
class MerlTableStack {
 public:
  // `count` > 0 tables, all zero until set.
  explicit MerlTableStack(int count);
  void Set(int index, const MerlTable& table);
  int count() const { return count_; }

  // Rows of `stride` floats (channel * count + table): values in 1/sr of
  // InterpolateMerl times the factor of the taps.
  void Blend(const ReferenceKernels& kernels, const MerlTaps* taps, int n,
             float* rows) const;
  int stride() const { return stride_; }

 private:
  // Tables whose invalid bins are the same.
  struct Validity {
    std::vector<uint8_t> valid;  // [kMerlBins]
    std::vector<int> tables;
  };
  void Renormalise(const MerlTaps& taps, float* row) const;

  int count_, stride_;
  std::vector<float> rows_;  // [kMerlBins][stride]
  std::vector<Validity> validities_;
  std::vector<uint8_t> valid_in_all_;  // [kMerlBins]
};

}  // namespace ibrdf

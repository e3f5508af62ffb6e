// Which flow a model uses, and its sizes.
#pragma once
#include <string>

#include "ibrdf/flow/coupling_shape.h"
#include "ibrdf/flow/triangular_shape.h"

namespace ibrdf {

// kTriangular is what ships; kCoupling is the alternating stack of Chen et al.
// 2020, Sec. 4.2, kept for comparison (experiments/reflectance_model).
enum class FlowArchitecture { kTriangular, kCoupling };

struct FlowShape {
  FlowArchitecture architecture = FlowArchitecture::kTriangular;
  TriangularShape triangular;  // read where `architecture` says so
  CouplingShape coupling;      // likewise

  int code_size() const {
    return architecture == FlowArchitecture::kTriangular ? triangular.code_size
                                                         : coupling.code_size;
  }
  size_t NumWeights() const {
    return architecture == FlowArchitecture::kTriangular
               ? triangular.NumWeights()
               : coupling.NumWeights();
  }
  // Empty if the sizes make sense, else what is wrong.
  std::string Validate() const {
    return architecture == FlowArchitecture::kTriangular ? triangular.Validate()
                                                         : coupling.Validate();
  }
};

}  // namespace ibrdf

#include "ibrdf/solvers/optim/blas_kernels.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/solvers/optim/dense_algebra.h"

extern "C" {
[[gnu::weak]] char* openblas_get_corename();
}

namespace ibrdf {
namespace {

TEST(BlasKernels, OnlyTheOldestAreReplacedByWhatTheMachineHas) {
  EXPECT_EQ(BetterBlasCore("Prescott", true, true), "SkylakeX");
  EXPECT_EQ(BetterBlasCore("Prescott", true, false), "Haswell");
  EXPECT_EQ(BetterBlasCore("Prescott", false, false), "");
  EXPECT_EQ(BetterBlasCore("Zen", true, true), "");
  EXPECT_EQ(BetterBlasCore("Haswell", true, true), "");
}

TEST(BlasKernels, AreNotThoseOf2004WhereTheMachineHasNewer) {
  if (openblas_get_corename == nullptr) GTEST_SKIP() << "not OpenBLAS";
  if (std::getenv("OPENBLAS_CORETYPE") != nullptr) {
    GTEST_SKIP() << "OPENBLAS_CORETYPE is set";
  }
  if (!SimdLevelSupported(SimdLevel::kAvx2)) GTEST_SKIP() << "no AVX2";
  // What uses them, so that its file is linked.
  RowMatrix C;
  Multiply(RowMatrix::Identity(3, 3), RowMatrix::Ones(3, 3), &C);
  EXPECT_EQ(C, RowMatrix::Ones(3, 3));
  EXPECT_STRNE(openblas_get_corename(), "Prescott");
  EXPECT_EQ(std::getenv("OPENBLAS_CORETYPE"), nullptr);
}

}  // namespace
}  // namespace ibrdf

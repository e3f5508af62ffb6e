#include "ibrdf/solvers/optim/blas_kernels.h"

#include <cstdlib>

#include "ibrdf/base/simd_dispatch.h"

// OpenBLAS's own, with DYNAMIC_ARCH; weak: others have none, and no need of it.
extern "C" {
[[gnu::weak]] char* openblas_get_corename();
[[gnu::weak]] void gotoblas_dynamic_init();
[[gnu::weak]] void gotoblas_dynamic_quit();
}

namespace ibrdf {
namespace {

constexpr char kCoreVariable[] = "OPENBLAS_CORETYPE";

}  // namespace

std::string BetterBlasCore(const std::string& taken, bool has_avx2,
                           bool has_avx512) {
  if (taken != "Prescott") return "";
  return has_avx512 ? "SkylakeX" : has_avx2 ? "Haswell" : "";
}

bool TakeFittingBlasCore() {
  if (openblas_get_corename == nullptr || gotoblas_dynamic_init == nullptr ||
      gotoblas_dynamic_quit == nullptr || std::getenv(kCoreVariable)) {
    return true;
  }
  const std::string core = BetterBlasCore(
      openblas_get_corename(), SimdLevelSupported(SimdLevel::kAvx2),
      SimdLevelSupported(SimdLevel::kAvx512));
  if (core.empty()) return true;
  // It chooses once, before main, and again only after this.
  ::setenv(kCoreVariable, core.c_str(), 1);
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
  ::unsetenv(kCoreVariable);
  return true;
}

}  // namespace ibrdf

// Which of OpenBLAS's kernels run.
#pragma once

#include <string>

namespace ibrdf {

// What OPENBLAS_CORETYPE should say where OpenBLAS took its kernels of `taken`
// (openblas_get_corename()); empty to leave it as it is. OpenBLAS knows a
// processor by its model number, and takes those of 2004 (Prescott, SSE3) for a
// model newer than itself: Debian 12's (0.3.21) does for Intel's of 2023.
std::string BetterBlasCore(const std::string& taken, bool has_avx2,
                           bool has_avx512);

// Takes them, but where OPENBLAS_CORETYPE is set: that is the user's word. For
// the start of a process, with no other thread: it sets the environment for a
// moment. Does nothing to other libraries than OpenBLAS. Returns true.
bool TakeFittingBlasCore();

}  // namespace ibrdf

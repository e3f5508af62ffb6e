// Room for the linear algebra under a limit of the address space.
#pragma once
#include "ibrdf/base/status.h"

namespace ibrdf {

// OpenBLAS maps a buffer for every thread that calls it and, where it gets
// none, tries again forever. Under a limit (ulimit -v) this has it map those of
// `num_threads` threads (<= 0: all of the machine) now, or fails where they do
// not fit. Without a limit it does nothing.
Status ReserveBlasMemory(int num_threads);

}  // namespace ibrdf

// Choice of the instruction set at run time.
//
// A kernel file is compiled once per instruction set by the CMake function
// ibrdf_add_simd_kernels(), each time with another IBRDF_SIMD_NAMESPACE
// (portable, avx2, avx512), and a caller picks a function or a table of them
// by IBRDF_ACTIVE_KERNEL. Kernels agree between levels to float rounding
// (experiments/precision).
#pragma once

namespace ibrdf {

// kDouble, for checks: tables of the flow, and the illumination's network, by
// their plain references in double precision, slow; else as kPortable.
enum class SimdLevel { kPortable = 0, kAvx2 = 1, kAvx512 = 2, kDouble = 3 };

// The best instruction set of this machine, or the level named by the
// environment variable IBRDF_SIMD (portable, avx2, avx512, double) where the
// machine has it. Fixed at first call.
SimdLevel ActiveSimdLevel();

// The levels this machine can run; kPortable and kDouble are always two.
bool SimdLevelSupported(SimdLevel level);

const char* SimdLevelName(SimdLevel level);

// One of three versions of a kernel, the one for ActiveSimdLevel().
template <typename Kernel>
Kernel KernelOfActiveLevel(Kernel portable, Kernel avx2, Kernel avx512) {
  switch (ActiveSimdLevel()) {
    case SimdLevel::kAvx512:
      return avx512;
    case SimdLevel::kAvx2:
      return avx2;
    case SimdLevel::kPortable:
    case SimdLevel::kDouble:
      break;
  }
  return portable;
}

// The same of an object or function `name` of the kernels' namespaces, as a
// pointer: a macro, as two of the three are there on x86 alone.
#if defined(IBRDF_HAVE_X86_KERNELS)
#define IBRDF_ACTIVE_KERNEL(name) \
  ::ibrdf::KernelOfActiveLevel(&portable::name, &avx2::name, &avx512::name)
#else
#define IBRDF_ACTIVE_KERNEL(name) (&portable::name)
#endif

}  // namespace ibrdf

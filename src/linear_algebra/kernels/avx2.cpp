// Compiled for AVX2 where processors may have it: see CMakeLists.txt.
#if defined(__AVX2__)
#include "linear_algebra/kernels/kernel_table.h"
#else
#include "linear_algebra/kernels.h"
#endif

namespace sampled_data_observers {

const Kernels* avx2_kernels() {
#if defined(__AVX2__)
  static const bool is_there = __builtin_cpu_supports("avx2") != 0;
  return is_there ? &KernelTable<4>::kTable : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace sampled_data_observers

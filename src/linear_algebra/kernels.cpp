#include "linear_algebra/kernels.h"

namespace sampled_data_observers {

const Kernels& kernels() {
  static const Kernels& fastest = avx2_kernels() != nullptr ? *avx2_kernels() : baseline_kernels();
  return fastest;
}

}  // namespace sampled_data_observers

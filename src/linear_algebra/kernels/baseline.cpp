#include "linear_algebra/kernels/kernel_table.h"

namespace sampled_data_observers {

const Kernels& baseline_kernels() { return KernelTable<2>::kTable; }

}  // namespace sampled_data_observers

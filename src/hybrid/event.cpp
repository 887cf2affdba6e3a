#include "sampled_data_observers/hybrid/event.h"

namespace sampled_data_observers {
namespace {

template <class T>
int three_way(T a, T b) {
  return (a > b) - (a < b);
}

}  // namespace

int compare(const Event& a, const Event& b) {
  if (const int order = three_way(a.stamp, b.stamp)) return order;
  if (const int order = three_way(a.kind, b.kind)) return order;
  if (const int order = three_way(a.sensor, b.sensor)) return order;
  if (const int order = three_way(a.rejected, b.rejected)) return order;
  if (const int order = three_way(a.index, b.index)) return order;
  if (const int order = three_way(a.size, b.size)) return order;
  if (const int order = three_way(a.mode, b.mode)) return order;
  if (const int order = three_way(a.delay, b.delay)) return order;
  for (Eigen::Index i = 0; i < a.size; ++i) {
    if (const int order = three_way(a.values[i], b.values[i])) return order;
  }
  return 0;
}

}  // namespace sampled_data_observers

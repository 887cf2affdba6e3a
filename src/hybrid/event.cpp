#include "sampled_data_observers/hybrid/event.h"

namespace sampled_data_observers {
namespace {

template <class T>
int three_way(T a, T b) {
  return (a > b) - (a < b);
}

/// That of the kinds at one stamp.
int place_of(EventKind kind) {
  return kind == EventKind::kWithdrawal ? 2 * static_cast<int>(EventKind::kJump) - 1
                                        : 2 * static_cast<int>(kind);
}

}  // namespace

int compare(const Event& a, const Event& b) {
  if (const int order = three_way(a.stamp, b.stamp)) return order;
  if (const int order = three_way(place_of(a.kind), place_of(b.kind))) return order;
  if (const int order = three_way(a.sensor, b.sensor)) return order;
  if (const int order = three_way(a.rejected, b.rejected)) return order;
  if (const int order = three_way(a.index, b.index)) return order;
  if (const int order = three_way(a.size, b.size)) return order;
  if (const int order = three_way(a.covariance, b.covariance)) return order;
  if (const int order = three_way(a.mode, b.mode)) return order;
  if (const int order = three_way(a.delay, b.delay)) return order;
  for (Eigen::Index i = 0; i < a.size + a.covariance; ++i) {
    if (const int order = three_way(a.values[i], b.values[i])) return order;
  }
  return 0;
}

bool withdraws(const Event& withdrawal, const Event& jump) {
  if (withdrawal.kind != EventKind::kWithdrawal || jump.kind != EventKind::kJump) return false;
  if (withdrawal.stamp != jump.stamp || withdrawal.index != jump.index) return false;
  return jump.index != 0 || withdrawal.mode == jump.mode;
}

}  // namespace sampled_data_observers

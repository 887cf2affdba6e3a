#include "sampled_data_observers/hybrid/event.h"

#include <cstring>

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

/// By the finalizer of splitmix64: each bit of what is added changes half of the others.
std::uint64_t mixed(std::uint64_t sum, std::uint64_t added) {
  std::uint64_t z = (sum ^ added) + 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

std::uint64_t bits_of(double value) {
  const double one_zero = value + 0.0;  // -0 is no other value than 0
  std::uint64_t bits = 0;
  std::memcpy(&bits, &one_zero, sizeof bits);
  return bits;
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

std::uint64_t digest(const Event& event) {
  constexpr unsigned kByte = 8;
  constexpr unsigned kWord = 32;
  const auto kind = static_cast<std::uint64_t>(event.kind);
  const auto rejected = static_cast<std::uint64_t>(event.rejected);
  const auto sensor = static_cast<std::uint64_t>(event.sensor);
  const auto index = static_cast<std::uint64_t>(event.index);
  const auto size = static_cast<std::uint64_t>(event.size);
  const auto covariance = static_cast<std::uint64_t>(event.covariance);
  std::uint64_t sum = mixed(0, static_cast<std::uint64_t>(event.stamp));
  sum = mixed(sum, (sensor << kWord) | (rejected << kByte) | kind);
  sum = mixed(sum, (index << kWord) ^ (size << (2 * kByte)) ^ covariance);
  // Few events have these.
  if (event.delay != 0) sum = mixed(sum + 1, static_cast<std::uint64_t>(event.delay));
  if (event.mode) sum = mixed(sum + 2, bits_of(*event.mode));
  for (Eigen::Index i = 0; i < event.size + event.covariance; ++i) {
    sum = mixed(sum, bits_of(event.values[i]));
  }
  return sum;
}

bool withdraws(const Event& withdrawal, const Event& jump) {
  if (withdrawal.kind != EventKind::kWithdrawal || jump.kind != EventKind::kJump) return false;
  if (withdrawal.stamp != jump.stamp || withdrawal.index != jump.index) return false;
  return jump.index != 0 || withdrawal.mode == jump.mode;
}

}  // namespace sampled_data_observers

#include "replay/thinning.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "simulation/random_numbers.h"

namespace sampled_data_observers {

std::vector<bool> thin(const std::vector<Stamp>& stamps, Duration T1, Duration T2,
                       std::uint64_t seed) {
  std::vector<std::size_t> order(stamps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stamps[a] < stamps[b]; });

  std::vector<bool> kept(stamps.size(), false);
  RandomNumbers random(seed);
  for (std::size_t i = 0; i < order.size();) {
    const Stamp last = stamps[order[i]];
    kept[order[i]] = true;
    const Stamp target = last + static_cast<Duration>(random.uniform(static_cast<double>(T1),
                                                                     static_cast<double>(T2)));
    std::size_t next = i + 1;
    while (next < order.size() && stamps[order[next]] < last + T1) ++next;
    const auto distance = [&](std::size_t k) { return std::abs(stamps[order[k]] - target); };
    for (std::size_t k = next + 1; k < order.size() && stamps[order[k]] <= last + T2; ++k) {
      if (distance(k) < distance(next)) next = k;
    }
    i = next;
  }
  return kept;
}

std::vector<bool> thin_among(const std::vector<std::optional<Stamp>>& stamps, Duration T1,
                             Duration T2, std::uint64_t seed) {
  std::vector<Stamp> of_samples;
  for (const std::optional<Stamp>& stamp : stamps) {
    if (stamp) of_samples.push_back(*stamp);
  }
  const std::vector<bool> samples_kept = thin(of_samples, T1, T2, seed);
  std::vector<bool> kept;
  std::size_t next = 0;
  for (const std::optional<Stamp>& stamp : stamps) kept.push_back(!stamp || samples_kept[next++]);
  return kept;
}

}  // namespace sampled_data_observers

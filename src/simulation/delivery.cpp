#include "simulation/delivery.h"

#include <algorithm>

namespace sampled_data_observers {

std::vector<Stamp> DeliveryLine::send(Stamp stamp) {
  const bool lost = random_.chance(delivery_.loss);
  const bool twice = random_.chance(delivery_.duplication);
  std::vector<Stamp> arrivals;
  for (int copy = 0; copy < 2; ++copy) {
    const bool reordered = random_.chance(delivery_.reordering);
    const Duration latency = random_.whole(delivery_.shortest, delivery_.longest);
    if (lost || (copy == 1 && !twice)) continue;
    if (reordered) {
      arrivals.push_back(stamp + delivery_.longest + latency);
    } else {
      last_ = std::max(last_, stamp + latency);
      arrivals.push_back(last_);
    }
  }
  return arrivals;
}

}  // namespace sampled_data_observers

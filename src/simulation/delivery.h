#pragma once

#include <vector>

#include "sampled_data_observers/hybrid/time.h"
#include "simulation/random_numbers.h"

namespace sampled_data_observers {

/// How the messages of a topic travel.
struct Delivery {
  /// Bounds of the latency, uniformly distributed between them [ns].
  Duration shortest = 0;
  Duration longest = 0;
  /// Probabilities, in [0, 1], of messages that are lost, come twice, or are overtaken.
  double loss = 0.0;
  double duplication = 0.0;
  double reordering = 0.0;

  bool operator==(const Delivery& other) const {
    return shortest == other.shortest && longest == other.longest && loss == other.loss &&
           duplication == other.duplication && reordering == other.reordering;
  }
};

/// Gives the messages of one topic their times of arrival. They arrive in the order in which they
/// were sent, but for the reordered ones: each of these takes the longest latency and another one,
/// and waits for nobody.
class DeliveryLine {
 public:
  DeliveryLine(const Delivery& delivery, RandomNumbers random)
      : delivery_(delivery), random_(random) {}

  /// Times of arrival of a message sent at `stamp`: none, one, or two (each copy has a latency of
  /// its own). The same number of random numbers is drawn for each message.
  std::vector<Stamp> send(Stamp stamp);

 private:
  Delivery delivery_;
  RandomNumbers random_;
  /// Arrival of the last message that came in order.
  Stamp last_ = 0;
};

}  // namespace sampled_data_observers

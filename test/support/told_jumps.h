#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/simulator.h"

namespace sampled_data_observers::test {

/// The jumps that a simulation tells of, for a test to change what an observer hears of them.
/// Jumps are counted from 0, in the order of their stamps, also those dropped; those added are not.
///
/// As in scenario/jumps, nobody hears of a jump before it has happened, nor before its stamp.
class ToldJumps {
 public:
  /// @param messages  all messages of the simulator, by arrival
  ToldJumps(const Simulator& simulator, std::vector<SimulatedMessage> messages);

  /// Nobody hears of jump k.
  void drop(std::size_t k);
  /// Jump k is told of once more, with a stamp that much later [s].
  void repeat(std::size_t k, double later);
  /// A jump that never happens is told of, with what would be measured then.
  /// @param time  of a true state, since the start [s]
  /// @param mode  label of the mode that is said to follow
  void add(double time, int mode = 0);
  /// The stamps of jumps `first` to `last` are off by up to `most` [s], uniformly, either way.
  void jitter(std::size_t first, std::size_t last, double most, std::uint64_t seed = 1);

  /// All messages, by arrival.
  std::vector<SimulatedMessage> messages() &&;

 private:
  const std::vector<double>& truth_at(Stamp stamp) const;
  void move(SimulatedMessage& jump, Duration by) const;

  const Simulator& simulator_;
  std::vector<SimulatedMessage> others_;
  std::vector<SimulatedMessage> jumps_;
  std::vector<bool> is_dropped_;
  std::vector<SimulatedMessage> added_;
};

}  // namespace sampled_data_observers::test

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "faults/plant_truth.h"

namespace sampled_data_observers::test {

class FaultBench;

/// An observer into which faults are injected, and the plant that it observes.
struct Configuration {
  std::string name;
  /// Of the observer.
  std::string type = "ConstantGainObserver";
  /// Below the package.
  std::vector<std::string> files;

  Flow flow = oscillator(1.0);
  /// Where the plant is when a fault's test begins.
  State start = {1.0, 0.0};
  bool has_input = true;
  /// By how much it is pushed afterwards.
  State push = {0.0, 0.5};

  /// Sends a sample with this stamp and this value of the first state.
  std::function<void(FaultBench&, Stamp, double)> sample;
  /// Time between samples [ns].
  Duration period = 100'000'000;
  /// How near to the truth, in each state, the estimate is when it has recovered.
  double tolerance = 1e-3;
};

/// @throws std::out_of_range for a name that is none
const Configuration& configuration(const std::string& name);

}  // namespace sampled_data_observers::test

#pragma once

#include "sampled_data_observers/config/observer_config.h"
#include "textbook_plants.h"

namespace sampled_data_observers::test {

/// What a run showed, from its second half on but for the first figure.
struct Seen {
  double largest_share = 0.0;  ///< of the bound, that the error took at any time
  double worst_error = 0.0;
  double largest_bound = 0.0;
  // Root mean squares of the outputs' errors, at samples and between them.
  double estimated = 0.0;
  double held = 0.0;       ///< with the last sample for them
  double open_loop = 0.0;  ///< of a model that starts as the observer does and is not corrected
};

/// How noise and disturbance move: at random, or against the observer as far as simple signals do.
enum class Signals { kRandom, kConstant, kSwitching };

/// A plant under control, its sensor, and an observer as it is configured that hears of its input
/// and its samples.
Seen run_textbook_plant(const TextbookPlant& plant, const ObserverConfig& observer,
                        const Eigen::MatrixXd& N, double disturbance, Signals signals);

}  // namespace sampled_data_observers::test

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/plant.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

/// What an ObserverRuntime is made from.
struct RuntimeSetup {
  /// Never null.
  std::shared_ptr<const Plant> plant;
  /// An observer of that plant, never null.
  std::shared_ptr<const ObserverLaw> law;
  /// How events are admitted and kept.
  Estimator::Options options;
  /// Of the published estimates [ns].
  Duration period = 0;
  /// How long after its stamp each of them is computed [ns].
  Duration publish_delay = 0;
  /// Whether each event that is used is followed by an estimate at once.
  bool publish_on_event = false;
  /// Of the published estimates.
  std::string frame_id;
  /// One per sensor of the plant: whether it has a topic of its own. A sensor that measures at
  /// jumps has none where the jump events carry its outputs.
  std::vector<bool> has_topic;
};

}  // namespace sampled_data_observers

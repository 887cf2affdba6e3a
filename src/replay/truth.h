#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "replay/bag_source.h"
#include "replay/comparison.h"

namespace sampled_data_observers {

/// Where the truth comes from: the topic to read, the quantities to compare, and how a message
/// becomes their values.
struct Truth {
  /// Empty: there is no truth.
  std::string topic;
  std::vector<Quantity> quantities;
  /// Returns false for a message that says nothing of the truth; else sets the stamp and one value
  /// per quantity.
  using Reader = std::function<bool(const MessagePointer&, Stamp receipt, Stamp& stamp,
                                    std::vector<double>& values)>;
  Reader read;
  /// Takes what read() reads out of the bag.
  /// @throws BagMessageError
  std::function<MessagePointer(const rosbag::MessageInstance&)> take;
};

/// The truth on a topic of its own: a StateEstimate, whose states are found by name, or fields of
/// another message type.
/// @param fields  state name to field path; empty, for a StateEstimate: every state by its name
/// @throws ReplayError for a topic, state or field that does not exist.
Truth truth_from_topic(const ObserverConfig& config, const BagSet& bags, const std::string& topic,
                       const std::map<std::string, std::string>& fields,
                       const std::shared_ptr<const TransformBuffer>& transforms);

/// The samples themselves as truth of what they measure, for a thinned replay of one sensor.
/// @throws ReplayError when there are several sensors: their samples have different stamps.
Truth truth_from_samples(const ObserverConfig& config, const std::vector<BagChannel>& channels,
                         const std::shared_ptr<const TransformBuffer>& transforms);

}  // namespace sampled_data_observers

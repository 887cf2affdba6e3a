#pragma once

#include "simulation/scenario.h"

namespace sampled_data_observers {

/// Whether two sources read the same simulated messages: fields of messages of one topic. Messages
/// of this package's types, and transforms, are those of one source each, whatever their topic.
bool share_messages(const TopicSource& a, const TopicSource& b);

/// @throws ConfigError where sources of one topic can't be read from the same messages: these have
/// one type, one frame, one stamp and one time of arrival.
void check_topics(const Scenario& scenario);

}  // namespace sampled_data_observers

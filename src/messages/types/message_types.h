#pragma once

#include <map>
#include <memory>
#include <string>

#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {

using MakeMessageSource =
    std::unique_ptr<MessageSource> (*)(const TopicSource&, std::shared_ptr<const TransformBuffer>);

/// Message types by name.
using MessageTypes = std::map<std::string, MakeMessageSource>;

// Each in a file of its own: subscribing to a type takes long to compile.
void add_own_types(MessageTypes& types);
void add_std_types(MessageTypes& types);
void add_geometry_types(MessageTypes& types);
void add_stamped_geometry_types(MessageTypes& types);
void add_nav_types(MessageTypes& types);
void add_sensor_types(MessageTypes& types);

}  // namespace sampled_data_observers

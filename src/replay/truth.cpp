#include "replay/truth.h"

#include <ros/names.h>
#include <sampled_data_observers/StateEstimate.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "messages/time_conversion.h"

namespace sampled_data_observers {
namespace {

Quantity quantity_of(const Plant& plant, const std::string& state) {
  const std::optional<Quantity> quantity = state_quantity(plant, state);
  if (quantity) return *quantity;
  std::string known;
  for (const std::string& name : plant.state_names()) known += " " + name;
  throw ReplayError("--compare: expected states of the plant (" + known.substr(1) + "), found '" +
                    state + "'");
}

std::size_t place_of(const std::string& state, const StateEstimate& message) {
  const auto found = std::find(message.names.begin(), message.names.end(), state);
  return static_cast<std::size_t>(found - message.names.begin());
}

Truth truth_from_states(const Plant& plant, const std::map<std::string, std::string>& fields) {
  Truth truth;
  std::vector<std::string> sources;
  if (fields.empty()) {
    for (const std::string& state : plant.state_names()) {
      truth.quantities.push_back(quantity_of(plant, state));
      sources.push_back(state);
    }
  }
  for (const auto& [state, field] : fields) {
    truth.quantities.push_back(quantity_of(plant, state));
    sources.push_back(field);
  }
  truth.take = [sources](const rosbag::MessageInstance& instance) {
    auto message = instantiate<StateEstimate>(instance);
    for (const std::string& source : sources) {
      if (place_of(source, *message) < message->state.size()) continue;
      throw BagMessageError(instance, "it has no state called '" + source + "'");
    }
    return message;
  };
  truth.read = [sources](const MessagePointer& pointer, Stamp, Stamp& stamp,
                         std::vector<double>& values) {
    const auto message = boost::static_pointer_cast<const StateEstimate>(pointer);
    stamp = to_stamp(message->header.stamp);
    values.clear();
    for (const std::string& source : sources) {
      values.push_back(message->state[place_of(source, *message)]);
    }
    return true;
  };
  return truth;
}

/// Has all messages of a source read.
/// @param size  number of values that a message must have
void read_from(TopicSource config, const std::shared_ptr<const TransformBuffer>& transforms,
               std::shared_ptr<const MessageDefinition> definition, std::size_t size,
               Truth& truth) {
  config.min_interval = 0;
  const std::shared_ptr<MessageSource> source =
      make_message_source(config, transforms, std::move(definition));
  truth.take = [source](const rosbag::MessageInstance& instance) {
    return instantiate(*source, instance);
  };
  truth.read = [source, transforms, size](const MessagePointer& message, Stamp receipt,
                                          Stamp& stamp, std::vector<double>& values) {
    // A truth sets no datum.
    if (transforms->plane() != nullptr && transforms->datum_text().empty()) return false;
    Event event;
    if (source->read(message, receipt, event) != Reading::kEvent) return false;
    stamp = event.stamp;
    values.assign(event.values, event.values + event.size);
    return values.size() == size;
  };
}

Truth truth_from_fields(const Plant& plant, const std::string& type,
                        const std::map<std::string, std::string>& fields,
                        const std::shared_ptr<const TransformBuffer>& transforms,
                        std::shared_ptr<const MessageDefinition> definition) {
  Truth truth;
  TopicSource source;
  source.type = type;
  source.origin = "--truth, --compare";
  source.path = "truth";
  source.size = fields.size();
  for (const auto& [state, field] : fields) {
    truth.quantities.push_back(quantity_of(plant, state));
    source.fields.push_back(field);
  }
  if (fields.empty()) {
    throw ReplayError("--compare: expected STATE=FIELD for a truth of type " + type +
                      ", found nothing");
  }
  read_from(source, transforms, std::move(definition), source.size, truth);
  return truth;
}

}  // namespace

Truth truth_from_topic(const ObserverConfig& config, const BagSet& bags, const std::string& topic,
                       const std::map<std::string, std::string>& fields,
                       const std::shared_ptr<const TransformBuffer>& transforms) {
  const std::string name = bags.name_of(topic);
  const auto found = bags.topics().find(name);
  if (found == bags.topics().end()) throw ReplayError("--truth: the bag has no topic " + name);
  const std::string& type = found->second;
  Truth truth =
      type == "sampled_data_observers/StateEstimate"
          ? truth_from_states(*config.plant, fields)
          : truth_from_fields(*config.plant, type, fields, transforms, bags.definition_of(name));
  truth.topic = name;
  return truth;
}

Truth truth_from_samples(const ObserverConfig& config, const std::vector<BagChannel>& channels,
                         const std::shared_ptr<const TransformBuffer>& transforms) {
  if (config.sensors.size() != 1) {
    throw ReplayError("several sensors can't be each other's truth: name a topic with --truth");
  }
  const BagChannel& bound = channels.front();
  Truth truth;
  truth.topic = bound.topic;
  for (Eigen::Index output = 0; output < config.plant->sensors().front().outputs(); ++output) {
    std::optional<Quantity> found = output_quantity(*config.plant, 0, output);
    if (!found) {
      throw ReplayError(
          "samples of an output map that is not affine, or depends on inputs, can't be the truth: "
          "name a topic with --truth");
    }
    Quantity quantity = std::move(*found);
    for (const Quantity& other : truth.quantities) {
      if (other.name == quantity.name) quantity.name += "[" + std::to_string(output) + "]";
    }
    truth.quantities.push_back(std::move(quantity));
  }
  read_from(bound.channel.source, transforms, bound.definition, truth.quantities.size(), truth);
  return truth;
}

}  // namespace sampled_data_observers

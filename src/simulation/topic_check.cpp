#include "simulation/topic_check.h"

#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {
namespace {

/// A source with all that says when its messages come.
struct Reader {
  const TopicSource* source;
  std::string name;
  /// Where the scenario has its schedule.
  std::string schedule_path;
  /// Nothing for what is measured at jumps, and for these.
  std::optional<Schedule> schedule;
  /// Nothing for inputs, which come with the sensor that shares their messages.
  const Delivery* delivery;
};

bool has_messages_alone(const TopicSource& source) {
  return source.is_of_own_type() || source.frames.are_wanted_themselves();
}

std::vector<Reader> readers_in(const Scenario& scenario) {
  std::vector<Reader> readers;
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    const SensorScenario& sensor = scenario.sensors[i];
    if (!sensor.source) continue;
    const std::string& name = scenario.plant->sensors()[i].name;
    readers.push_back({&*sensor.source, "sensor '" + name + "'",
                       "scenario/sensors/" + name + "/schedule", sensor.schedule,
                       &sensor.delivery});
  }
  if (scenario.input) {
    const Schedule held{Schedule::Kind::kPeriodic, scenario.input->period, 0, 0, {}};
    for (const TopicSource& source : scenario.input->sources) {
      readers.push_back({&source, "an input", "scenario/input/rate", held, nullptr});
    }
  }
  return readers;
}

/// The first reader's messages are also those of `second`.
void require_same_messages(const Reader& first, const Reader& second) {
  const TopicSource& source = *second.source;
  const std::string shared =
      "since " + first.name + " reads the same messages of '" + source.topic + "'";
  const auto fault = [&](const std::string& key, const std::string& expected,
                         const std::string& found) {
    return ConfigError(source.origin, source.path + "/" + key, expected, found);
  };
  if (!(first.schedule == second.schedule)) {
    throw ConfigError(source.origin, second.schedule_path,
                      "the times of " + first.schedule_path + ", " + shared +
                          " (for times of its own, a topic of its own)",
                      "other times");
  }
  if (second.delivery != nullptr && !(*first.delivery == *second.delivery)) {
    throw ConfigError(
        source.origin, second.schedule_path.substr(0, second.schedule_path.rfind('/')),
        "the latency, loss, duplication and reordering of " + first.name + ", " + shared, "others");
  }
  if (source.stamp_offset != first.source->stamp_offset) {
    throw fault("stamp_offset", "that of " + first.name + ", " + shared, "another one");
  }
  const std::string& frame = source.frames.frame;
  const std::string& other = first.source->frames.frame;
  if (!frame.empty() && !other.empty() && frame != other) {
    throw fault("frame", "'" + other + "' or none, " + shared, "'" + frame + "'");
  }
}

}  // namespace

bool share_messages(const TopicSource& a, const TopicSource& b) {
  return a.topic == b.topic && a.type == b.type && !has_messages_alone(a) && !has_messages_alone(b);
}

void check_topics(const Scenario& scenario) {
  const auto require_topic_of_its_own = [](const TopicSource& source, const TopicSource& other) {
    if (source.topic != other.topic) return;
    if (has_messages_alone(source) && has_messages_alone(other)) return;
    throw ConfigError(source.origin, source.path + "/topic",
                      "a topic of its own, since '" + other.topic + "' is also that of " +
                          other.path + ", with messages of another type or of jumps",
                      "'" + source.topic + "'");
  };
  const std::vector<Reader> readers = readers_in(scenario);
  for (auto second = readers.begin(); second != readers.end(); ++second) {
    for (auto first = readers.begin(); first != second; ++first) {
      if (share_messages(*first->source, *second->source)) {
        require_same_messages(*first, *second);
      } else {
        require_topic_of_its_own(*second->source, *first->source);
      }
    }
    if (scenario.plant->jumps()) {
      require_topic_of_its_own(scenario.jumps_source, *second->source);
    }
  }
}

}  // namespace sampled_data_observers

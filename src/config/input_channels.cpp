#include "config/input_channels.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "config/misspelling.h"

namespace sampled_data_observers {
namespace {

const char kChannels[] = "inputs";
const char kSingle[] = "input";
const char kFields[] = "fields";

constexpr double kShortestTimeout = 1e-9;     // s: one tick of the clock
constexpr double kLongestInputTimeout = 1e6;  // s

std::string listed_inputs(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::optional<Eigen::Index> place_of_input(const std::string& name,
                                           const std::vector<std::string>& inputs) {
  const auto found = std::find(inputs.begin(), inputs.end(), name);
  if (found == inputs.end()) return std::nullopt;
  return found - inputs.begin();
}

std::string quoted_or_meant(const std::string& name, const std::vector<std::string>& inputs) {
  const std::string meant = misspelling_of(name, inputs);
  return "'" + name + "'" + (meant.empty() ? "" : "; is it a misspelling of '" + meant + "'?");
}

InputChannel read_channel(ConfigSection& channels, const std::string& name,
                          const std::vector<std::string>& inputs) {
  InputChannel channel{name, {}, 0, {}};
  ConfigSection section = channels.section(name);
  if (!section.is_map(kFields)) {
    const std::optional<Eigen::Index> input = place_of_input(name, inputs);
    if (!input) {
      throw channels.error(name,
                           "the name of an input of the plant (" + listed_inputs(inputs) +
                               "), or fields: {INPUT: FIELD, ...} in it, which say which inputs "
                               "come from there",
                           quoted_or_meant(name, inputs));
    }
    channel.inputs.push_back(*input);
    return channel;
  }
  const ConfigSection fields = section.section(kFields);
  if (fields.keys().empty()) throw section.error(kFields, "at least one input", "none");
  for (const std::string& key : fields.keys()) {
    const std::optional<Eigen::Index> input = place_of_input(key, inputs);
    if (!input) {
      throw fields.error(key, "the name of an input of the plant (" + listed_inputs(inputs) + ")",
                         quoted_or_meant(key, inputs));
    }
    channel.inputs.push_back(*input);
  }
  std::sort(channel.inputs.begin(), channel.inputs.end());
  return channel;
}

/// For how long the inputs of a channel hold, and what they are then.
void read_timeout(ConfigSection& section, const std::vector<std::string>& inputs,
                  InputChannel& channel) {
  if (section.has("timeout")) {
    channel.timeout = from_seconds(
        section.number_in("timeout", kShortestTimeout, kLongestInputTimeout, std::nullopt));
  }
  if (!section.has("after_timeout")) return;
  if (channel.timeout == 0) {
    throw section.error("after_timeout", "the key timeout beside it", "none");
  }
  ConfigSection values = section.section("after_timeout");
  for (const Eigen::Index input : channel.inputs) {
    channel.after_timeout.push_back(values.number(inputs[static_cast<std::size_t>(input)]));
  }
  values.finish();
}

/// All inputs together.
std::vector<InputChannel> read_single_channel(ConfigSection& root,
                                              const std::vector<std::string>& inputs) {
  if (inputs.empty() || !root.has(kSingle)) return {};
  InputChannel all{kSingle, std::vector<Eigen::Index>(inputs.size()), 0, {}};
  std::iota(all.inputs.begin(), all.inputs.end(), Eigen::Index{0});
  ConfigSection section = root.section(kSingle);
  read_timeout(section, inputs, all);
  return {all};
}

}  // namespace

std::vector<InputChannel> read_input_channels(ConfigSection& root,
                                              const std::vector<std::string>& inputs,
                                              const std::vector<std::string>& sensors) {
  std::vector<InputChannel> result;
  if (!root.has(kChannels)) return read_single_channel(root, inputs);
  if (inputs.empty()) throw root.error(kChannels, "none: the plant has no inputs", "some");
  if (root.has(kSingle)) {
    throw root.error(kChannels, "one of input (all from one topic) and inputs", "both");
  }
  ConfigSection channels = root.section(kChannels);
  std::vector<std::string> channel_of(inputs.size());
  for (const std::string& name : channels.keys()) {
    if (name == "jumps" || std::count(sensors.begin(), sensors.end(), name) > 0) {
      throw channels.error(name, "a name that no other source of events has", "'" + name + "'");
    }
    result.push_back(read_channel(channels, name, inputs));
    ConfigSection section = channels.section(name);
    read_timeout(section, inputs, result.back());
    for (const Eigen::Index input : result.back().inputs) {
      std::string& channel = channel_of[static_cast<std::size_t>(input)];
      if (!channel.empty()) {
        throw channels.error(
            name, "each input in one of them",
            "'" + inputs[static_cast<std::size_t>(input)] + "', which " + channel + " has, too");
      }
      channel = name;
    }
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!channel_of[i].empty()) continue;
    throw root.error(kChannels, "a source of each input (" + listed_inputs(inputs) + ")",
                     "none of '" + inputs[i] + "'");
  }
  // The parameter server knows no order of keys, so the file's order can't count.
  std::sort(result.begin(), result.end(), [](const InputChannel& a, const InputChannel& b) {
    return a.inputs.front() < b.inputs.front();
  });
  return result;
}

}  // namespace sampled_data_observers

#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers::test {

inline ObserverConfig parse(const std::string& text) {
  return read_observer_config(read_yaml_text(text, "test.yaml"), no_plant_plugins);
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(std::string::npos, at) << from;
  return text.replace(at, from.size(), to);
}

/// The message with which `read()` refuses what it reads.
template <class Read>
std::string fault_of(Read&& read) {
  try {
    read();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no fault";
}

/// The message with which a configuration is refused.
inline std::string fault(const std::string& text) {
  return fault_of([&] { parse(text); });
}

/// A good text with one thing changed.
struct Fault {
  const char* from;
  const char* to;
  /// Parts that the message must have: place, path, expected, found.
  std::vector<const char*> message;
};

/// The parts that a message lacks.
inline std::string missing_parts(const Fault& fault, const std::string& message) {
  std::string missing;
  for (const char* part : fault.message) {
    if (message.find(part) == std::string::npos) missing += std::string(part) + "; ";
  }
  return missing;
}

}  // namespace sampled_data_observers::test

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// Where the texts go that an option or an argument is given.
struct OptionValue {
  static constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();

  /// How many texts it takes.
  std::size_t least = 1;
  std::size_t most = 1;
  /// Stores what the texts mean, of which there are as many as that; empty, or what was expected
  /// and what was found.
  std::function<std::string(const std::vector<std::string>& texts)> store;
  /// What holds where the option is not given, for the help page; empty where that says nothing.
  std::string default_text;
};

// Each stores what one text means; empty, or what was expected and what was found.
std::string read_text(const std::string& text, std::string& value);
std::string read_text(const std::string& text, double& value);
std::string read_text(const std::string& text, unsigned& value);
std::string read_text(const std::string& text, std::uint64_t& value);

std::string as_text(const std::string& value);
std::string as_text(double value);
std::string as_text(unsigned value);
std::string as_text(std::uint64_t value);

/// One value. What `target` holds is the default.
template <class T>
OptionValue value_for(T& target) {
  return {
      1, 1,
      [&target](const std::vector<std::string>& texts) { return read_text(texts.front(), target); },
      as_text(target)};
}

/// N values together.
template <class T, std::size_t N>
OptionValue value_for(std::array<T, N>& target) {
  return {N, N,
          [&target](const std::vector<std::string>& texts) {
            std::string fault;
            for (std::size_t i = 0; i < N && fault.empty(); ++i) {
              fault = read_text(texts[i], target[i]);
            }
            return fault;
          },
          ""};
}

/// At least one value.
template <class T>
OptionValue value_for(std::vector<T>& target) {
  return {1, OptionValue::kAnyNumber,
          [&target](const std::vector<std::string>& texts) {
            std::string fault;
            for (const std::string& text : texts) {
              fault = read_text(text, target.emplace_back());
              if (!fault.empty()) break;
            }
            return fault;
          },
          ""};
}

/// What may not be given at all.
template <class T>
OptionValue value_for(std::optional<T>& target) {
  T shape{};
  const OptionValue value = value_for(shape);
  return {value.least, value.most,
          [&target](const std::vector<std::string>& texts) {
            return value_for(target.emplace()).store(texts);
          },
          ""};
}

}  // namespace sampled_data_observers

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// What a value of an option must be: empty for a text that is so, else what was expected and what
/// was found.
using OptionCheck = std::function<std::string(const std::string& text)>;

// Finite numbers; neither NaN nor infinity is one.
OptionCheck any_number();
OptionCheck number_above(double low);
OptionCheck number_at_least(double low);
/// `inf` too, which is not finite.
OptionCheck number_above_or_infinite(double low);
OptionCheck number_between(double low, double high);

OptionCheck whole_number_at_least(std::uint64_t low);
OptionCheck whole_number_between(std::uint64_t low, std::uint64_t high);

OptionCheck one_of(std::vector<std::string> choices);

/// A file of a format that the plot programs draw, by its ending.
OptionCheck picture_file();

}  // namespace sampled_data_observers

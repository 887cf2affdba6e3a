#include "console/option_checks.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace sampled_data_observers {
namespace {

std::string in_short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string mismatch(const std::string& expected, const std::string& found) {
  return "expected " + expected + ", found " + (found.empty() ? "nothing" : found);
}

template <class Accepts>
OptionCheck number_that(const std::string& condition, const Accepts& accepts) {
  return [=](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_number = !text.empty() && *end == '\0' && std::isfinite(value);
    return is_number && accepts(value) ? "" : mismatch("a number" + condition, text);
  };
}

template <class Accepts>
OptionCheck whole_number_that(const std::string& condition, const Accepts& accepts) {
  return [=](const std::string& text) {
    const bool is_whole = !text.empty() && std::all_of(text.begin(), text.end(),
                                                       [](char c) { return '0' <= c && c <= '9'; });
    errno = 0;
    const std::uint64_t value = is_whole ? std::strtoull(text.c_str(), nullptr, 10) : 0;
    const bool is_accepted = is_whole && errno == 0 && accepts(value);
    return is_accepted ? "" : mismatch("a whole number " + condition, text);
  };
}

}  // namespace

OptionCheck any_number() {
  return number_that("", [](double) { return true; });
}

OptionCheck number_above(double low) {
  return number_that(" > " + in_short(low), [low](double value) { return value > low; });
}

OptionCheck number_at_least(double low) {
  return number_that(" >= " + in_short(low), [low](double value) { return value >= low; });
}

OptionCheck number_above_or_infinite(double low) {
  return [finite = number_above(low)](const std::string& text) -> std::string {
    if (text == "inf") return "";
    const std::string fault = finite(text);
    return fault.empty() ? "" : fault + " (or inf)";
  };
}

OptionCheck number_between(double low, double high) {
  return number_that(" from " + in_short(low) + " to " + in_short(high),
                     [low, high](double value) { return low <= value && value <= high; });
}

OptionCheck whole_number_at_least(std::uint64_t low) {
  return whole_number_that(">= " + std::to_string(low),
                           [low](std::uint64_t value) { return value >= low; });
}

OptionCheck whole_number_between(std::uint64_t low, std::uint64_t high) {
  return whole_number_that(
      "from " + std::to_string(low) + " to " + std::to_string(high),
      [low, high](std::uint64_t value) { return low <= value && value <= high; });
}

OptionCheck one_of(std::vector<std::string> choices) {
  return [choices = std::move(choices)](const std::string& text) -> std::string {
    if (std::find(choices.begin(), choices.end(), text) != choices.end()) return "";
    std::string expected;
    for (const std::string& choice : choices) expected += (expected.empty() ? "" : ", ") + choice;
    return mismatch((choices.size() > 1 ? "one of " : "") + expected, text);
  };
}

OptionCheck picture_file() {
  return [](const std::string& path) -> std::string {
    for (const std::string ending : {".png", ".pdf", ".svg"}) {
      if (path.size() > ending.size() &&
          path.compare(path.size() - ending.size(), ending.size(), ending) == 0) {
        return "";
      }
    }
    return mismatch("a file name that ends in .png, .pdf or .svg", path);
  };
}

}  // namespace sampled_data_observers

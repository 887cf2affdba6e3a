#include "console/option_value.h"

#include <cstdio>
#include <cstdlib>

#include "console/option_checks.h"

namespace sampled_data_observers {
namespace {

template <class Whole>
std::string read_whole_number(const std::string& text, Whole& value) {
  std::string fault = whole_number_between(0, std::numeric_limits<Whole>::max())(text);
  if (fault.empty()) value = static_cast<Whole>(std::strtoull(text.c_str(), nullptr, 10));
  return fault;
}

}  // namespace

std::string read_text(const std::string& text, std::string& value) {
  value = text;
  return "";
}

std::string read_text(const std::string& text, double& value) {
  std::string fault = any_number()(text);
  if (fault.empty()) value = std::strtod(text.c_str(), nullptr);
  return fault;
}

std::string read_text(const std::string& text, unsigned& value) {
  return read_whole_number(text, value);
}

std::string read_text(const std::string& text, std::uint64_t& value) {
  return read_whole_number(text, value);
}

std::string as_text(const std::string& value) { return value; }

std::string as_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string as_text(unsigned value) { return std::to_string(value); }

std::string as_text(std::uint64_t value) { return std::to_string(value); }

}  // namespace sampled_data_observers

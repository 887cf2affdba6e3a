#include "design_arguments.h"

#include <CLI/Error.hpp>
#include <ctime>
#include <filesystem>

namespace sampled_data_observers {
namespace {

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

}  // namespace

void assign(const std::vector<std::string>& assignments, Parameters& parameters) {
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    std::size_t used = 0;
    double value = 0.0;
    try {
      if (equals != std::string::npos) value = std::stod(assignment.substr(equals + 1), &used);
    } catch (const std::logic_error&) {
      used = 0;
    }
    if (equals == std::string::npos || equals == 0 || used + equals + 1 != assignment.size()) {
      throw CLI::ValidationError("--set", "expected NAME=NUMBER, found '" + assignment + "'");
    }
    parameters[assignment.substr(0, equals)] = value;
  }
}

GainFileOrigin origin_of(const std::string& output, const std::string& plant_file,
                         const std::string& plant_hash, const std::string& command_line) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(output).parent_path();
  return {fs::relative(fs::absolute(plant_file), folder).string(), plant_hash, command_line,
          today()};
}

std::string help_on_methods() {
  std::string help;
  for (const DesignMethod* method : design_methods()) {
    help += "\n  " + method->name() + ": " + method->summary();
  }
  return help;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const DesignMethod* method : design_methods()) names.push_back(method->name());
  return names;
}

}  // namespace sampled_data_observers

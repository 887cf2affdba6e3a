#include "tools/design/gain_files.h"

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "console/usage_error.h"
#include "design/yaml_text.h"
#include "files/output_file.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

namespace fs = std::filesystem;

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

}  // namespace

std::vector<std::string> plant_files_of(const std::string& gain_file,
                                        const std::vector<std::string>& given) {
  if (!given.empty()) return given;
  const ConfigNode gains = read_yaml_file(gain_file);
  ConfigSection root(gains, "");
  if (!root.has("certificate")) {
    throw root.error("certificate", "a certificate that names the plant's file, or --plant",
                     "neither");
  }
  ConfigSection plant = root.section("certificate").section("plant");
  const fs::path folder = fs::absolute(gain_file).parent_path();
  return {(folder / plant.text("file")).lexically_normal().string()};
}

void assign(const std::string& assignment, Parameters& parameters) {
  const std::size_t equals = assignment.find('=');
  std::size_t used = 0;
  double value = 0.0;
  try {
    if (equals != std::string::npos) value = std::stod(assignment.substr(equals + 1), &used);
  } catch (const std::logic_error&) {
    used = 0;
  }
  if (equals == std::string::npos || equals == 0 || used + equals + 1 != assignment.size()) {
    throw UsageError("--set", "expected NAME=NUMBER, found '" + assignment + "'");
  }
  parameters[assignment.substr(0, equals)] = value;
}

Objective objective_of(const std::string& name) {
  for (const Objective objective : {Objective::kMinFinalError, Objective::kMinGamma,
                                    Objective::kMaxT2, Objective::kMinT1, Objective::kMaxDecay}) {
    if (name == to_string(objective)) return objective;
  }
  return Objective::kFeasible;
}

GainFileOrigin origin_of(const std::string& output, const std::string& plant_file,
                         const std::string& plant_hash, const std::string& command_line) {
  const fs::path folder = fs::absolute(output).parent_path();
  const std::string name = fs::relative(fs::absolute(plant_file), folder).string();
  try {
    yaml_scalar(name);
  } catch (const std::invalid_argument& fault) {
    throw UsageError("PLANT",
                     std::string(fault.what()) + " in its name, which the gain file gives");
  }
  return {name, plant_hash, command_line, today()};
}

std::string save_gain_file(const Design& design, const GainFileOrigin& origin,
                           const std::string& output) {
  std::ostringstream text;
  write_gain_file(design, origin, text);
  write_output(output, text.str());
  return text.str();
}

}  // namespace sampled_data_observers

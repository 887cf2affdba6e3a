#include "simulation/schedule_config.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>

namespace sampled_data_observers {
namespace {

void read_bounds(ConfigSection& section, const std::string& key, Schedule& schedule) {
  const Eigen::VectorXd bounds = section.vector(key, 2);
  if (!(kShortest <= bounds(0) && bounds(0) <= bounds(1) && bounds(1) <= kLongest)) {
    throw section.error(key, "[T1, T2] with 0 < T1 <= T2", "bounds that are not so");
  }
  schedule.T1 = from_seconds(bounds(0));
  schedule.T2 = from_seconds(bounds(1));
}

/// The path of a file that a configuration names; its origins are "path:line".
std::filesystem::path beside(ConfigSection& section, const std::string& key,
                             const std::string& name) {
  std::filesystem::path path = name;
  if (path.is_absolute()) return path;
  const std::string& origin = section.origin();
  const std::size_t colon = origin.rfind(':');
  if (colon == std::string::npos) {
    throw section.error(key, "an absolute path (the configuration is not in a file)",
                        "'" + name + "'");
  }
  return std::filesystem::path(origin.substr(0, colon)).parent_path() / path;
}

/// A number that takes the whole line, but for blanks.
bool read_number(const std::string& line, double& number) {
  std::istringstream in(line);
  in.imbue(std::locale::classic());
  in >> number;
  if (in.fail()) return false;
  in >> std::ws;
  return in.eof();
}

std::vector<Duration> read_times(ConfigSection& section, const std::string& key) {
  const std::filesystem::path path = beside(section, key, section.text(key));
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file || text.bad()) {
    throw section.error(key, "a readable file of times", "none at " + path.string());
  }
  std::vector<Duration> times;
  std::istringstream lines(text.str());
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    double seconds = 0.0;
    const bool valid = read_number(line, seconds) && 0.0 <= seconds && seconds <= kLongest;
    if (!valid || (!times.empty() && from_seconds(seconds) <= times.back())) {
      throw ConfigError(path.string() + ":" + std::to_string(number), "",
                        "a time since the start [s], later than the one before", "'" + line + "'");
    }
    times.push_back(from_seconds(seconds));
  }
  if (times.empty()) throw section.error(key, "a file of times", "an empty one");
  return times;
}

}  // namespace

std::string only_key(ConfigSection& section, const std::vector<std::string>& known) {
  const std::vector<std::string> keys = section.keys();
  std::string choices;
  for (const std::string& key : known) choices += (choices.empty() ? "" : ", ") + key;
  if (keys.size() != 1 || std::find(known.begin(), known.end(), keys.front()) == known.end()) {
    std::string found;
    for (const std::string& key : keys) found += (found.empty() ? "" : ", ") + key;
    throw ConfigError(section.origin(), section.path(), "one of the keys " + choices,
                      found.empty() ? "none" : found);
  }
  return keys.front();
}

Schedule read_schedule(ConfigSection& owner, FirstOfPeriod first) {
  ConfigSection section = owner.section("schedule");
  const std::string key = only_key(section, {"uniform", "sine", "period", "file"});
  Schedule schedule;
  if (key == "period") {
    schedule.kind = Schedule::Kind::kPeriodic;
    schedule.T1 = from_seconds(section.number_in(key, kShortest, kLongest, std::nullopt));
    schedule.first = first == FirstOfPeriod::kAtStart ? 0 : schedule.T1;
  } else if (key == "file") {
    schedule.kind = Schedule::Kind::kListed;
    schedule.times = read_times(section, key);
  } else {
    schedule.kind = key == "sine" ? Schedule::Kind::kSine : Schedule::Kind::kUniform;
    read_bounds(section, key, schedule);
  }
  return schedule;
}

}  // namespace sampled_data_observers

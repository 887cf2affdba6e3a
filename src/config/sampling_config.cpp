#include "config/sampling_config.h"

#include <algorithm>
#include <utility>

#include "config/event_times.h"
#include "config/misspelling.h"
#include "config/number_text.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {
namespace {

const char kSampling[] = "sampling";

constexpr double kLongestT1 = 1e6;    // s
constexpr double kShortestT2 = 1e-9;  // s: one tick of the clock

bool is_sampled(const Sensor& sensor) { return sensor.timing == SensorTiming::kSampled; }

SamplingTimes read_times(ConfigSection section) {
  SamplingTimes times;
  times.T1 = section.number_in("T1", 0.0, kLongestT1, std::nullopt);
  times.T2 = read_longest_time(section, kShortestT2);
  if (times.T1 > times.T2) throw section.error("T2", "a number not less than T1", "T1 > T2");
  section.finish();
  return times;
}

/// Whether the section has times itself, and not a map of them by names of sensors, which may be T1
/// and T2.
bool is_for_all(ConfigSection& sampling) {
  const auto is_time = [&](const char* key) { return sampling.has(key) && !sampling.is_map(key); };
  return sampling.keys().empty() || is_time("T1") || is_time("T2");
}

void require_names_of_sampled(const ConfigSection& sampling, const Plant& plant) {
  std::vector<std::string> names;
  std::string expected;
  for (const Sensor& sensor : plant.sensors()) {
    if (!is_sampled(sensor)) continue;
    names.push_back(sensor.name);
    expected += (expected.empty() ? "" : ", ") + sensor.name;
  }
  for (const std::string& key : sampling.keys()) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    const std::string meant = misspelling_of(key, names);
    throw sampling.error(
        key, "T1 and T2, or for each sampled sensor (" + expected + ") a map of them",
        "'" + key + "'" + (meant.empty() ? "" : "; is it a misspelling of '" + meant + "'?"));
  }
}

/// Nothing where the sensor has none of its own.
std::optional<SamplingTimes> read_own_times(ConfigSection& root, const Sensor& sensor) {
  ConfigSection section = root.section("sensors").section(sensor.name);
  if (!section.has(kSampling)) return std::nullopt;
  if (!is_sampled(sensor)) {
    throw section.error(kSampling,
                        std::string("none for a sensor with measured: ") + to_string(sensor.timing),
                        "one");
  }
  return read_times(section.section(kSampling));
}

}  // namespace

bool is_inside(const SamplingTimes& inner, const SamplingTimes& outer) {
  return from_seconds(outer.T1) <= from_seconds(inner.T1) &&
         longest_from_seconds(inner.T2) <= longest_from_seconds(outer.T2);
}

std::string to_text(const SamplingTimes& times) {
  constexpr int kDigits = 12;
  return "[" + number_text(times.T1, kDigits) + ", " + number_text(times.T2, kDigits) + "] s";
}

bool SamplingConfig::is_empty() const {
  return !jumps && std::none_of(sensors.begin(), sensors.end(),
                                [](const auto& times) { return times.has_value(); });
}

SamplingConfig read_sampling_section(ConfigSection& owner, const Plant& plant) {
  SamplingConfig result;
  result.sensors.resize(plant.sensors().size());
  if (!owner.has(kSampling)) return result;
  ConfigSection section = owner.section(kSampling);
  const bool has_sampled = plant.outputs(SensorTiming::kSampled) > 0;
  if (!has_sampled) {
    result.jumps = read_times(section);
    return result;
  }
  const bool for_all = is_for_all(section);
  if (!for_all) require_names_of_sampled(section, plant);
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (!is_sampled(sensor) || !(for_all || section.has(sensor.name))) continue;
    result.sensors[i] = read_times(for_all ? section : section.section(sensor.name));
  }
  return result;
}

SamplingConfig read_sampling(ConfigSection& root, const Plant& plant) {
  SamplingConfig result = read_sampling_section(root, plant);
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    const std::optional<SamplingTimes> own = read_own_times(root, sensor);
    if (!own) continue;
    std::optional<SamplingTimes>& times = result.sensors[i];
    if (times && !is_inside(*own, *times)) {
      throw sampling_error(root, sensor,
                           "T1 and T2 inside " + to_text(*times) +
                               ", those of the section 'sampling', for which the gains were made",
                           to_text(*own));
    }
    times = own;
  }
  return result;
}

void require_sampling(ConfigSection& root, const Plant& plant, const SamplingConfig& sampling) {
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (!is_sampled(sensor) || sampling.sensors[i]) continue;
    throw root.error(kSampling,
                     "T1 and T2, the bounds on the time between two samples, here or at sensors/" +
                         sensor.name + "/" + kSampling,
                     root.has(kSampling) ? "none of " + sensor.name : root.absence_of(kSampling));
  }
}

void take_sampling(const SamplingConfig& sampling, CertificateSubject& subject) {
  std::vector<SamplingTimes> all;
  for (const auto& times : sampling.sensors) {
    if (times) all.push_back(*times);
  }
  if (sampling.jumps) all = {*sampling.jumps};
  subject.T1 = all.front().T1;
  subject.T2 = all.front().T2;
  if (all.size() > 1) set_sensor_times(subject, std::move(all));
}

ConfigError sampling_error(ConfigSection& root, const Sensor& sensor, const std::string& expected,
                           const std::string& found) {
  ConfigSection own = root.section("sensors").section(sensor.name);
  if (own.has(kSampling)) return own.error(kSampling, expected, found);
  if (!root.has(kSampling)) return root.error(kSampling, expected, found);
  ConfigSection section = root.section(kSampling);
  return is_for_all(section) ? root.error(kSampling, expected, found)
                             : section.error(sensor.name, expected, found);
}

}  // namespace sampled_data_observers

#include "replay/report/report_samples.h"

#include <algorithm>
#include <cmath>

namespace sampled_data_observers {
namespace {

/// Of 9 bytes each, which base64 makes a third longer: 2.4 MB.
constexpr std::size_t kMostSamples = 200'000;
/// Of all sensors; 12 bytes each: 1.6 MB.
constexpr std::size_t kMostIntervals = 100'000;
constexpr std::size_t kBins = 60;

std::size_t parts(std::size_t all, std::size_t most) {
  return std::max<std::size_t>(1, (all + most - 1) / most);
}

RunRecord::Samples every(std::size_t stride, const RunRecord::Samples& all) {
  RunRecord::Samples kept{all.column, all.sensor, all.output, {}, {}, {}};
  for (std::size_t i = 0; i < all.stamps.size(); ++i) {
    if (i % stride != 0 && all.outcomes[i] == EventOutcome::kUsed) continue;
    kept.stamps.push_back(all.stamps[i]);
    kept.values.push_back(all.values[i]);
    kept.outcomes.push_back(all.outcomes[i]);
  }
  return kept;
}

nlohmann::json histogram_of(const std::vector<double>& values) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  // A bin has a width, too, where all values are the same.
  const double room = *largest > *least ? 0.0 : 1e-6 + 0.01 * *largest;
  const double low = *least - room;
  const double high = *largest + room;
  std::vector<std::size_t> counts(kBins, 0);
  for (const double value : values) {
    const auto bin = static_cast<std::size_t>((value - low) / (high - low) * double{kBins});
    ++counts[std::min(bin, kBins - 1)];
  }
  return {{"low", low}, {"high", high}, {"counts", counts}};
}

}  // namespace

nlohmann::json samples_of(const ObserverConfig& config, const RunRecord& record,
                          const PackedTime& time) {
  std::size_t all = 0;
  for (const RunRecord::Samples& samples : record.samples) all += samples.stamps.size();
  nlohmann::json json = nlohmann::json::array();
  for (const RunRecord::Samples& recorded : record.samples) {
    if (recorded.stamps.empty()) continue;
    const RunRecord::Samples samples = every(parts(all, kMostSamples), recorded);
    std::vector<std::uint8_t> outcomes;
    for (const EventOutcome outcome : samples.outcomes) {
      outcomes.push_back(static_cast<std::uint8_t>(outcome));
    }
    const Quantity& quantity = record.columns[samples.column].quantity;
    json.push_back({{"column", samples.column},
                    {"sensor", config.plant->sensors()[samples.sensor].name},
                    {"times", packed(samples.stamps, time)},
                    {"values", packed(wrapped(quantity, samples.values))},
                    {"outcomes", packed(outcomes)}});
  }
  return json;
}

nlohmann::json sensors_of(const ObserverConfig& config, const RunRecord& record,
                          const PackedTime& time) {
  std::size_t all = 0;
  for (const std::vector<Stamp>& stamps : record.sample_stamps) all += stamps.size();
  const ThinnedSeries thinned(parts(all, kMostIntervals));
  nlohmann::json sensors = nlohmann::json::array();
  for (std::size_t i = 0; i < record.sample_stamps.size(); ++i) {
    const Sensor& sensor = config.plant->sensors()[i];
    if (sensor.timing != SensorTiming::kSampled) continue;
    const SamplingBounds& bounds = config.options.sampling.of_sensor(i);
    const double T2 = longest_to_seconds(bounds.T2);
    nlohmann::json json = {{"name", sensor.name},
                           {"T1", to_seconds(bounds.T1)},
                           {"T2", std::isinf(T2) ? nlohmann::json() : nlohmann::json(T2)}};
    std::vector<Stamp> stamps = record.sample_stamps[i];
    std::sort(stamps.begin(), stamps.end());
    const auto unit = config.units.find(sensor.name);
    json["unit"] = unit == config.units.end() ? "" : unit->second;
    json["sample_times"] = thinned.times(stamps, time);
    std::vector<double> intervals;
    for (std::size_t k = 1; k < stamps.size(); ++k) {
      intervals.push_back(to_seconds(stamps[k] - stamps[k - 1]));
    }
    if (!intervals.empty()) {
      stamps.erase(stamps.begin());
      json["interval_times"] = thinned.times(stamps, time);
      json["intervals"] = thinned.values(intervals);
      json["histogram"] = histogram_of(intervals);
    }
    sensors.push_back(std::move(json));
  }
  return sensors;
}

}  // namespace sampled_data_observers

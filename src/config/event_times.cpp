#include "config/event_times.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "config/number_text.h"
#include "config/size_limits.h"

namespace sampled_data_observers {
namespace {

constexpr double kNoLongest = std::numeric_limits<double>::infinity();
constexpr double kShortestDwellTime = 1e-9;  // s: one tick of the clock
constexpr double kLongestTimeBetween = 1e6;  // s
constexpr std::size_t kMostN0 = 10000;

}  // namespace

DwellTime read_dwell_time(ConfigSection section, DwellTime::Kind kind) {
  DwellTime dwell_time;
  dwell_time.kind = kind;
  dwell_time.tau = section.number_in("tau", kShortestDwellTime, kLongestTimeBetween, std::nullopt);
  section.number("N0");
  dwell_time.N0 = static_cast<double>(section.count("N0", 1, kMostN0, 1));
  section.finish();
  return dwell_time;
}

double read_longest_time(ConfigSection& section, double least) {
  return section.number_or_infinity_in("T2", least, kLongestTimeBetween);
}

std::optional<DwellTime> read_dwell_time(ConfigSection& section) {
  const bool has_average = section.has(kAverageDwellTime);
  const bool has_reverse = section.has(kReverseAverageDwellTime);
  if (has_average && has_reverse) {
    throw section.error(kReverseAverageDwellTime,
                        "one of average_dwell_time and reverse_average_dwell_time", "both");
  }
  if (has_average) {
    return read_dwell_time(section.section(kAverageDwellTime), DwellTime::Kind::kAverage);
  }
  if (has_reverse) {
    return read_dwell_time(section.section(kReverseAverageDwellTime),
                           DwellTime::Kind::kReverseAverage);
  }
  return std::nullopt;
}

namespace {

SamplingTimes read_interval(ConfigSection& section) {
  SamplingTimes times;
  times.T1 = section.number("T1");
  if (times.T1 < 0.0) throw section.error("T1", "a number not less than 0", "a negative one");
  times.T2 = read_longest_time(section, 0.0);
  if (times.T1 > times.T2) throw section.error("T2", "0 <= T1 <= T2", "T1 > T2");
  return times;
}

/// Of the timers of a subject, as the keys of `timer_nodes` have them.
std::vector<std::string> names_of_timers(const CertificateSubject& subject) {
  std::vector<std::string> names;
  for (const SampledOutputs& outputs : subject.plant.sampled) names.push_back(outputs.sensor);
  if (names.empty()) names.emplace_back("jumps");
  return names;
}

/// "[0, 0.1]", of which a few will do.
std::string listed(const std::vector<double>& nodes) {
  constexpr std::size_t kMostListed = 8;
  std::string text = "[";
  for (std::size_t i = 0; i < nodes.size() && i < kMostListed; ++i) {
    text += (i == 0 ? "" : ", ") + number_text(nodes[i]);
  }
  return text + (nodes.size() > kMostListed ? ", ...]" : "]");
}

std::vector<double> read_nodes(ConfigSection& section, const std::string& name,
                               const SamplingTimes& times) {
  const Eigen::VectorXd list = section.vector(name, -1);
  std::vector<double> nodes(list.data(), list.data() + list.size());
  const bool increases =
      std::adjacent_find(nodes.begin(), nodes.end(), std::greater_equal<>()) == nodes.end();
  if (nodes.size() < 2 || !increases || nodes.front() != 0.0 || nodes.back() != times.T2 ||
      std::find(nodes.begin(), nodes.end(), times.T1) == nodes.end()) {
    throw section.error(name,
                        "increasing times from 0 to T2 = " + number_text(times.T2) +
                            " with T1 = " + number_text(times.T1) + " among them",
                        listed(nodes));
  }
  return nodes;
}

}  // namespace

void read_timer_nodes(ConfigSection& section, const Theorem& theorem, CertificateSubject& subject) {
  if (!section.has("timer_nodes")) return;
  ConfigSection lists = section.section("timer_nodes");
  const std::vector<std::string> names = names_of_timers(subject);
  const std::vector<SamplingTimes> times = times_of_timers(subject);
  const bool is_sum = theorem.sums_over_timers();
  std::size_t of_all = is_sum ? 0 : 1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    subject.timer_nodes.push_back(read_nodes(lists, names[i], times[i]));
    const std::size_t nodes = subject.timer_nodes.back().size();
    of_all = is_sum ? of_all + nodes : of_all * nodes;
    require_at_most(
        kMostTimerNodes, of_all,
        is_sum ? "nodes of all timers" : "nodes of the grid, the product of those of its timers",
        section, "timer_nodes");
  }
  lists.finish();
}

void read_event_times(ConfigSection& section, CertificateSubject& subject) {
  subject.dwell_time = read_dwell_time(section);
  if (subject.dwell_time) {
    subject.T1 = 0.0;
    subject.T2 = kNoLongest;
    return;
  }
  if (subject.plant.sampled.size() < 2) {
    const SamplingTimes times = read_interval(section);
    subject.T1 = times.T1;
    subject.T2 = times.T2;
    return;
  }
  ConfigSection sensors = section.section("sensors");
  std::vector<SamplingTimes> all;
  for (const SampledOutputs& outputs : subject.plant.sampled) {
    ConfigSection of_sensor = sensors.section(outputs.sensor);
    all.push_back(read_interval(of_sensor));
    of_sensor.finish();
  }
  sensors.finish();
  set_sensor_times(subject, all);
}

}  // namespace sampled_data_observers

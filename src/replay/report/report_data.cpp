#include "replay/report/report_data.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "replay/report/packed_array.h"
#include "replay/report/report_configuration.h"
#include "replay/report/report_errors.h"
#include "replay/report/report_events.h"
#include "replay/report/report_samples.h"
#include "replay/report/report_units.h"
#include "replay/report/report_verdict.h"

namespace sampled_data_observers {
namespace {

using Json = nlohmann::json;

/// Of four bytes each, which base64 makes a third longer: 6.4 MB.
constexpr std::size_t kMostValues = 1'200'000;

const char* name_of(FindingLevel level) {
  switch (level) {
    case FindingLevel::kGood:
      return "good";
    case FindingLevel::kWarning:
      return "warning";
    case FindingLevel::kBad:
      return "bad";
    case FindingLevel::kOpen:
      break;
  }
  return "open";
}

/// From the first to the last stamp of what is shown over time.
PackedTime time_of(const RunRecord& record) {
  std::vector<Stamp> ends;
  const auto add = [&ends](const std::vector<Stamp>& stamps) {
    const auto [first, last] = std::minmax_element(stamps.begin(), stamps.end());
    if (!stamps.empty()) ends.insert(ends.end(), {*first, *last});
  };
  add(record.estimates.stamps);
  add(record.compared.stamps);
  for (const std::vector<Stamp>& stamps : record.sample_stamps) add(stamps);
  for (const RunRecord::EventRow& event : record.events) ends.push_back(event.arrival);
  if (ends.empty()) return {};
  const auto [first, last] = std::minmax_element(ends.begin(), ends.end());
  return PackedTime::of_run(*first, *last);
}

std::size_t stride_of(const RunRecord& record) {
  const std::size_t columns = record.columns.size();
  const std::size_t of_estimate =
      3 + columns + record.estimates.bounds.size() + record.estimates.deviations.size();
  const std::size_t of_compared = 4 + 4 * record.compared.truth.size();
  const std::size_t all =
      of_estimate * record.estimates.stamps.size() + of_compared * record.compared.stamps.size();
  // Of each bin, two values stay.
  return all <= kMostValues ? 1 : (2 * all + kMostValues - 1) / kMostValues;
}

/// Stamps and errors that are larger than their bound, the first ones.
Json exceeded_of(const RunRecord::Compared& compared, std::size_t quantity,
                 const PackedTime& time) {
  constexpr std::size_t kMost = 10'000;
  std::vector<Stamp> stamps;
  std::vector<double> errors;
  for (std::size_t i = 0; i < compared.stamps.size() && stamps.size() < kMost; ++i) {
    const double error = compared.errors[quantity][i];
    if (!(std::abs(error) > compared.bounds[quantity][i])) continue;
    stamps.push_back(compared.stamps[i]);
    errors.push_back(error);
  }
  return {{"times", packed(stamps, time)}, {"values", packed(errors)}};
}

Json columns_of(const RunRecord& record, const Units& units, const PackedTime& time,
                std::size_t stride) {
  const ThinnedSeries thinned(stride);
  Json columns = Json::array();
  for (std::size_t i = 0; i < record.columns.size(); ++i) {
    const RunRecord::Column& column = record.columns[i];
    const Quantity& quantity = column.quantity;
    Json json = {{"name", quantity.name},
                 {"angular", quantity.angular},
                 {"unit", unit_of(quantity, units)},
                 {"estimate", thinned.values(wrapped(quantity, record.estimates.values[i]))}};
    if (!record.estimates.bounds.empty()) {
      json["bound"] = thinned.values(record.estimates.bounds[i]);
    }
    if (!record.estimates.deviations.empty()) {
      json["deviation"] = thinned.values(record.estimates.deviations[i]);
    }
    if (column.compared) {
      const std::size_t k = *column.compared;
      json["truth"] = thinned.values(wrapped(quantity, record.compared.truth[k]));
      json["error"] = thinned.values(record.compared.errors[k]);
      json["error_bound"] = thinned.values(record.compared.bounds[k]);
      json["hold_error"] = thinned.values(record.compared.hold_errors[k]);
      json["exceeded"] = exceeded_of(record.compared, k, time);
    }
    columns.push_back(std::move(json));
  }
  return columns;
}

/// Where the number of jumps, or the mode, changes from one estimate to the next.
Json changes_of(const RunRecord::Estimates& estimates, const PackedTime& time) {
  std::vector<Stamp> stamps;
  std::vector<std::uint32_t> jumps;
  Json modes = Json::array();
  for (std::size_t i = 0; i < estimates.stamps.size(); ++i) {
    const bool is_jump = i == 0 || estimates.jumps[i] != estimates.jumps[i - 1];
    const bool is_switch =
        !estimates.modes.empty() && (i == 0 || estimates.modes[i] != estimates.modes[i - 1]);
    if (!is_jump && !is_switch) continue;
    stamps.push_back(estimates.stamps[i]);
    jumps.push_back(static_cast<std::uint32_t>(estimates.jumps[i]));
    if (!estimates.modes.empty()) modes.push_back(estimates.modes[i]);
  }
  return {{"times", packed(stamps, time)}, {"jumps", packed(jumps)}, {"modes", modes}};
}

/// Their errors, and how the norms of these went.
Json runs_beside(const std::vector<BesideRun>& runs, const PackedTime& time) {
  constexpr std::size_t kMostOfRun = 100'000;
  Json all = Json::array();
  for (const BesideRun& run : runs) {
    const RunRecord::Compared& compared = run.record.compared;
    const ThinnedSeries thinned(std::max<std::size_t>(1, 3 * compared.stamps.size() / kMostOfRun));
    all.push_back({{"name", run.name},
                   {"errors", error_table(run.summary, run.record)},
                   {"times", thinned.times(compared.stamps, time)},
                   {"norm", thinned.sizes(compared.norms)}});
  }
  return all;
}

/// From the first to the last stamp that the summary counts [s]; null where it counts all, or none.
Json counted_span(const RunRecord::Compared& compared, const PackedTime& time) {
  std::vector<Stamp> counted;
  for (std::size_t i = 0; i < compared.stamps.size(); ++i) {
    if (compared.counted[i]) counted.push_back(compared.stamps[i]);
  }
  if (counted.empty() || counted.size() == compared.stamps.size()) return nullptr;
  return {to_seconds(counted.front() - time.origin), to_seconds(counted.back() - time.origin)};
}

/// Which columns are the position of a body: null for what is no state.
Json position_of(const ObserverConfig& config) {
  if (!config.outputs) return nullptr;
  Json axes = Json::array();
  for (const BodyNumber& number : config.outputs->body.position) {
    axes.push_back(number.state ? Json(*number.state) : Json());
  }
  return axes;
}

}  // namespace

nlohmann::json report_data(const ObserverConfig& config, const std::vector<std::string>& files,
                           const ReplaySummary& summary, const RunRecord& record,
                           const std::vector<BesideRun>& beside,
                           const std::vector<SeedRun>& seeds) {
  const PackedTime time = time_of(record);
  const std::size_t stride = stride_of(record);
  const ThinnedSeries thinned(stride);
  const ErrorFigures norm = error_figures(record.compared, record.compared.norms);

  Json verdict = Json::array();
  const auto find = [&verdict](const ReportFinding& finding) {
    verdict.push_back({{"level", name_of(finding.level)}, {"text", finding.text}});
  };
  for (const ReportFinding& finding : verdict_of(summary, norm, config.warning)) find(finding);
  if (!seeds.empty()) find(finding_over(seeds));
  for (const BesideRun& other : beside) {
    find(finding_beside(other.name, other.summary, summary));
  }
  std::vector<Stamp> jumps;
  for (const Event& jump : record.jumps) jumps.push_back(jump.stamp);
  std::sort(jumps.begin(), jumps.end());

  Json data = {
      {"bag", summary.bag.substr(summary.bag.rfind('/') + 1)},
      {"observer", summary.observer},
      {"verdict", verdict},
      {"origin", to_seconds(time.origin)},
      {"time_unit", to_seconds(time.unit)},
      {"stride", stride},
      {"period", to_seconds(config.period)},
      {"errors", error_table(summary, record)},
      {"beside", runs_beside(beside, time)},
      {"estimate_times", thinned.times(record.estimates.stamps, time)},
      {"columns", columns_of(record, config.units, time, stride)},
      {"changes", changes_of(record.estimates, time)},
      {"jumps", packed(jumps, time)},
      {"samples", samples_of(config, record, time)},
      {"sensors", sensors_of(config, record, time)},
      {"position", position_of(config)},
      {"events", events_of(record, time)},
      {"configuration", configuration_of(config, files)},
  };
  if (!record.compared.stamps.empty()) {
    data["compared_times"] = thinned.times(record.compared.stamps, time);
    data["norm"] = thinned.sizes(record.compared.norms);
    data["norm_bound"] = thinned.sizes(record.compared.norm_bounds);
    if (!record.compared.lyapunov.empty()) {
      data["lyapunov"] = thinned.sizes(record.compared.lyapunov);
    }
    data["counted"] = counted_span(record.compared, time);
  }
  if (!seeds.empty()) data["seeds"] = seeds_of(seeds, time);
  if (!record.estimates.lyapunov_bounds.empty()) {
    data["lyapunov_bound"] = thinned.sizes(record.estimates.lyapunov_bounds);
  }
  return data;
}

}  // namespace sampled_data_observers

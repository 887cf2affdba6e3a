#include "replay/report/report_tables.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "files/csv.h"
#include "files/output_file.h"
#include "replay/report/report_units.h"
#include "sampled_data_observers/runtime/event_outcome.h"

namespace sampled_data_observers {
namespace {

const char kQuantities[] = "quantities.csv";
const char kEstimates[] = "estimates.csv";
const char kErrors[] = "errors.csv";
const char kSamples[] = "samples.csv";
const char kJumps[] = "jumps.csv";
const char kEvents[] = "events.csv";
const char kBeside[] = "beside.csv";
const char kSeeds[] = "seeds.csv";

std::string decimal(double value) {
  if (std::isnan(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", value);
  return text;
}

std::string decimal(Stamp stamp) {
  const Stamp seconds = stamp / kNanosecondsPerSecond - (stamp % kNanosecondsPerSecond < 0 ? 1 : 0);
  char text[40];
  std::snprintf(text, sizeof text, "%" PRId64 ".%09" PRId64, seconds,
                stamp - seconds * kNanosecondsPerSecond);
  return text;
}

/// A table with an entry of each column for each row.
class Table {
 public:
  Table(std::string name, const std::vector<std::string>& heads)
      : name_(std::move(name)), text_(csv_line(heads) + "\n") {}

  void add(const std::vector<std::string>& fields) { text_ += csv_line(fields) + "\n"; }

  void write(const std::string& folder) const { write_output(folder + "/" + name_, text_); }

 private:
  std::string name_;
  std::string text_;
};

/// Whatever is there of it: the entry of a list that may be empty.
std::string entry(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? decimal(values[i]) : "";
}

Table quantities_of(const ObserverConfig& config, const RunRecord& record) {
  Table table(kQuantities, {"quantity", "unit", "angular", "compared"});
  for (const RunRecord::Column& column : record.columns) {
    table.add({column.quantity.name, unit_of(column.quantity, config.units),
               column.quantity.angular ? "1" : "0", column.compared ? "1" : "0"});
  }
  return table;
}

Table estimates_of(const RunRecord& record) {
  const RunRecord::Estimates& all = record.estimates;
  std::vector<std::string> heads = {"stamp", "jumps"};
  if (!all.modes.empty()) heads.emplace_back("mode");
  for (const RunRecord::Column& column : record.columns) {
    const std::string& name = column.quantity.name;
    heads.push_back(name);
    if (!all.bounds.empty()) heads.push_back(name + "_bound");
    if (!all.deviations.empty()) heads.push_back(name + "_deviation");
  }
  if (!all.norm_bounds.empty()) heads.insert(heads.end(), {"norm_bound", "lyapunov_bound"});
  Table table(kEstimates, heads);
  std::vector<std::string> row;
  for (std::size_t i = 0; i < all.stamps.size(); ++i) {
    row = {decimal(all.stamps[i]), std::to_string(all.jumps[i])};
    if (!all.modes.empty()) row.push_back(std::to_string(all.modes[i]));
    for (std::size_t k = 0; k < record.columns.size(); ++k) {
      row.push_back(decimal(all.values[k][i]));
      if (!all.bounds.empty()) row.push_back(decimal(all.bounds[k][i]));
      if (!all.deviations.empty()) row.push_back(decimal(all.deviations[k][i]));
    }
    if (!all.norm_bounds.empty()) {
      row.insert(row.end(), {entry(all.norm_bounds, i), entry(all.lyapunov_bounds, i)});
    }
    table.add(row);
  }
  return table;
}

Table errors_of(const RunRecord& record) {
  const RunRecord::Compared& all = record.compared;
  std::vector<std::string> heads = {"stamp", "counted"};
  std::vector<std::size_t> compared;
  for (const RunRecord::Column& column : record.columns) {
    if (!column.compared) continue;
    compared.push_back(*column.compared);
    for (const char* end : {"_truth", "_error", "_bound", "_hold_error"}) {
      heads.push_back(column.quantity.name + end);
    }
  }
  heads.insert(heads.end(), {"norm", "norm_bound", "lyapunov"});
  Table table(kErrors, heads);
  std::vector<std::string> row;
  for (std::size_t i = 0; i < all.stamps.size(); ++i) {
    row = {decimal(all.stamps[i]), all.counted[i] ? "1" : "0"};
    for (const std::size_t k : compared) {
      row.insert(row.end(), {decimal(all.truth[k][i]), decimal(all.errors[k][i]),
                             decimal(all.bounds[k][i]), decimal(all.hold_errors[k][i])});
    }
    row.insert(row.end(),
               {decimal(all.norms[i]), decimal(all.norm_bounds[i]), entry(all.lyapunov, i)});
    table.add(row);
  }
  return table;
}

Table samples_of_run(const ObserverConfig& config, const RunRecord& record) {
  Table table(kSamples, {"stamp", "sensor", "output", "quantity", "value", "outcome"});
  for (const RunRecord::Samples& samples : record.samples) {
    for (std::size_t i = 0; i < samples.stamps.size(); ++i) {
      table.add({decimal(samples.stamps[i]), config.plant->sensors()[samples.sensor].name,
                 std::to_string(samples.output), record.columns[samples.column].quantity.name,
                 decimal(samples.values[i]), describe(samples.outcomes[i])});
    }
  }
  return table;
}

Table jumps_of(const RunRecord& record) {
  Table table(kJumps, {"stamp"});
  std::vector<Stamp> stamps;
  for (const Event& jump : record.jumps) stamps.push_back(jump.stamp);
  std::sort(stamps.begin(), stamps.end());
  for (const Stamp stamp : stamps) table.add({decimal(stamp)});
  return table;
}

Table events_of_run(const RunRecord& record) {
  Table table(kEvents, {"arrival", "latency", "source", "outcome", "reason", "interval",
                        "interval_check", "rewound", "innovation", "nis"});
  const auto check = [](std::uint8_t value) {
    const char* const names[] = {"", "within", "short", "long"};
    return std::string(value < 4 ? names[value] : "");
  };
  for (const RunRecord::EventRow& event : record.events) {
    table.add({decimal(event.arrival), decimal(event.latency), record.sources[event.source],
               describe(static_cast<EventOutcome>(event.outcome)), record.reasons[event.reason],
               decimal(double{event.interval}), check(event.interval_check),
               std::to_string(event.rewound), decimal(double{event.innovation}),
               decimal(double{event.nis})});
  }
  return table;
}

Table beside_of(const std::vector<BesideRun>& runs) {
  Table table(kBeside, {"gains", "stamp", "norm"});
  for (const BesideRun& run : runs) {
    const RunRecord::Compared& compared = run.record.compared;
    for (std::size_t i = 0; i < compared.stamps.size(); ++i) {
      table.add({run.name, decimal(compared.stamps[i]), decimal(compared.norms[i])});
    }
  }
  return table;
}

Table seeds_table(const std::vector<SeedRun>& runs) {
  Table table(kSeeds, {"seed", "rmse", "largest", "bound_share"});
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (const SeedRun& run : runs) {
    table.add({std::to_string(run.seed), decimal(run.rmse.value_or(kNone)),
               decimal(run.largest.value_or(kNone)), decimal(run.bound_share.value_or(kNone))});
  }
  return table;
}

}  // namespace

std::vector<std::string> table_names() {
  return {kQuantities, kEstimates, kErrors, kSamples, kJumps, kEvents, kBeside, kSeeds};
}

void write_tables(const std::string& folder, const ObserverConfig& config, const RunRecord& record,
                  const std::vector<BesideRun>& beside, const std::vector<SeedRun>& seeds) {
  if (::mkdir(folder.c_str(), 0777) != 0 && errno != EEXIST) throw OutputError(folder, errno);
  quantities_of(config, record).write(folder);
  estimates_of(record).write(folder);
  errors_of(record).write(folder);
  samples_of_run(config, record).write(folder);
  jumps_of(record).write(folder);
  events_of_run(record).write(folder);
  beside_of(beside).write(folder);
  seeds_table(seeds).write(folder);
}

}  // namespace sampled_data_observers

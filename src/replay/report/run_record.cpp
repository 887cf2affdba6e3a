#include "replay/report/run_record.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sampled_data_observers/observer/plant_observer.h"
#include "sampled_data_observers/runtime/event_report.h"

namespace sampled_data_observers {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool has_stamp_to_show(EventOutcome outcome) {
  switch (outcome) {
    case EventOutcome::kNoStamp:
    case EventOutcome::kInFuture:
    case EventOutcome::kTooOld:
    case EventOutcome::kNotFinite:
    case EventOutcome::kWrongSize:
      return false;
    default:
      return true;
  }
}

}  // namespace

RunRecorder::RunRecorder(const ObserverConfig& config, const std::vector<Quantity>& compared,
                         RunRecord& record)
    : config_(config), record_(record) {
  for (const std::string& name : config.law->estimate_names()) {
    record_.columns.push_back({*state_quantity(*config.plant, name), std::nullopt});
  }
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const auto is_it = [&](const RunRecord::Column& column) {
      return column.quantity.row == compared[i].row &&
             column.quantity.constant == compared[i].constant && !column.compared;
    };
    const auto found = std::find_if(record_.columns.begin(), record_.columns.end(), is_it);
    if (found == record_.columns.end()) {
      record_.columns.push_back({compared[i], i});
    } else {
      found->compared = i;
    }
  }
  record_.estimates.values.resize(record_.columns.size());
  record_.sample_stamps.resize(config.plant->sensors().size());
  for (auto* of_each : {&record_.compared.truth, &record_.compared.errors, &record_.compared.bounds,
                        &record_.compared.hold_errors}) {
    of_each->resize(compared.size());
  }
  for (std::size_t sensor = 0; sensor < config.plant->sensors().size(); ++sensor) {
    for (std::size_t i = 0; i < record_.columns.size(); ++i) {
      for (Eigen::Index output = 0; output < config.plant->sensors()[sensor].outputs(); ++output) {
        if (!measures(*config.plant, sensor, output, record_.columns[i].quantity)) continue;
        record_.samples.push_back({i, sensor, output, {}, {}, {}});
      }
    }
  }
}

void RunRecorder::add_estimate(const Estimate& estimate, const StateEstimate& message) {
  RunRecord::Estimates& kept = record_.estimates;
  kept.stamps.push_back(estimate.stamp);
  kept.jumps.push_back(message.jumps + message.missing_jumps);
  if (config_.plant->switches()) {
    const std::size_t mode = estimate.law->observer().mode_of(estimate.state.data());
    kept.modes.push_back(config_.plant->modes()[mode].label);
  }
  const auto size = static_cast<Eigen::Index>(message.state.size());
  const Eigen::Map<const Eigen::VectorXd> state(message.state.data(), size);
  const bool is_bounded = !message.error_bounds.empty();
  if (is_bounded) {
    kept.norm_bounds.push_back(message.error_bound);
    kept.lyapunov_bounds.push_back(
        ellipsoid_.read(estimate, message.error_bound) ? ellipsoid_.size() : kNone);
  }
  kept.bounds.resize(is_bounded ? record_.columns.size() : 0);
  kept.deviations.resize(message.covariance.empty() ? 0 : record_.columns.size());
  for (std::size_t i = 0; i < record_.columns.size(); ++i) {
    const Quantity& quantity = record_.columns[i].quantity;
    kept.values[i].push_back(quantity.value(state.data()));
    if (is_bounded) {
      const Eigen::Map<const Eigen::VectorXd> bounds(message.error_bounds.data(), size);
      kept.bounds[i].push_back(bound_on(quantity, bounds));
    }
    if (!message.covariance.empty()) {
      const Eigen::Map<const Eigen::MatrixXd> covariance(message.covariance.data(), size, size);
      const double variance = quantity.row.dot(covariance * quantity.row);
      kept.deviations[i].push_back(std::sqrt(std::max(0.0, variance)));
    }
  }
}

std::size_t RunRecorder::position(const std::string& name, Positions& known,
                                  std::vector<std::string>& names) {
  const auto [found, is_new] = known.emplace(name, names.size());
  if (is_new) names.push_back(name);
  return found->second;
}

void RunRecorder::add_event(const Event& event, const EventReport& report,
                            const EventStatus& status, Stamp arrival) {
  RunRecord::EventRow row;
  row.arrival = arrival;
  row.latency = status.latency;
  row.source = position(status.source, sources_, record_.sources);
  row.reason = position(status.reason, reasons_, record_.reasons);
  row.kind = status.kind;
  row.outcome = status.outcome;
  row.interval_check = status.interval_check;
  row.rewound = status.rewound;
  row.interval = static_cast<float>(status.interval);
  row.innovation = static_cast<float>(report.innovation);
  row.nis = static_cast<float>(status.nis);
  record_.events.push_back(row);

  const bool is_measured = event.kind == EventKind::kSample || event.kind == EventKind::kOutput ||
                           event.kind == EventKind::kJumpOutput;
  if (is_measured && has_stamp_to_show(report.outcome)) add_values(event, report.outcome);
  if (report.used() && event.kind == EventKind::kSample) {
    record_.sample_stamps[static_cast<std::size_t>(event.sensor)].push_back(event.stamp);
  }
  if (report.used() && event.kind == EventKind::kJump) {
    record_.jumps.push_back(event);
    record_.jumps.back().values = nullptr;
    record_.jumps.back().size = 0;
  }
  if (report.used() && event.kind == EventKind::kWithdrawal) {
    const auto is_taken_back = [&](const Event& jump) { return withdraws(event, jump); };
    record_.jumps.erase(std::remove_if(record_.jumps.begin(), record_.jumps.end(), is_taken_back),
                        record_.jumps.end());
  }
}

void RunRecorder::add_values(const Event& event, EventOutcome outcome) {
  for (RunRecord::Samples& samples : record_.samples) {
    if (static_cast<int>(samples.sensor) != event.sensor || samples.output >= event.size) continue;
    samples.stamps.push_back(event.stamp);
    samples.values.push_back(event.values[samples.output]);
    samples.outcomes.push_back(outcome);
  }
}

void RunRecorder::add_compared(const Estimate& estimate, double bound,
                               const std::vector<double>& truth, const Comparison::Errors& errors,
                               bool is_counted) {
  RunRecord::Compared& kept = record_.compared;
  kept.stamps.push_back(estimate.stamp);
  kept.counted.push_back(is_counted);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    kept.truth[i].push_back(truth[i]);
    kept.errors[i].push_back(errors.values[i]);
    kept.bounds[i].push_back(errors.bounds[i]);
    kept.hold_errors[i].push_back(errors.of_hold[i]);
  }
  kept.norms.push_back(errors.norm);
  kept.norm_bounds.push_back(errors.norm_bound);
  add_lyapunov(estimate, bound, errors);
}

void RunRecorder::add_lyapunov(const Estimate& estimate, double bound,
                               const Comparison::Errors& errors) {
  const Eigen::Index n = estimate.law->estimate_size();
  // The first columns are the estimated states.
  const auto begin = record_.columns.begin();
  const bool knows_all = std::all_of(begin, begin + n, [](const RunRecord::Column& column) {
    return column.compared.has_value();
  });
  if (!estimate.law->has_bound() || !knows_all) return;
  Eigen::VectorXd error(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    error(i) = errors.values[*record_.columns[static_cast<std::size_t>(i)].compared];
  }
  const bool is_known = ellipsoid_.read(estimate, bound);
  record_.compared.lyapunov.push_back(is_known ? ellipsoid_.share(error) * ellipsoid_.size()
                                               : kNone);
}

}  // namespace sampled_data_observers

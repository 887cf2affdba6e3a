#pragma once

#include <sampled_data_observers/EventStatus.h>
#include <sampled_data_observers/StateEstimate.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "replay/comparison.h"
#include "replay/report/error_ellipsoid.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/hybrid/event.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "sampled_data_observers/runtime/event_outcome.h"

namespace sampled_data_observers {

/// All that a replay published, received and compared, for its report.
struct RunRecord {
  /// What is shown over time: every estimated state, in the order of the model, then what is
  /// compared with the truth and is no state.
  struct Column {
    Quantity quantity;
    /// Its position among what is compared.
    std::optional<std::size_t> compared;
  };
  std::vector<Column> columns;

  /// The estimates as published.
  struct Estimates {
    std::vector<Stamp> stamps;
    // One vector per column, each with one entry per stamp.
    std::vector<std::vector<double>> values;
    std::vector<std::vector<double>> bounds;  ///< guaranteed, on the error; none without one
    std::vector<std::vector<double>>
        deviations;                   ///< standard deviations; none without a covariance
    std::vector<double> norm_bounds;  ///< empty without a bound
    /// W of the Lyapunov function (ErrorEllipsoid); empty without a bound, NaN where there is none.
    std::vector<double> lyapunov_bounds;
    /// Jumps up to the stamp, those that nobody told of among them.
    std::vector<std::uint64_t> jumps;
    std::vector<int> modes;  ///< labels, of a switched plant; else empty
  } estimates;

  /// The truth, and the error of the estimate of its stamp.
  struct Compared {
    std::vector<Stamp> stamps;
    /// Whether the summary counts the stamp (--from, --to).
    std::vector<bool> counted;
    // One vector per quantity, each with one entry per stamp.
    std::vector<std::vector<double>> truth;
    std::vector<std::vector<double>> errors;       ///< x̂ − x
    std::vector<std::vector<double>> bounds;       ///< infinite where there is none
    std::vector<std::vector<double>> hold_errors;  ///< of the last sample; NaN where there is none
    std::vector<double> norms;
    std::vector<double> norm_bounds;
    /// V of the error, where all states are compared and there is a bound; NaN where there is none.
    std::vector<double> lyapunov;
  } compared;

  /// What became of one event.
  struct EventRow {
    Stamp arrival = 0;
    double latency = 0.0;  ///< s
    std::size_t source = 0;
    std::size_t reason = 0;
    std::uint8_t kind = 0;  ///< as in EventStatus, like the outcome and the check
    std::uint8_t outcome = 0;
    std::uint8_t interval_check = 0;
    std::uint32_t rewound = 0;
    float interval = 0.0F;    ///< s
    float innovation = 0.0F;  ///< norm
    float nis = 0.0F;         ///< normalized innovation squared; NaN without a covariance
  };
  std::vector<EventRow> events;
  std::vector<std::string> sources;
  std::vector<std::string> reasons;

  /// What an output of a sensor measured of a column.
  struct Samples {
    std::size_t column = 0;
    std::size_t sensor = 0;
    Eigen::Index output = 0;
    std::vector<Stamp> stamps;
    std::vector<double> values;
    std::vector<EventOutcome> outcomes;
  };
  std::vector<Samples> samples;
  /// Of the samples of each sensor that were used, as they arrived.
  std::vector<std::vector<Stamp>> sample_stamps;
  /// The jumps used and not taken back, without their values.
  std::vector<Event> jumps;
};

/// Fills a RunRecord while a replay runs.
class RunRecorder {
 public:
  /// @param config    outlives it
  /// @param compared  what is compared with the truth
  /// @param record    outlives it, and is written
  RunRecorder(const ObserverConfig& config, const std::vector<Quantity>& compared,
              RunRecord& record);

  void add_estimate(const Estimate& estimate, const StateEstimate& message);
  void add_event(const Event& event, const EventReport& report, const EventStatus& status,
                 Stamp arrival);
  /// @param bound  on the norm of the estimate's error
  void add_compared(const Estimate& estimate, double bound, const std::vector<double>& truth,
                    const Comparison::Errors& errors, bool is_counted);

 private:
  /// Texts that were met before, and their positions in the record.
  using Positions = std::map<std::string, std::size_t>;
  static std::size_t position(const std::string& name, Positions& known,
                              std::vector<std::string>& names);
  void add_values(const Event& event, EventOutcome outcome);
  void add_lyapunov(const Estimate& estimate, double bound, const Comparison::Errors& errors);

  const ObserverConfig& config_;
  RunRecord& record_;
  Positions sources_;
  Positions reasons_;
  ErrorEllipsoid ellipsoid_;
};

}  // namespace sampled_data_observers

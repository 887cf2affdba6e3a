#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "replay/jump_neighbourhood.h"
#include "sampled_data_observers/runtime/run_statistics.h"

namespace sampled_data_observers {

/// The times between the used samples of a sensor, or of several, each by itself [s].
struct SampleIntervals {
  std::size_t count = 0;
  double smallest = 0.0;  ///< of no meaning, as the others, where count is 0
  double largest = 0.0;
  double sum = 0.0;
  std::size_t below_T1 = 0;
  std::size_t above_T2 = 0;

  /// 0 where there are none.
  double mean() const;

  /// Joins others.
  void add(const SampleIntervals& other);
};

/// What a replay found of one sensor that is sampled.
struct SensorSummary {
  std::string name;
  double T1 = 0.0;  ///< s, as configured
  double T2 = 0.0;  ///< s; may be infinite
  std::size_t samples_used = 0;
  SampleIntervals intervals;
};

/// What a replay found of the innovations of a sensor, of what was used.
struct InnovationSummary {
  std::string name;
  std::size_t outputs = 0;
  InnovationStatistics of;
};

/// What a replay found of one source of inputs.
struct InputSummary {
  std::string name;
  std::size_t used = 0;
  /// The longest time without one, up to the last estimate [s], and the stamp where it began [s];
  /// of no meaning where none was used.
  double longest_silence = 0.0;
  double silent_since = 0.0;
};

/// What a replay found.
struct ReplaySummary {
  std::string bag;
  std::string observer;

  std::size_t samples_used = 0;
  std::size_t samples_withheld = 0;    ///< by thinning
  std::uint64_t missing_jumps = 0;     ///< of the last estimate: that no event told of
  std::uint64_t skipped_jumps = 0;     ///< likewise: that were lost, by the numbers of the others
  std::uint64_t dwell_violations = 0;  ///< likewise: how often the times between jumps were others
  std::size_t samples_late = 0;        ///< of those used: before later events
  /// Number of rejected events by reason; samples alone and all events.
  std::map<std::string, std::size_t> rejected;
  std::size_t samples_rejected = 0;
  /// Number of samples used since a gate recovered, by what it did.
  std::map<std::string, std::size_t> recovered;
  std::size_t events_used = 0;
  std::size_t outputs_used = 0;  ///< of these: values of continuous outputs
  std::size_t jumps_used = 0;    ///< and jumps
  /// Of these: without what was measured at them, or a part of it.
  std::size_t jumps_without_outputs = 0;
  std::size_t jumps_taken_back = 0;
  /// Topics that the bag does not have, by what would come on them: the input, jumps.
  std::map<std::string, std::string> not_recorded;

  /// Of each sensor that is sampled.
  std::vector<SensorSummary> sensors;

  /// Of each sensor that is sampled or measures continuously.
  std::vector<InnovationSummary> innovations;
  /// Of each source of inputs.
  std::vector<InputSummary> inputs;
  /// Time of reception minus stamp, its median, of each source of events [s], and which of them had
  /// stamps too far in the future.
  std::map<std::string, double> latencies;
  std::vector<std::string> stamped_ahead;

  /// The datum of the local plane, as a configuration has it; empty without.
  std::string datum;

  std::size_t estimates = 0;
  /// How many of them rest on an input older than its timeout, and the stamp of the first [s].
  std::size_t input_stale = 0;
  double input_stale_since = 0.0;
  /// The last estimate.
  double final_stamp = 0.0;  ///< s
  std::vector<std::pair<std::string, double>> final_state;

  /// How the estimate ran away; empty where it did not.
  std::string diverged;

  std::size_t compared_stamps = 0;
  std::vector<std::string> compared;
  std::vector<std::optional<double>> rmse;
  std::vector<std::optional<double>> hold_rmse;
  std::optional<double> rmse_norm;
  std::optional<double> hold_rmse_norm;

  /// Apart from jumps, where that was asked for.
  std::optional<ErrorsApart> apart_from_jumps;

  /// Theorem and guarantee of a certificate that holds; empty without.
  std::string guarantee;
  /// Whether estimates have an error bound; of the stamps compared: at how many it was finite, at
  /// how many of these the error was larger, and the largest share of it that the error took.
  bool bounded = false;
  std::size_t bound_stamps = 0;
  std::size_t bound_exceeded = 0;
  std::optional<double> bound_share;
  /// The same of each quantity compared and the bound on itself.
  struct StateBound {
    std::size_t stamps = 0;
    std::size_t exceeded = 0;
    std::optional<double> share;
  };
  std::vector<StateBound> state_bounds;
  /// Of the bound on the norm and of those on the quantities in all: where that on the norm was
  /// finite, how often one of them was exceeded at most, and the largest share of its bound that an
  /// error took.
  StateBound all_bounds() const;
  /// Inputs and jumps that came after a bound that rested on their absence.
  std::size_t after_bound = 0;
  /// Whether the truth came on a topic of its own, and not from samples with their noise.
  bool truth_is_given = false;

  /// Of all sensors.
  SampleIntervals intervals() const;

  /// Whether the truth refutes the guarantee: the error, or an entry of it, was larger than its
  /// bound.
  bool is_guarantee_broken() const { return truth_is_given && all_bounds().exceeded > 0; }
  /// Where a published estimate was first without finite bound: its stamp [s], and why.
  std::optional<double> bound_lost_at;
  std::string bound_loss;

  double bag_seconds = 0.0;
  double wall_seconds = 0.0;
};

/// Why there are no errors although there is a truth.
std::string describe_no_comparison();

/// What the bound makes of times between samples outside of [T1, T2]; empty where there are none,
/// or there is no bound.
std::string describe_bound_outside(const ReplaySummary& summary);

/// The summary as a table for people.
void print_table(const ReplaySummary& summary, std::ostream& out);

/// The summary for machines; what does not exist is null.
nlohmann::json json_of(const ReplaySummary& summary);

/// The same as a file.
void write_json(const ReplaySummary& summary, const std::string& path);

}  // namespace sampled_data_observers

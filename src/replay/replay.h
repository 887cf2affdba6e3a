#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "replay/summary.h"
#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

struct RunRecord;

struct ReplayOptions {
  /// Bags to read, as one: their messages in the order of their times.
  std::vector<std::string> bags;
  /// Bag to write: the estimates and event statuses, and the messages that the observer received.
  /// Empty: none.
  std::string output;
  /// Topic of the truth; empty: none, or the samples themselves when thinning.
  std::string truth_topic;
  /// State name to field path of the truth's messages.
  std::map<std::string, std::string> truth_fields;
  struct Thinning {
    /// Of all sensors; nothing: those of each sensor, independently of the others.
    std::optional<SamplingBounds> times;
    std::uint64_t seed = 0;
  };
  std::optional<Thinning> thinning;
  /// The comparison is limited to these times after the first truth stamp [s].
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
  /// How far around jumps errors are told apart [s]; by default jumps/stamp_error, and where that
  /// is 0 they are not.
  std::optional<double> around_jumps;
  /// Whether a bag without the topic of the input will do: the input is zero then.
  bool may_lack_input = false;
};

/// Runs the observer over bags: their messages in the order and at the times in which they were
/// received, without waiting.
/// @param record  where not null, all that a report shows of the run is written there
/// @throws ReplayError, ConfigError, OutputError
ReplaySummary replay(const ObserverConfig& config, const ReplayOptions& options,
                     RunRecord* record = nullptr);

/// One of several replays of the same bags.
struct ReplayCase {
  std::vector<std::string> config;  ///< files
  std::uint64_t seed = 0;           ///< of the thinning, if any
};

/// Reads a configuration.
using ConfigLoader = std::function<ObserverConfig(const std::vector<std::string>& files)>;

/// Runs all cases, reading each message once, on as many threads as there are processors. The
/// summaries are those of replay(), but for the time, which is that of all together.
/// @param options  without output; the seed is that of each case
/// @param load     called on the calling thread; may be asked for the same files again
/// @pre there is a case
/// @throws ReplayError, ConfigError, also where configurations do not take the same events
std::vector<ReplaySummary> replay_all(const std::vector<ReplayCase>& cases,
                                      const ReplayOptions& options, const ConfigLoader& load);

}  // namespace sampled_data_observers

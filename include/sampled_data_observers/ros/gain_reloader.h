#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "sampled_data_observers/config/config_node.h"
#include "sampled_data_observers/ros/one_at_a_time.h"
#include "sampled_data_observers/ros/shared_runtime.h"

namespace sampled_data_observers {

/// Changes the gains of a live observer. A new runtime is built beside the present one, which goes
/// on meanwhile.
class GainReloader {
 public:
  /// @param tree     the whole configuration of `runtime`
  /// @param config   the same, read
  /// @param runtime  whose gains are changed
  /// @param tell     is told of the configuration after each change
  /// @throws ConfigError where there is no directory config.gains_directory.
  GainReloader(ConfigNode tree, const ObserverConfig& config, SharedRuntime& runtime,
               std::function<void(const ObserverConfig&)> tell);

  /// Another thread stays in reload().
  class Busy : public std::runtime_error {
   public:
    /// Says so.
    Busy();
  };

  /// Returns what is guaranteed with the gains of `file`, which lies below the directory.
  /// Waits up to 0.1 s where the last call is not longer ago.
  /// @throws std::runtime_error, after changing nothing, where the file or its gains are no good
  /// @throws Busy after a while
  std::string reload(const std::string& file);

 private:
  void require_same_covariances(const ObserverConfig& next, const std::string& file) const;

  OneAtATime calls_;
  std::chrono::steady_clock::time_point last_call_;
  ConfigNode tree_;
  const std::string type_;
  const std::string directory_;
  std::vector<std::optional<MessageCovariance>> covariances_;  ///< of the sensors' sources
  SharedRuntime& runtime_;
  const std::function<void(const ObserverConfig&)> tell_;
};

}  // namespace sampled_data_observers

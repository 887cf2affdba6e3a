#pragma once

#include <nodelet/nodelet.h>

#include <memory>
#include <string>

#include "sampled_data_observers/ros/callback_threads.h"
#include "sampled_data_observers/ros/clock_watch.h"
#include "sampled_data_observers/ros/diagnostics_reporter.h"
#include "sampled_data_observers/ros/estimate_publication.h"
#include "sampled_data_observers/ros/event_subscriptions.h"
#include "sampled_data_observers/ros/gain_reloader.h"
#include "sampled_data_observers/ros/master_watch.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/ros/observer_services.h"
#include "sampled_data_observers/ros/refused_publishers.h"
#include "sampled_data_observers/ros/shared_runtime.h"

namespace sampled_data_observers {

/// The nodelet of any observer type, and what those of one type derive from.
///
/// Private parameters: the configuration (read_parameter_tree()). Topics, services and what they
/// mean: doc/ros_interface.md; threads and locks: doc/architecture.md.
class ObserverNodelet : public nodelet::Nodelet {
 public:
  ~ObserverNodelet() override;

 protected:
  /// @param type  the value that the key `observer` of the configuration must have; empty: any
  explicit ObserverNodelet(std::string type);

 private:
  /// @throws ConfigError for a bad configuration, after reporting it: the nodelet does not start.
  void onInit() override;

  /// @param tree  what `config` was read from
  void start(const ConfigNode& tree, const ObserverConfig& config, const NodeLog& log);
  void stop();

  const std::string type_;
  CallbackThreads event_threads_;
  CallbackThreads control_threads_;
  CallbackThreads query_threads_;
  // Each uses those before it.
  std::unique_ptr<SharedRuntime> runtime_;
  std::unique_ptr<EstimatePublication> publication_;
  std::unique_ptr<EventSubscriptions> subscriptions_;
  std::unique_ptr<GainReloader> gains_;
  std::unique_ptr<ObserverServices> services_;
  std::unique_ptr<DiagnosticsReporter> diagnostics_;
  std::unique_ptr<MasterWatch> master_watch_;
  std::unique_ptr<RefusedPublishers> refused_publishers_;
  std::unique_ptr<ClockWatch> clock_watch_;
};

}  // namespace sampled_data_observers

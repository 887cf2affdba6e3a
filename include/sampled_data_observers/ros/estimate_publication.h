#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/timer.h>
#include <sampled_data_observers/StateEstimate.h>

#include <memory>
#include <optional>
#include <string>

#include "sampled_data_observers/messages/message_pool.h"
#include "sampled_data_observers/real_time/deadline_thread.h"
#include "sampled_data_observers/ros/estimate_outputs.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/ros/shared_runtime.h"

namespace sampled_data_observers {

/// Publishes the estimates when they are due. Under wall time a thread of its own does it, and
/// nobody else; under simulated time the callback queue of the handle: a timer, and each event.
class EstimatePublication {
 public:
  /// Advertises; publishes nothing before start().
  /// @param handle   its callback queue publishes under simulated time
  /// @param runtime  makes the estimates
  /// @param outputs  what else is to publish the estimates; may be null
  EstimatePublication(const ros::NodeHandle& handle, SharedRuntime& runtime,
                      std::unique_ptr<EstimateOutputs> outputs);

  /// From now on estimates that are due are published.
  /// @param config  when, and by what kind of thread
  /// @param log     of the nodelet, for a priority or a lock that the system refuses
  void start(const ObserverConfig& config, const NodeLog& log);

  /// To be called after each event, by the callback queue.
  void notice_event();

  /// The resolved name of the topic of StateEstimate.
  std::string topic() const { return publisher_.getTopic(); }

 private:
  DeadlineThread::Clock::time_point publish_by_thread();
  void publish_by_queue();
  void wait_for_turn();
  std::optional<Duration> publish_next();

  ros::NodeHandle handle_;
  SharedRuntime& runtime_;
  bool publish_on_event_ = false;
  /// Whether the queue holds a callback that goes on publishing.
  bool waits_for_turn_ = false;
  std::unique_ptr<MessagePool<StateEstimate>> messages_;
  ros::Publisher publisher_;
  std::unique_ptr<EstimateOutputs> outputs_;
  ros::Timer timer_;
  std::unique_ptr<DeadlineThread> thread_;
};

}  // namespace sampled_data_observers

#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/timer.h>
#include <sampled_data_observers/StateEstimate.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "sampled_data_observers/messages/message_pool.h"
#include "sampled_data_observers/real_time/deadline_thread.h"
#include "sampled_data_observers/ros/ellipsoid_output.h"
#include "sampled_data_observers/ros/estimate_outputs.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/ros/shared_runtime.h"

namespace sampled_data_observers {

/// Publishes the estimates when they are due. Under wall time one thread does it for all observers
/// of the process with the same priority, and nobody else; under simulated time the callback queue
/// of the handle: a timer, and each event. Where a runtime is taken for longer than 0.2 ms, the
/// thread comes back to that observer every 1 ms, until it is free.
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
  class MeasuredTick;

  /// What a use of the runtime led to.
  struct Step {
    /// Whether there is an estimate to publish.
    bool is_written = false;
    /// How long until there is more to do [ns].
    Duration wait = 0;
  };

  DeadlineThread::Clock::time_point publish_by_thread();
  void publish_by_queue();
  void wait_for_turn();
  Step advance(const SharedRuntime::Access& access, StateEstimate& message);
  void publish(const boost::shared_ptr<StateEstimate>& message);

  ros::NodeHandle handle_;
  SharedRuntime& runtime_;
  bool publish_on_event_ = false;
  /// Whether the queue holds a callback that goes on publishing.
  bool waits_for_turn_ = false;
  /// Of the integration up to the next estimate.
  SharedRuntime::Parts parts_;
  std::unique_ptr<MessagePool<StateEstimate>> messages_;
  ros::Publisher publisher_;
  std::unique_ptr<EstimateOutputs> outputs_;
  /// Where there is a guaranteed bound.
  std::optional<EllipsoidOutput> ellipsoid_;
  ros::Timer timer_;
  std::uint64_t ticks_ = 0;
  std::uint64_t ticks_per_second_ = 1;
  /// Processor time of the tick that is measured, so far [ns].
  Duration spent_ = 0;
  std::unique_ptr<DeadlineTask> task_;
};

}  // namespace sampled_data_observers

#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <ros/timer.h>
#include <ros/wall_timer.h>
#include <sampled_data_observers/EventStatus.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/messages/event_intake.h"
#include "sampled_data_observers/messages/message_pool.h"
#include "sampled_data_observers/messages/message_queue.h"
#include "sampled_data_observers/messages/message_source.h"
#include "sampled_data_observers/ros/estimate_publication.h"
#include "sampled_data_observers/ros/log_throttle.h"
#include "sampled_data_observers/ros/message_inbox.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/ros/refused_publishers.h"
#include "sampled_data_observers/ros/shared_runtime.h"
#include "sampled_data_observers/runtime/clock_jumps.h"

namespace sampled_data_observers {

/// Subscribes to the topics of all channels, gives their messages as events to the runtime, and
/// publishes what became of each. To be used on one callback queue of one thread. Messages wait for
/// it in a MessageQueue, so that roscpp drops none unseen.
class EventSubscriptions {
 public:
  /// Finds all faults of the channels' sources; subscribes to nothing before start().
  /// @param handle       its callback queue receives
  /// @param config       what the channels are
  /// @param runtime      takes the events
  /// @param publication  is told of each event
  /// @param log          of the nodelet
  /// @throws ConfigError for a source that make_message_source() refuses.
  EventSubscriptions(const ros::NodeHandle& handle, const ObserverConfig& config,
                     SharedRuntime& runtime, EstimatePublication& publication, NodeLog log);

  /// Takes the datum of the local plane, as a configuration has it.
  using DatumReceiver = std::function<void(const std::string&)>;

  /// Subscribes. Events of before the first time of a simulated clock wait for it.
  /// @param take_datum  called once, where there is a local plane, when its datum is known
  void start(DatumReceiver take_datum);

  /// What is expected on the topic of each channel.
  std::vector<ExpectedDefinition> expected() const;

  /// Takes in that a message came from a publisher of another definition; for any thread, after
  /// start(). Allocates nothing.
  void refuse(std::size_t channel, const RefusedPublishers::Text& sender);

 private:
  void add(const EventChannel& channel);
  void listen_to_transforms();
  void ask_for_turn();
  void use_next();
  void answer(const MessageQueue::Drop& drop);
  void watch_clock(Stamp now);
  void retry_waiting();
  void tell_of_datum();
  bool handle(const EventChannel& channel, const Event& event, Reading reading,
              const std::string& detail);
  void tell_of_rejection(const EventChannel& channel, const Event& event,
                         const EventStatus& status) const;
  LogThrottle& throttle_of(const EventChannel& channel, const EventReport& report);

  ros::NodeHandle handle_;
  SharedRuntime& runtime_;
  EstimatePublication& publication_;
  const NodeLog log_;
  /// For each channel and outcome.
  std::vector<LogThrottle> throttles_;
  const Duration history_;
  /// Whether the log said that events are used whose stamps lie behind the clock by more than that.
  bool has_told_of_old_stamps_ = false;
  MessagePool<EventStatus> statuses_;
  ros::Publisher status_publisher_;
  std::shared_ptr<TransformBuffer> transforms_;
  DatumReceiver take_datum_;  ///< none where nothing is to be told any more
  /// One for each channel, in its order.
  std::vector<std::shared_ptr<EventIntake>> intakes_;
  std::vector<ExpectedDefinition> expected_;
  std::vector<std::function<void()>> subscribe_;
  /// Its channels are followed by as many of messages that are refused: texts on their senders.
  MessageQueue messages_;
  AtOnce at_once_;
  /// A callback that uses the next message.
  const ros::CallbackInterfacePtr turn_;
  /// Where a channel has frames.
  std::optional<MessageInbox> transform_messages_;
  ClockJumps clock_;
  ros::WallTimer retry_timer_;
  /// Ends the wait for the first time of a simulated clock.
  ros::Timer clock_timer_;
  /// Gone before all that they use.
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace sampled_data_observers

#pragma once

#include <functional>
#include <memory>
#include <string>

#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/messages/message_source.h"
#include "sampled_data_observers/runtime/waiting_queue.h"

namespace sampled_data_observers {

/// The messages of one channel on their way to become events, live and in replay: those whose
/// transforms are not known yet wait for them, aside, for a bounded time.
class EventIntake {
 public:
  /// Takes what became of a message, and returns whether it is good (is_good()). The event has a
  /// stamp and, where it is one, values that live until the handler returns. The text says which
  /// transform is missing, for kNoTransform, who sent it, for kOtherDefinition, is the note of
  /// lose(), for kDropped, and is empty otherwise.
  using Handler =
      std::function<bool(const EventChannel&, const Event&, Reading, const std::string&)>;

  /// @param channel  what the events are, and for how long their messages may wait
  /// @param source   that of the channel
  /// @param handle   called from take(), retry() and give_up()
  EventIntake(EventChannel channel, std::shared_ptr<MessageSource> source, Handler handle);

  /// Takes a message of the channel's source that arrived at `now`.
  void take(const MessagePointer& message, Stamp receipt, Stamp now);

  /// Passes on that a message was dropped.
  /// @param stamp  of the event that it would have been
  /// @param note   what is to be said of it beside; may be empty
  void lose(Stamp stamp, const std::string& note);

  /// Passes on that a message came whose publisher has another definition.
  /// @param sender  what is said of it (describe_other_definition())
  void refuse(const std::string& sender);

  /// Tries again those that wait: to be called when transforms came, and now and then so that those
  /// which have waited in vain are reported.
  void retry(Stamp now);

  /// Lets nothing wait any longer.
  void give_up();

 private:
  struct Waiting {
    MessagePointer message;
    Stamp receipt = 0;
    Stamp stamp = 0;
  };

  Event make_event() const;
  void hand_over(const Event& event, Reading reading);
  void drop(const MessagePointer& message, Stamp stamp);
  void drop(const Waiting& waiting) { drop(waiting.message, waiting.stamp); }

  EventChannel channel_;
  std::shared_ptr<MessageSource> source_;
  Handler handle_;
  WaitingQueue<Waiting> waiting_;
  std::string missing_;
};

}  // namespace sampled_data_observers

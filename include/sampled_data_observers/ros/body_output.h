#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>

#include "sampled_data_observers/messages/body_messages.h"
#include "sampled_data_observers/messages/message_pool.h"

namespace sampled_data_observers {

/// Publishes a body's pose or velocity as messages of type M, for which there is a write().
template <class M>
class BodyOutput {
 public:
  /// Advertises the topic.
  /// @param handle     resolves its name
  /// @param topic      relative or absolute
  /// @param prototype  holds the frames
  BodyOutput(ros::NodeHandle& handle, const std::string& topic, const M& prototype)
      : messages_(prototype, kPoolSize), publisher_(handle.advertise<M>(topic, kQueueLength)) {}

  /// Allocates nothing here, unless subscribers hold all messages of the pool.
  void publish(const ros::Time& stamp, const BodyEstimate& body) {
    const boost::shared_ptr<M> message = messages_.take();
    message->header.stamp = stamp;
    write(body, *message);
    publisher_.publish(message);
  }

 private:
  static constexpr std::size_t kPoolSize = 16;
  static constexpr std::uint32_t kQueueLength = 100;

  MessagePool<M> messages_;
  ros::Publisher publisher_;
};

}  // namespace sampled_data_observers

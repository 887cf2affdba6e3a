#include "ros/places_of_tf.h"

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <utility>

#include "messages/queue_length.h"
#include "sampled_data_observers/messages/static_places.h"

namespace sampled_data_observers {

ConfigNode with_places_of_tf(ConfigNode tree, const NodeLog& log) {
  StaticPlaces places(std::move(tree));
  if (places.are_known()) return places.tree();
  ros::CallbackQueue queue;
  ros::NodeHandle handle;
  handle.setCallbackQueue(&queue);
  const boost::function<void(const tf2_msgs::TFMessageConstPtr&)> take =
      [&](const tf2_msgs::TFMessageConstPtr& message) {
        if (!places.are_known()) places.take(*message);
      };
  const ros::Subscriber subscriber = handle.subscribe("/tf_static", kQueueLength, take);
  log.info("waits for the places of frames on /tf_static");
  const ros::SteadyTime end =
      ros::SteadyTime::now() + ros::WallDuration(to_seconds(places.timeout()));
  while (!places.are_known() && ros::ok() && ros::SteadyTime::now() < end) {
    queue.callAvailable(ros::WallDuration(0.05));
  }
  return places.tree();
}

}  // namespace sampled_data_observers

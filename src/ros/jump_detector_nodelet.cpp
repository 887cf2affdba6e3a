#include "ros/jump_detector_nodelet.h"

#include <sampled_data_observers/JumpEvent.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "messages/queue_length.h"
#include "messages/time_conversion.h"
#include "ros/parameter_tree.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/runtime/event_report.h"

namespace sampled_data_observers {
namespace {

/// The label that a number is.
std::optional<std::int32_t> label_of(double mode) {
  const bool fits = std::abs(mode) <= std::numeric_limits<std::int32_t>::max();
  if (!fits || mode != std::floor(mode)) return std::nullopt;
  return static_cast<std::int32_t>(mode);
}

}  // namespace

JumpDetectorNodelet::JumpDetectorNodelet() : threads_(1) {}

JumpDetectorNodelet::~JumpDetectorNodelet() { threads_.stop(); }

void JumpDetectorNodelet::onInit() {
  log_.emplace(getName());
  try {
    const ConfigNode tree = read_parameter_tree(getPrivateNodeHandle());
    ConfigSection root(tree, "");
    const TopicSource config = read_detector_source(root.section("jumps").section("detector"));
    root.finish();
    source_ = make_message_source(config);
    ros::NodeHandle handle = threads_.handle(getNodeHandle());
    publisher_ = handle.advertise<JumpEvent>("jumps", kQueueLength);
    const std::vector<std::string> topics = {handle.resolveName(config.topic)};
    messages_.emplace(topics, kQueueLength, *handle.getCallbackQueue(), *log_,
                      [this](const MessageQueue::Message& message) {
                        receive(message.message, message.receipt);
                      });
    ros::NodeHandle receiving(handle);
    receiving.setCallbackQueue(&messages_->at_once());
    subscriber_ = source_->subscribe(
        receiving, kQueueLength, [this](const MessagePointer& message, Stamp receipt) {
          messages_->push({0, message, receipt, source_->stamp_of(message, receipt)});
        });
    signal_topic_ = subscriber_.getTopic();
    log_->info("jumps on %s, detected in %s (%s)", publisher_.getTopic().c_str(),
               signal_topic_.c_str(), config.type.c_str());
    threads_.start();
  } catch (const std::exception& error) {
    log_->fatal("not started: %s", error.what());
    throw;
  }
}

void JumpDetectorNodelet::receive(const MessagePointer& message, Stamp receipt) {
  Event event;
  event.kind = EventKind::kJump;
  const Reading reading = source_->read(message, receipt, event);
  if (reading == Reading::kPassedOver) return;
  if (reading != Reading::kEvent) {
    if (!throttles_[static_cast<std::size_t>(outcome_of(reading))].admits()) return;
    log_->warn("message on %s ignored: %s (stamp %.9f s, received %.9f s)", signal_topic_.c_str(),
               describe(outcome_of(reading)), to_seconds(event.stamp), to_seconds(receipt));
    return;
  }
  const auto jump = boost::make_shared<JumpEvent>();
  jump->header.stamp = to_ros_time(event.stamp);
  if (event.mode) {
    const std::optional<std::int32_t> mode = label_of(*event.mode);
    if (!mode) {
      if (!throttles_[static_cast<std::size_t>(EventOutcome::kUnknownMode)].admits()) return;
      log_->warn("jump at %.9f s ignored: its mode, %g, is no whole number",
                 to_seconds(event.stamp), *event.mode);
      return;
    }
    jump->mode = *mode;
  }
  jump->values.assign(event.values, event.values + event.size);
  publisher_.publish(jump);
  log_->info("jump at %.9f s", to_seconds(event.stamp));
}

}  // namespace sampled_data_observers

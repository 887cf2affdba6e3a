#include "replay/message_stream.h"

#include <rosbag/view.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include "console/progress_bar.h"
#include "messages/time_conversion.h"

namespace sampled_data_observers {

std::string name_of(const std::vector<std::string>& bags) {
  std::string all;
  for (const std::string& bag : bags) all += (all.empty() ? "" : " ") + bag;
  return all;
}

std::vector<std::string> transform_topics(const ObserverConfig& config, const BagSet& bags) {
  if (!has_frames(config)) return {};
  return {bags.name_of("/tf"), bags.name_of("/tf_static")};
}

Truth truth_of(const ObserverConfig& config, const ReplayOptions& options, const BagSet& bags,
               const std::vector<BagChannel>& channels,
               const std::shared_ptr<const TransformBuffer>& transforms) {
  if (!options.truth_topic.empty()) {
    return truth_from_topic(config, bags, options.truth_topic, options.truth_fields, transforms);
  }
  return options.thinning ? truth_from_samples(config, channels, transforms) : Truth();
}

bool is_thinned(const ReplayOptions& options, const EventChannel& channel) {
  return options.thinning && channel.kind == EventKind::kSample;
}

MessageStream::MessageStream(const ObserverConfig& config, const ReplayOptions& options)
    : config_(config),
      options_(options),
      bags_(options.bags),
      transforms_(std::make_shared<TransformBuffer>(config.static_transforms, config.navsat)),
      channels_(bind_channels(config, bags_, transforms_, options.may_lack_input)),
      transform_topics_(transform_topics(config, bags_)),
      truth_(truth_of(config, options, bags_, channels_, transforms_)) {
  require_truth_in_range();
}

void MessageStream::look_through(rosbag::View& view) const {
  std::set<std::string> topics(transform_topics_.begin(), transform_topics_.end());
  if (!truth_.topic.empty()) topics.insert(truth_.topic);
  for (const BagChannel& bound : channels_) topics.insert(bound.topic);
  bags_.look_through(view, {topics.begin(), topics.end()});
}

/// Else a long run would end with nothing compared.
void MessageStream::require_truth_in_range() const {
  if (truth_.topic.empty()) return;
  rosbag::View view;
  bags_.look_through(view, {truth_.topic});
  const double length = (view.getEndTime() - view.getBeginTime()).toSec();
  if (options_.from <= length) return;
  std::ostringstream text;
  text << "--from " << options_.from << ": expected at most " << length
       << " s, since that is when the truth on " << truth_.topic << " in " << name_of(options_.bags)
       << " ends";
  throw ReplayError(text.str());
}

std::vector<BagChannel> MessageStream::channels_with(
    const std::shared_ptr<TransformBuffer>& transforms) const {
  std::vector<BagChannel> channels = channels_;
  for (BagChannel& bound : channels) {
    bound.source = make_message_source(bound.channel.source, transforms, bound.definition);
  }
  return channels;
}

MessageStream::SampleStamps MessageStream::thinned_stamps() const {
  SampleStamps stamps(channels_.size());
  if (!options_.thinning) return stamps;
  const auto transforms =
      std::make_shared<TransformBuffer>(config_.static_transforms, config_.navsat);
  std::vector<BagChannel> channels = channels_with(transforms);
  rosbag::View view;
  look_through(view);
  Event event;
  for (const rosbag::MessageInstance& instance : view) {
    if (const auto message = transforms_of(instance)) {
      transforms->take(*message, are_static(instance), to_stamp(instance.getTime()));
    }
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (!is_thinned(options_, channels[i].channel)) continue;
      if (channels[i].topic != instance.getTopic()) continue;
      const bool is_none = channels[i].read(instance, event) == Reading::kPassedOver &&
                           channels[i].channel.source.frames.are_wanted_themselves();
      stamps[i].push_back(is_none ? std::nullopt : std::optional<Stamp>(event.stamp));
    }
  }
  return stamps;
}

void MessageStream::read(const std::function<void(RecordedMessage)>& take) const {
  rosbag::View view;
  look_through(view);
  ProgressBar progress("replay", view.size());
  for (const rosbag::MessageInstance& instance : view) {
    take(prepare(instance));
    progress.advance();
  }
}

boost::shared_ptr<const tf2_msgs::TFMessage> MessageStream::transforms_of(
    const rosbag::MessageInstance& instance) const {
  const auto& topics = transform_topics_;
  if (std::count(topics.begin(), topics.end(), instance.getTopic()) == 0) return nullptr;
  return instantiate<tf2_msgs::TFMessage>(instance);
}

/// @pre it holds transforms
bool MessageStream::are_static(const rosbag::MessageInstance& instance) const {
  return instance.getTopic() == transform_topics_.back();
}

RecordedMessage MessageStream::prepare(const rosbag::MessageInstance& instance) const {
  const std::string& topic = instance.getTopic();
  RecordedMessage message{instance, to_stamp(instance.getTime()), nullptr, false, {}, nullptr, {}};
  message.transforms = transforms_of(instance);
  if (message.transforms != nullptr) {
    message.are_static = are_static(instance);
    transforms_->take(*message.transforms, message.are_static, message.time);
  }
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].topic != topic) continue;
    message.of_channels.push_back(prepare(i, instance, message.time));
  }
  if (truth_.topic != topic) return message;
  message.unread_truth = truth_.take(instance);
  if (transforms_->plane() != nullptr) return message;
  RecordedMessage::OfTruth truth;
  if (truth_.read(message.unread_truth, message.time, truth.stamp, truth.values)) {
    message.truth = std::move(truth);
  }
  message.unread_truth = nullptr;
  return message;
}

/// Whether a source makes the same of the messages of a channel in every run: it is given all of
/// them, none waits for transforms, and no datum depends on what was used.
bool MessageStream::reads_for_all(const EventChannel& channel) const {
  const SourceFrames& frames = channel.source.frames;
  return !is_thinned(options_, channel) && !frames.any() && !frames.are_wanted_themselves() &&
         transforms_->plane() == nullptr;
}

RecordedMessage::OfChannel MessageStream::prepare(std::size_t channel,
                                                  const rosbag::MessageInstance& instance,
                                                  Stamp receipt) const {
  const BagChannel& bound = channels_[channel];
  RecordedMessage::OfChannel result;
  result.channel = channel;
  result.content = instantiate(*bound.source, instance);
  if (!reads_for_all(bound.channel)) return result;
  result.event.kind = bound.channel.kind;
  result.event.sensor = bound.channel.sensor;
  result.reading = bound.source->read(result.content, receipt, result.event);
  const auto numbers = result.event.numbers();
  result.values.assign(numbers.data(), numbers.data() + numbers.size());
  result.event.values = nullptr;
  return result;
}

Stamp MessageStream::end() const {
  rosbag::View all;
  bags_.look_through(all);
  return to_stamp(all.getEndTime());
}

double MessageStream::seconds() const {
  rosbag::View view;
  look_through(view);
  return view.size() > 0 ? (view.getEndTime() - view.getBeginTime()).toSec() : 0.0;
}

}  // namespace sampled_data_observers

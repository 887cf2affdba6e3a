// One nodelet of every observer type in one manager: good and bad events on each of its channels,
// what it says of them, and that its estimate is the one that the good events alone give.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "messages/time_conversion.h"
#include "messages/value_reader.h"
#include "ros/observer_client.h"
#include "sampled_data_observers/config/event_channels.h"
#include "support/type_examples.h"

namespace sampled_data_observers {
namespace {

void set_values(Measurement& message, const std::vector<double>& values) {
  message.values = values;
}
void set_values(Input& message, const std::vector<double>& values) { message.values = values; }
void set_values(JumpEvent& message, const std::vector<double>& values) {
  message.values = values;
  message.mode = 2;
  if (!message.header.stamp.isZero()) message.release = message.header.stamp + ros::Duration(0.05);
}

/// One channel of an observer under test, from outside.
class Channel {
 public:
  virtual ~Channel() = default;
  virtual bool connected() const = 0;
  virtual void publish(const ros::Time& stamp, const std::vector<double>& values) = 0;
  /// Gives the observer in this process the same event.
  virtual void submit(Estimator& reference, const ros::Time& stamp,
                      const std::vector<double>& values) = 0;
};

template <class M>
class ChannelOf : public Channel {
 public:
  ChannelOf(ros::NodeHandle& handle, const EventChannel& channel)
      : channel_(channel),
        reader_(channel.source),
        publisher_(handle.advertise<M>(channel.source.topic, 100)) {}

  bool connected() const override { return publisher_.getNumSubscribers() > 0; }
  void publish(const ros::Time& stamp, const std::vector<double>& values) override {
    publisher_.publish(message(stamp, values));
  }
  void submit(Estimator& reference, const ros::Time& stamp,
              const std::vector<double>& values) override {
    Event event;
    event.kind = channel_.kind;
    event.sensor = channel_.sensor;
    event.stamp = to_stamp(stamp);
    const M sent = message(stamp, values);
    reader_.read(sent, event);
    EXPECT_TRUE(reference.submit(event, to_stamp(ros::Time::now())).used());
  }

 private:
  static M message(const ros::Time& stamp, const std::vector<double>& values) {
    M result;
    result.header.stamp = stamp;
    set_values(result, values);
    return result;
  }

  EventChannel channel_;
  ValueReader<M> reader_;
  ros::Publisher publisher_;
};

std::unique_ptr<Channel> make_channel(ros::NodeHandle& handle, const EventChannel& channel) {
  switch (channel.kind) {
    case EventKind::kInput:
      return std::make_unique<ChannelOf<Input>>(handle, channel);
    case EventKind::kJump:
      return std::make_unique<ChannelOf<JumpEvent>>(handle, channel);
    default:
      return std::make_unique<ChannelOf<Measurement>>(handle, channel);
  }
}

class EveryTypeTest : public ::testing::TestWithParam<std::string> {
 protected:
  EveryTypeTest() : handle_("/" + GetParam()), config_(test::read_example(GetParam())) {
    statuses_ = handle_.subscribe("events", 1000, &EveryTypeTest::on_status, this);
    get_estimate_ = handle_.serviceClient<GetEstimate>("get_estimate");
    for (const EventChannel& channel : event_channels(config_)) {
      descriptions_.push_back(channel);
      channels_.push_back(make_channel(handle_, channel));
    }
  }

  bool connect() {
    return test::spin_until([this] {
      for (const auto& channel : channels_) {
        if (!channel->connected()) return false;
      }
      return statuses_.getNumPublishers() > 0 && get_estimate_.exists();
    });
  }

  /// Sends an event and returns what the observer says of it.
  int send(std::size_t channel, const ros::Time& stamp, const std::vector<double>& values) {
    const std::size_t before = received_.size();
    channels_[channel]->publish(stamp, values);
    if (!test::spin_until([&] { return received_.size() > before; })) return -1;
    EXPECT_EQ(descriptions_[channel].name, received_.back().source);
    return received_.back().outcome;
  }

  void on_status(const EventStatus::ConstPtr& message) { received_.push_back(*message); }

  ros::NodeHandle handle_;
  ObserverConfig config_;
  std::vector<EventChannel> descriptions_;
  std::vector<std::unique_ptr<Channel>> channels_;
  ros::Subscriber statuses_;
  ros::ServiceClient get_estimate_;
  std::vector<EventStatus> received_;
};

TEST_P(EveryTypeTest, OnlyTheGoodEventsCountAndEachHasItsStatus) {
  ASSERT_TRUE(connect());
  const ros::Time start = ros::Time::now() - ros::Duration(1.5);
  Estimator reference(config_.law, config_.options);
  double seconds = 0.0;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    SCOPED_TRACE(descriptions_[i].name);
    const bool is_jump = descriptions_[i].kind == EventKind::kJump;
    const std::vector<double> good(descriptions_[i].source.size, 0.3);
    const ros::Time stamp = start + ros::Duration(seconds += 0.1);
    EXPECT_EQ(EventStatus::USED, send(i, stamp, good));
    channels_[i]->submit(reference, stamp, good);
    EXPECT_EQ(EventStatus::DUPLICATE, send(i, stamp, good));

    std::vector<double> bad = good;
    bad.push_back(1.0);
    const ros::Time later = start + ros::Duration(1.0);
    const bool has_fields = !descriptions_[i].source.fields.empty();
    if (!has_fields) {
      EXPECT_EQ(EventStatus::WRONG_SIZE, send(i, later, bad));
    }
    if (!good.empty()) {
      bad = good;
      bad.back() = std::numeric_limits<double>::quiet_NaN();
      EXPECT_EQ(EventStatus::NOT_FINITE, send(i, later, bad));
      bad.back() = -std::numeric_limits<double>::infinity();
      EXPECT_EQ(EventStatus::NOT_FINITE, send(i, later, bad));
      if (!is_jump) {
        EXPECT_EQ(has_fields ? EventStatus::NO_FIELD : EventStatus::WRONG_SIZE, send(i, later, {}));
      }
    }
    EXPECT_EQ(EventStatus::NO_STAMP, send(i, ros::Time(), good));
    EXPECT_EQ(EventStatus::IN_FUTURE, send(i, start + ros::Duration(1000.0), good));
    EXPECT_EQ(EventStatus::TOO_OLD, send(i, start - ros::Duration(1000.0), good));
  }
  Estimate expected = reference.make_estimate();
  for (double t = 0.1; t < seconds + 0.5; t += 0.0371) {
    GetEstimate call;
    call.request.stamp = start + ros::Duration(t);
    ASSERT_TRUE(get_estimate_.call(call));
    ASSERT_TRUE(call.response.success) << call.response.message;
    reference.estimate_at(to_stamp(call.request.stamp), expected);
    EXPECT_EQ(expected.counts.events, call.response.estimate.events);
    const std::vector<double>& found = call.response.estimate.state;
    EXPECT_EQ(found,
              std::vector<double>(expected.state.data(), expected.state.data() + found.size()));
    for (const double value : found) EXPECT_TRUE(std::isfinite(value));
  }
}

INSTANTIATE_TEST_SUITE_P(Types, EveryTypeTest, ::testing::ValuesIn(test::type_examples()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace sampled_data_observers

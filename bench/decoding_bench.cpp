// What it costs to read messages by their definitions, next to what is compiled for their types:
// from the bytes that roscpp received to the values of an event. `decoded` makes the message of the
// bytes, finds its stamp and reads it, as an observer does; `compiled` deserializes it with the
// type's own code and computes the same values, as an observer would that knew the type.
#include <benchmark/benchmark.h>
#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "allocations.h"
#include "messages/rotation_angles.h"
#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {
namespace {

template <class M>
std::unique_ptr<MessageSource> source_of(const std::vector<std::string>& fields) {
  TopicSource source;
  source.topic = "topic";
  source.type = ros::message_traits::DataType<M>::value();
  source.fields = fields;
  source.size = fields.size();
  return make_message_source(source);
}

template <class M>
void decoded(benchmark::State& state, const M& message, const std::vector<std::string>& fields) {
  const std::unique_ptr<MessageSource> source = source_of<M>(fields);
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  const auto size = static_cast<std::uint32_t>(bytes.num_bytes - 4);
  Event event;
  for (auto _ : state) {
    const MessagePointer received = source->deserialize(bytes.message_start, size, nullptr);
    benchmark::DoNotOptimize(source->stamp_of(received, 1));
    source->read(received, 1, event);
    benchmark::DoNotOptimize(event.values[0]);
  }
}

/// Without making the message: what happens on the path of events.
template <class M>
void read_again(benchmark::State& state, const M& message, const std::vector<std::string>& fields) {
  const std::unique_ptr<MessageSource> source = source_of<M>(fields);
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  const MessagePointer received = source->deserialize(
      bytes.message_start, static_cast<std::uint32_t>(bytes.num_bytes - 4), nullptr);
  Event event;
  const Allocations allocations(state);
  for (auto _ : state) {
    source->read(received, 1, event);
    benchmark::DoNotOptimize(event.values[0]);
  }
}

template <class M, class Read>
void compiled(benchmark::State& state, const M& message, const Read& read) {
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  const auto size = static_cast<std::uint32_t>(bytes.num_bytes - 4);
  for (auto _ : state) {
    const auto received = boost::make_shared<M>();
    ros::serialization::IStream stream(bytes.message_start, size);
    ros::serialization::deserialize(stream, *received);
    benchmark::DoNotOptimize(read(*received));
  }
}

double yaw(const geometry_msgs::Quaternion& q) { return yaw_of({q.x, q.y, q.z, q.w}); }

template <class M, class Read>
void register_type(const std::string& name, const M& message,
                   const std::vector<std::string>& fields, const Read& read) {
  benchmark::RegisterBenchmark((name + "/compiled").c_str(),
                               [=](benchmark::State& state) { compiled(state, message, read); });
  benchmark::RegisterBenchmark((name + "/decoded").c_str(),
                               [=](benchmark::State& state) { decoded(state, message, fields); });
  benchmark::RegisterBenchmark((name + "/read").c_str(), [=](benchmark::State& state) {
    read_again(state, message, fields);
  });
}

void register_types() {
  nav_msgs::Odometry odometry;
  odometry.header.frame_id = "odom";
  odometry.child_frame_id = "base_link";
  odometry.pose.pose.orientation.w = 1.0;
  register_type("Odometry", odometry,
                {"pose.pose.position.x", "pose.pose.orientation.yaw", "twist.twist.linear.x"},
                [](const nav_msgs::Odometry& message) {
                  return message.pose.pose.position.x + yaw(message.pose.pose.orientation) +
                         message.twist.twist.linear.x;
                });
  sensor_msgs::Imu imu;
  imu.header.frame_id = "imu_link";
  imu.orientation.w = 1.0;
  register_type("Imu", imu, {"orientation.yaw", "angular_velocity.z"},
                [](const sensor_msgs::Imu& message) {
                  return message.orientation_covariance[0] + yaw(message.orientation) +
                         message.angular_velocity.z;
                });
  sensor_msgs::JointState joints;
  for (int i = 0; i < 12; ++i) {
    joints.name.push_back("a_rather_long_name_of_joint_" + std::to_string(i));
    joints.position.push_back(i);
    joints.velocity.push_back(i);
  }
  const std::string last = joints.name.back();
  register_type("JointState", joints, {"position." + last},
                [last](const sensor_msgs::JointState& message) {
                  const auto found = std::find(message.name.begin(), message.name.end(), last);
                  return message.position[static_cast<std::size_t>(found - message.name.begin())];
                });
  sensor_msgs::LaserScan scan;
  scan.ranges.resize(1080, 1.0f);
  scan.intensities.resize(1080, 1.0f);
  register_type("LaserScan", scan, {"ranges.540"},
                [](const sensor_msgs::LaserScan& message) { return message.ranges[540]; });
}

}  // namespace
}  // namespace sampled_data_observers

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  sampled_data_observers::register_types();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

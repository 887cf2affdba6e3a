#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/bag.h>

#include <boost/shared_ptr.hpp>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "files/output_file.h"

namespace sampled_data_observers {

/// A bag that is written, whole or not there. A thread of its own writes it, since rosbag takes as
/// long as a replay does: it looks for the end of the file twice for each message. Faults of
/// writing are thrown by a later call of write(), or by finish().
class BagWriter {
 public:
  /// @throws OutputError where it can't be written, as all that follows.
  explicit BagWriter(const std::string& path);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Writes a message of any type that ROS knows, behind those of before. Waits where the thread
  /// is far behind: some 4 MB of messages are held in memory.
  /// @param time    of reception
  /// @param header  of the connection on which it came; without one its topic has one connection
  template <class M>
  void write(const std::string& topic, const ros::Time& time, const M& message,
             const boost::shared_ptr<ros::M_string>& header = nullptr) {
    auto known = connections_.find({topic, header});
    if (known == connections_.end()) {
      known = connections_
                  .emplace(std::make_pair(topic, header),
                           Type{ros::message_traits::datatype(message),
                                ros::message_traits::md5sum(message),
                                ros::message_traits::definition(message)})
                  .first;
    }
    const std::size_t begin = block_.bytes.size();
    const std::uint32_t size = ros::serialization::serializationLength(message);
    block_.bytes.resize(begin + size);
    ros::serialization::OStream stream(block_.bytes.data() + begin, size);
    ros::serialization::serialize(stream, message);
    block_.messages.push_back({&*known, time, begin, size});
    if (block_.bytes.size() >= kBlockSize) hand_over();
  }

  /// To be called when all is written.
  void finish();

  struct Type {
    std::string name;
    std::string md5sum;
    std::string definition;
  };

 private:
  static constexpr std::size_t kBlockSize = 128 * 1024;
  static constexpr std::size_t kMostBlocks = 32;

  /// By topic and header; entries stay where they are.
  using Connections = std::map<std::pair<std::string, boost::shared_ptr<ros::M_string>>, Type>;

  struct Entry {
    const Connections::value_type* connection;
    ros::Time time;
    std::size_t begin;  ///< of its bytes
    std::uint32_t size;
  };
  struct Block {
    std::vector<std::uint8_t> bytes;
    std::vector<Entry> messages;
  };
  /// A bag writes its end when it is destroyed, and ends the program where the disk is full. That
  /// of an unfinished one is of no use: it is left to the end of the process.
  struct LeavesWhatIsOpen {
    void operator()(rosbag::Bag* bag) const {
      if (!bag->isOpen()) delete bag;
    }
  };

  void hand_over();
  void end_thread();
  void write_blocks();
  void write_block(const Block& block);
  template <class Action>
  void attempt(const Action& action) const;
  [[noreturn]] void fail(const std::exception& fault, int cause) const;

  std::string path_;
  OutputFile file_;
  std::unique_ptr<rosbag::Bag, LeavesWhatIsOpen> bag_;  ///< the thread's, as long as that runs
  Connections connections_;
  Block block_;

  std::mutex mutex_;  ///< of what follows
  std::condition_variable changed_;
  std::deque<Block> waiting_;
  bool is_ended_ = false;
  std::exception_ptr fault_;
  std::thread thread_;
};

}  // namespace sampled_data_observers

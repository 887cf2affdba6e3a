#include "replay/bag_writer.h"

#include <algorithm>
#include <cerrno>

#include "replay/bag_source.h"

namespace sampled_data_observers {
namespace {

/// A message as its bytes.
struct SerializedMessage {
  const BagWriter::Type& type;
  const std::uint8_t* bytes;
  std::uint32_t size;
};

}  // namespace
}  // namespace sampled_data_observers

// By which rosbag knows it.
namespace ros {
namespace message_traits {

template <>
struct DataType<sampled_data_observers::SerializedMessage> {
  static const char* value(const sampled_data_observers::SerializedMessage& message) {
    return message.type.name.c_str();
  }
};

template <>
struct MD5Sum<sampled_data_observers::SerializedMessage> {
  static const char* value(const sampled_data_observers::SerializedMessage& message) {
    return message.type.md5sum.c_str();
  }
};

template <>
struct Definition<sampled_data_observers::SerializedMessage> {
  static const char* value(const sampled_data_observers::SerializedMessage& message) {
    return message.type.definition.c_str();
  }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<sampled_data_observers::SerializedMessage> {
  template <class Stream>
  static void write(Stream& stream, const sampled_data_observers::SerializedMessage& message) {
    std::copy_n(message.bytes, message.size, stream.advance(message.size));
  }
  static std::uint32_t serializedLength(const sampled_data_observers::SerializedMessage& message) {
    return message.size;
  }
};

}  // namespace serialization
}  // namespace ros

namespace sampled_data_observers {

BagWriter::BagWriter(const std::string& path) : path_(path), file_(path), bag_(new rosbag::Bag()) {
  attempt([&] { bag_->open(file_.path(), rosbag::bagmode::Write); });
  thread_ = std::thread([this] { write_blocks(); });
}

BagWriter::~BagWriter() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.clear();
  }
  end_thread();
}

void BagWriter::finish() {
  hand_over();
  end_thread();
  if (fault_) std::rethrow_exception(fault_);
  attempt([&] { bag_->close(); });
  file_.finish();
}

/// Gives the block to the thread, where that is not too far behind.
void BagWriter::hand_over() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < kMostBlocks || fault_; });
  if (fault_) std::rethrow_exception(fault_);
  waiting_.push_back(std::move(block_));
  block_ = {};
  block_.bytes.reserve(kBlockSize + kBlockSize / 2);
  changed_.notify_all();
}

void BagWriter::end_thread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ended_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

/// What the thread does. After a fault nothing more is written.
void BagWriter::write_blocks() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return !waiting_.empty() || is_ended_; });
    if (waiting_.empty()) return;
    const Block block = std::move(waiting_.front());
    waiting_.pop_front();
    changed_.notify_all();
    lock.unlock();
    std::exception_ptr fault;
    try {
      write_block(block);
    } catch (...) {
      fault = std::current_exception();
    }
    lock.lock();
    if (!fault) continue;
    fault_ = fault;
    changed_.notify_all();
    return;
  }
}

void BagWriter::write_block(const Block& block) {
  for (const Entry& entry : block.messages) {
    const auto& [key, type] = *entry.connection;
    const SerializedMessage message{type, block.bytes.data() + entry.begin, entry.size};
    attempt([&, &key = key] { bag_->write(key.first, entry.time, message, key.second); });
  }
}

template <class Action>
void BagWriter::attempt(const Action& action) const {
  errno = 0;
  try {
    action();
  } catch (const std::exception& fault) {
    fail(fault, errno);
  }
}

void BagWriter::fail(const std::exception& fault, int cause) const {
  if (cause != 0) throw OutputError(path_, cause);
  throw ReplayError(path_ + ": can't be written: " + fault.what());
}

}  // namespace sampled_data_observers

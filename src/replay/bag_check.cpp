#include "replay/bag_check.h"

#include <rosbag/chunked_file.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "replay/bag_records.h"
#include "replay/bag_source.h"

namespace sampled_data_observers {
namespace {

/// rosbag begins a new chunk after 768 KB; this leaves room for the largest message.
constexpr std::uint32_t kLargestChunk = 1U << 30U;

/// A message, as index and chunk name it: connection, seconds and nanoseconds of its time, place in
/// the chunk.
using Entry = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

using Counts = std::map<std::uint32_t, std::uint32_t>;

struct Connection {
  RecordFields header;
  RecordFields data;
};

Connection connection_of(const RecordFields& header, const char* data, std::size_t size) {
  return {header, RecordFields(data, size)};
}

/// A chunk, and the index behind it.
struct Chunk {
  std::uint64_t position = 0;
  std::vector<Entry> index;
  Counts counts;
  std::vector<Entry> messages;
};

class BagCheck {
 public:
  explicit BagCheck(const std::string& path) : file_(path) {}

  void run() {
    const std::string version = file_.version_line();
    if (version == "#ROSBAG V1.2") return;
    if (version != "#ROSBAG V2.0") {
      throw BagDamage("it does not begin with '#ROSBAG V2.0', as bags do");
    }
    const BagFile::Record header = file_.next();
    if (header.header.op() != kFileHeader) throw BagDamage("it does not begin with its header");
    if (header.header.has("encryptor") && !header.header.text("encryptor").empty()) return;
    const std::uint64_t index_position = header.header.uint64("index_pos");
    if (index_position == 0) {
      throw BagDamage(
          "it has no index: its recording was cut off; rosbag reindex makes one of what is there");
    }
    if (index_position > file_.size()) {
      throw BagDamage("it was cut off: its index begins at byte " + std::to_string(index_position) +
                      ", and it has " + std::to_string(file_.size()));
    }
    while (file_.position() < index_position) read_chunk_or_index();
    if (file_.position() != index_position) {
      throw BagDamage("its header puts the index at byte " + std::to_string(index_position) +
                      ", inside of a record");
    }
    read_connections(header.header.uint32("conn_count"));
    compare_with_chunk_infos(header.header.uint32("chunk_count"));
    if (file_.position() != file_.size()) {
      throw BagDamage("behind the index that its header promises there are " +
                      std::to_string(file_.size() - file_.position()) + " bytes more");
    }
    compare_connections();
  }

 private:
  void read_chunk_or_index() {
    BagFile::Record record = file_.next();
    const std::uint8_t op = record.header.op();
    if (op == kChunk) {
      finish_chunk();
      chunks_.emplace_back();
      chunks_.back().position = record.position;
      read_messages(record);
    } else if (op == kIndexData && !chunks_.empty()) {
      read_index(record);
    } else {
      throw BagDamage("the record at byte " + std::to_string(record.position) +
                      " is neither a chunk nor its index");
    }
  }

  void read_index(const BagFile::Record& record) {
    Chunk& chunk = chunks_.back();
    const std::uint32_t connection = record.header.uint32("conn");
    const std::uint32_t count = record.header.uint32("count");
    ByteReader bytes(record.data.data(), record.data.size());
    constexpr std::size_t kEntrySize = 12;
    if (record.header.uint32("ver") != 1 || bytes.left() != kEntrySize * std::size_t{count}) {
      throw BagDamage("the index at byte " + std::to_string(record.position) + " is not one of " +
                      std::to_string(count) + " messages");
    }
    if (!chunk.counts.emplace(connection, count).second) {
      throw BagDamage("the chunk at byte " + std::to_string(chunk.position) +
                      " has two indices of one connection");
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t seconds = bytes.take_uint32();
      const std::uint32_t nanoseconds = bytes.take_uint32();
      chunk.index.emplace_back(connection, seconds, nanoseconds, bytes.take_uint32());
    }
  }

  /// Compares the last chunk with its index.
  void finish_chunk() {
    if (chunks_.empty()) return;
    Chunk& chunk = chunks_.back();
    std::sort(chunk.index.begin(), chunk.index.end());
    std::sort(chunk.messages.begin(), chunk.messages.end());
    if (chunk.index != chunk.messages) {
      throw BagDamage("the chunk at byte " + std::to_string(chunk.position) + " has " +
                      std::to_string(chunk.messages.size()) + " messages, its index lists " +
                      std::to_string(chunk.index.size()) +
                      (chunk.index.size() == chunk.messages.size() ? " others" : "") +
                      "; try: rosbag reindex");
    }
    chunk.index = {};
    chunk.messages = {};
  }

  void read_messages(const BagFile::Record& record) {
    try {
      const std::vector<char> content = content_of(record);
      ByteReader bytes(content.data(), content.size());
      while (bytes.left() > 0) {
        const auto offset = static_cast<std::uint32_t>(content.size() - bytes.left());
        const std::size_t header_size = bytes.take_uint32();
        const RecordFields header(bytes.take(header_size), header_size);
        const std::size_t size = bytes.take_uint32();
        const char* data = bytes.take(size);
        take_content(header, data, size, offset);
      }
    } catch (const BagDamage& damage) {
      throw BagDamage("the chunk at byte " + std::to_string(record.position) + ": " +
                      damage.what());
    }
  }

  void take_content(const RecordFields& header, const char* data, std::size_t size,
                    std::uint32_t offset) {
    const std::uint8_t op = header.op();
    if (op == kConnection) {
      recorded_.emplace_back(header.uint32("conn"), connection_of(header, data, size));
      return;
    }
    if (op != kMessageData) throw BagDamage("a record in it is neither message nor connection");
    const std::uint64_t time = header.uint64("time");
    constexpr std::uint32_t kNanosecondsPerSecond = 1000000000;
    const auto nanoseconds = static_cast<std::uint32_t>(time >> 32U);
    if (nanoseconds >= kNanosecondsPerSecond) throw BagDamage("a message in it has no valid time");
    chunks_.back().messages.emplace_back(header.uint32("conn"), static_cast<std::uint32_t>(time),
                                         nanoseconds, offset);
  }

  std::vector<char> content_of(const BagFile::Record& record) {
    const std::string& compression = record.header.text("compression");
    const std::uint32_t size = record.header.uint32("size");
    if (compression == "none") {
      if (size != record.data.size()) throw BagDamage("its header names another size");
      return record.data;
    }
    if (compression != "bz2" && compression != "lz4") {
      throw BagDamage("expected none, bz2 or lz4 as its compression, found others");
    }
    if (size > kLargestChunk) {
      throw BagDamage("expected at most 1 GiB in it, found " + std::to_string(size) + " bytes");
    }
    std::vector<char> content(size);
    std::vector<char> packed = record.data;
    try {
      decompressor_.decompress(
          compression == "bz2" ? rosbag::compression::BZ2 : rosbag::compression::LZ4,
          reinterpret_cast<std::uint8_t*>(content.data()), size,
          reinterpret_cast<std::uint8_t*>(packed.data()), static_cast<unsigned int>(packed.size()));
    } catch (const rosbag::BagException& fault) {
      throw BagDamage(std::string("it can't be decompressed: ") + fault.what());
    }
    return content;
  }

  void read_connections(std::uint32_t count) {
    finish_chunk();
    for (std::uint32_t i = 0; i < count; ++i) {
      const BagFile::Record record = next_of_index(kConnection, "connections", i, count);
      const Connection connection =
          connection_of(record.header, record.data.data(), record.data.size());
      if (!connections_.emplace(record.header.uint32("conn"), connection).second) {
        throw BagDamage("its index has two connections of one number");
      }
    }
  }

  BagFile::Record next_of_index(BagOp op, const char* what, std::uint32_t i, std::uint32_t count) {
    if (file_.position() < file_.size()) {
      BagFile::Record record = file_.next();
      if (record.header.op() == op) return record;
    }
    throw BagDamage("its header promises " + std::to_string(count) + ' ' + what +
                    " in the index, which has " + std::to_string(i));
  }

  void compare_with_chunk_infos(std::uint32_t count) {
    if (count != chunks_.size()) {
      throw BagDamage("its header promises " + std::to_string(count) + " chunks, and there are " +
                      std::to_string(chunks_.size()) + "; try: rosbag reindex");
    }
    std::map<std::uint64_t, const Chunk*> by_position;
    for (const Chunk& chunk : chunks_) by_position[chunk.position] = &chunk;
    for (std::uint32_t i = 0; i < count; ++i) {
      const BagFile::Record record = next_of_index(kChunkInfo, "chunks", i, count);
      const auto found = by_position.find(record.header.uint64("chunk_pos"));
      const std::uint32_t entries = record.header.uint32("count");
      ByteReader bytes(record.data.data(), record.data.size());
      constexpr std::size_t kEntrySize = 8;
      if (record.header.uint32("ver") != 1 || found == by_position.end() ||
          bytes.left() != kEntrySize * std::size_t{entries}) {
        throw BagDamage("the index at byte " + std::to_string(record.position) +
                        " is not that of a chunk");
      }
      Counts counts;
      for (std::uint32_t entry = 0; entry < entries; ++entry) {
        const std::uint32_t connection = bytes.take_uint32();
        counts[connection] = bytes.take_uint32();
      }
      if (counts != found->second->counts) {
        throw BagDamage("its index promises other numbers of messages in the chunk at byte " +
                        std::to_string(found->first) + " than there are; try: rosbag reindex");
      }
      by_position.erase(found);
    }
  }

  /// Those in the chunks, and those of messages, with those of the index.
  void compare_connections() const {
    for (const auto& [number, recorded] : recorded_) {
      const auto found = connections_.find(number);
      if (found == connections_.end() || !(found->second.header == recorded.header) ||
          !(found->second.data == recorded.data)) {
        throw BagDamage(
            "its index and its chunks do not agree on the topic or type of connection " +
            std::to_string(number));
      }
    }
    for (const Chunk& chunk : chunks_) {
      for (const auto& count : chunk.counts) {
        if (connections_.count(count.first) > 0) continue;
        throw BagDamage("its index lacks connection " + std::to_string(count.first) +
                        ", which messages came on");
      }
    }
  }

  BagFile file_;
  rosbag::ChunkedFile decompressor_;
  std::vector<Chunk> chunks_;
  std::map<std::uint32_t, Connection> connections_;
  std::vector<std::pair<std::uint32_t, Connection>> recorded_;
};

}  // namespace

void require_whole_bag(const std::string& path) {
  try {
    BagCheck(path).run();
  } catch (const BagDamage& damage) {
    throw ReplayError(path + ": can't be read as a bag: " + damage.what());
  }
}

}  // namespace sampled_data_observers

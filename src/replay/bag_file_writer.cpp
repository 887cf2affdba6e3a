#include "replay/bag_file_writer.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "files/output_file.h"
#include "replay/bag_records.h"

namespace sampled_data_observers {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// As rosbag has it.
constexpr std::size_t kChunkSize = 768 * 1024;
/// So long is the header with what fills it up, so that it can be written anew.
constexpr std::size_t kFileHeaderSize = 4096;

template <class Number>
std::string little_endian_of(Number value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    bytes += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  return bytes;
}

std::string bytes_of(const ros::Time& time) {
  return little_endian_of(time.sec) + little_endian_of(time.nsec);
}

void append(Bytes& bytes, const std::string& text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

std::string text_of(const ros::M_string& fields) {
  std::string text;
  for (const auto& [name, value] : fields) {
    const std::string field = name + '=' + value;
    text += little_endian_of(static_cast<std::uint32_t>(field.size())) + field;
  }
  return text;
}

void append_record(Bytes& bytes, const ros::M_string& header, const std::string& data) {
  const std::string fields = text_of(header);
  append(bytes, little_endian_of(static_cast<std::uint32_t>(fields.size())) + fields);
  append(bytes, little_endian_of(static_cast<std::uint32_t>(data.size())) + data);
}

std::string op_of(BagOp op) { return {static_cast<char>(op)}; }

}  // namespace

BagFileWriter::BagFileWriter(const std::string& path, std::string name)
    : name_(std::move(name)), file_(std::fopen(path.c_str(), "wb"), std::fclose) {
  check(file_ != nullptr);
  write_header(0);
}

std::uint32_t BagFileWriter::connection(const ros::M_string& fields) {
  const auto next = static_cast<std::uint32_t>(connection_records_.size());
  const auto [known, is_new] = connections_.emplace(fields, next);
  if (is_new) {
    Bytes& record = connection_records_.emplace_back();
    append_record(record,
                  {{"op", op_of(kConnection)},
                   {"topic", fields.at("topic")},
                   {"conn", little_endian_of(next)}},
                  text_of(fields));
    is_recorded_.push_back(false);
  }
  return known->second;
}

void BagFileWriter::write(std::uint32_t connection, const ros::Time& time,
                          const std::vector<std::uint8_t>& message) {
  if (!is_recorded_[connection]) {
    is_recorded_[connection] = true;
    const Bytes& record = connection_records_[connection];
    chunk_.insert(chunk_.end(), record.begin(), record.end());
  }
  entries_[connection].push_back({time, static_cast<std::uint32_t>(chunk_.size())});
  const std::string fields = text_of({{"op", op_of(kMessageData)},
                                      {"conn", little_endian_of(connection)},
                                      {"time", bytes_of(time)}});
  append(chunk_, little_endian_of(static_cast<std::uint32_t>(fields.size())) + fields +
                     little_endian_of(static_cast<std::uint32_t>(message.size())));
  chunk_.insert(chunk_.end(), message.begin(), message.end());
  if (chunk_.size() > kChunkSize) write_chunk();
}

void BagFileWriter::close() {
  if (!entries_.empty()) write_chunk();
  const std::uint64_t index_position = position_;
  Bytes index;
  for (const Bytes& record : connection_records_) {
    index.insert(index.end(), record.begin(), record.end());
  }
  for (const Chunk& chunk : chunks_) {
    std::string counts;
    for (const auto& [connection, count] : chunk.counts) {
      counts += little_endian_of(connection) + little_endian_of(count);
    }
    append_record(index,
                  {{"op", op_of(kChunkInfo)},
                   {"ver", little_endian_of(std::uint32_t{1})},
                   {"chunk_pos", little_endian_of(chunk.position)},
                   {"start_time", bytes_of(chunk.begin)},
                   {"end_time", bytes_of(chunk.end)},
                   {"count", little_endian_of(static_cast<std::uint32_t>(chunk.counts.size()))}},
                  counts);
  }
  write_file(index);
  check(std::fseek(file_.get(), 0, SEEK_SET) == 0);
  write_header(index_position);
  check(std::fclose(file_.release()) == 0);
}

/// @param index_position  0 as long as there is none
void BagFileWriter::write_header(std::uint64_t index_position) {
  Bytes header;
  append(header, "#ROSBAG V2.0\n");
  const std::string fields =
      text_of({{"op", op_of(kFileHeader)},
               {"index_pos", little_endian_of(index_position)},
               {"conn_count", little_endian_of(static_cast<std::uint32_t>(connections_.size()))},
               {"chunk_count", little_endian_of(static_cast<std::uint32_t>(chunks_.size()))}});
  const std::string rest(kFileHeaderSize - fields.size(), ' ');
  append(header, little_endian_of(static_cast<std::uint32_t>(fields.size())) + fields +
                     little_endian_of(static_cast<std::uint32_t>(rest.size())) + rest);
  write_file(header);
}

/// And the index of its messages, for each connection in the order of their times.
void BagFileWriter::write_chunk() {
  Chunk& written = chunks_.emplace_back();
  written.position = position_;
  written.begin = written.end = entries_.begin()->second.front().time;
  Bytes index;
  for (auto& [connection, entries] : entries_) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.time < b.time; });
    written.begin = std::min(written.begin, entries.front().time);
    written.end = std::max(written.end, entries.back().time);
    const auto count = static_cast<std::uint32_t>(entries.size());
    written.counts[connection] = count;
    std::string places;
    for (const Entry& entry : entries) {
      places += bytes_of(entry.time) + little_endian_of(entry.offset);
    }
    append_record(index,
                  {{"op", op_of(kIndexData)},
                   {"ver", little_endian_of(std::uint32_t{1})},
                   {"conn", little_endian_of(connection)},
                   {"count", little_endian_of(count)}},
                  places);
  }
  const auto size = little_endian_of(static_cast<std::uint32_t>(chunk_.size()));
  const std::string fields =
      text_of({{"op", op_of(kChunk)}, {"compression", "none"}, {"size", size}});
  Bytes header;
  append(header, little_endian_of(static_cast<std::uint32_t>(fields.size())) + fields + size);
  write_file(header);
  write_file(chunk_);
  write_file(index);
  chunk_.clear();
  entries_.clear();
}

void BagFileWriter::write_file(const Bytes& bytes) {
  check(std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size());
  position_ += bytes.size();
}

void BagFileWriter::check(bool is_done) const {
  if (!is_done) throw OutputError(name_, errno);
}

}  // namespace sampled_data_observers

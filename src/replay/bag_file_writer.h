#pragma once

#include <ros/datatypes.h>
#include <ros/time.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// Writes a bag of the format 2.0, not compressed. rosbag itself looks for the end of the file
/// before each message: four calls of the system, which take longer than all else of a replay.
class BagFileWriter {
 public:
  /// @param path  of the file
  /// @param name  by which faults call it
  /// @throws OutputError where the file can't be written, as all that follows
  BagFileWriter(const std::string& path, std::string name);

  /// The number of a connection; the same for the same fields.
  /// @param fields  topic, type, md5sum, message_definition, and what else is known
  std::uint32_t connection(const ros::M_string& fields);

  /// Writes a message that was received at `time` on a connection.
  void write(std::uint32_t connection, const ros::Time& time,
             const std::vector<std::uint8_t>& message);

  /// Writes the index. Without it the bag is none.
  void close();

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Entry {
    ros::Time time;
    std::uint32_t offset;
  };
  struct Chunk {
    std::uint64_t position = 0;
    ros::Time begin, end;
    std::map<std::uint32_t, std::uint32_t> counts;
  };

  void write_header(std::uint64_t index_position);
  void write_chunk();
  void write_file(const Bytes& bytes);
  void check(bool is_done) const;

  std::string name_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t position_ = 0;
  std::map<ros::M_string, std::uint32_t> connections_;
  std::vector<Bytes> connection_records_;
  std::vector<bool> is_recorded_;  ///< whether a chunk has the record of a connection
  std::vector<Chunk> chunks_;
  Bytes chunk_;
  std::map<std::uint32_t, std::vector<Entry>> entries_;  ///< of the chunk
};

}  // namespace sampled_data_observers

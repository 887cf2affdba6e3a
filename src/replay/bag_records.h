#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// What is wrong with the bytes of a bag, in words.
class BagDamage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bytes in memory that are read one after the other.
class ByteReader {
 public:
  ByteReader(const char* begin, std::size_t size) : next_(begin), left_(size) {}

  std::size_t left() const { return left_; }
  /// @throws BagDamage where there are fewer.
  const char* take(std::size_t size);
  std::uint32_t take_uint32();

 private:
  const char* next_;
  std::size_t left_;
};

/// The header of a record, or the data of a connection: fields by their names.
class RecordFields {
 public:
  RecordFields() = default;
  /// @throws BagDamage
  RecordFields(const char* begin, std::size_t size);

  /// @throws BagDamage for a field that is missing or of another size.
  const std::string& text(const std::string& name) const;
  std::uint8_t op() const;
  std::uint32_t uint32(const std::string& name) const;
  std::uint64_t uint64(const std::string& name) const;
  bool has(const std::string& name) const { return fields_.count(name) > 0; }
  bool operator==(const RecordFields& other) const { return fields_ == other.fields_; }

 private:
  std::map<std::string, std::string> fields_;
};

/// Kinds of records (op) of the bag format 2.0.
enum BagOp : std::uint8_t {
  kMessageData = 2,
  kFileHeader = 3,
  kIndexData = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

/// The records of a bag's file, one after the other.
class BagFile {
 public:
  struct Record {
    std::uint64_t position = 0;
    RecordFields header;
    std::vector<char> data;
  };

  /// @throws BagDamage where the file can't be read.
  explicit BagFile(const std::string& path);

  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  /// The text before the first record, without the end of its line.
  std::string version_line();
  /// @throws BagDamage where the file ends before the record does.
  Record next();

 private:
  std::vector<char> take(std::uint64_t size);
  std::uint32_t take_uint32();

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace sampled_data_observers

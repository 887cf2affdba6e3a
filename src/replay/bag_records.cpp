#include "replay/bag_records.h"

#include <cerrno>
#include <cstring>
#include <utility>

namespace sampled_data_observers {
namespace {

template <class Number>
Number little_endian(const char* bytes) {
  Number value = 0;
  for (std::size_t i = sizeof(Number); i > 0; --i) {
    value = static_cast<Number>((value << 8U) | static_cast<unsigned char>(bytes[i - 1]));
  }
  return value;
}

}  // namespace

const char* ByteReader::take(std::size_t size) {
  if (size > left_) {
    throw BagDamage("expected " + std::to_string(size) + " more bytes, found " +
                    std::to_string(left_));
  }
  const char* taken = next_;
  next_ += size;
  left_ -= size;
  return taken;
}

std::uint32_t ByteReader::take_uint32() {
  return little_endian<std::uint32_t>(take(sizeof(std::uint32_t)));
}

RecordFields::RecordFields(const char* begin, std::size_t size) {
  ByteReader bytes(begin, size);
  while (bytes.left() > 0) {
    const std::size_t length = bytes.take_uint32();
    const std::string field(bytes.take(length), length);
    const std::size_t equals = field.find('=');
    if (equals == std::string::npos) throw BagDamage("expected name=value in a header");
    if (!fields_.emplace(field.substr(0, equals), field.substr(equals + 1)).second) {
      throw BagDamage("a header has a field twice");
    }
  }
}

const std::string& RecordFields::text(const std::string& name) const {
  const auto found = fields_.find(name);
  if (found == fields_.end()) throw BagDamage("a header lacks the field '" + name + "'");
  return found->second;
}

std::uint8_t RecordFields::op() const {
  const std::string& value = text("op");
  if (value.size() != 1) throw BagDamage("the field 'op' of a header is not one byte long");
  return static_cast<std::uint8_t>(value.front());
}

std::uint32_t RecordFields::uint32(const std::string& name) const {
  const std::string& value = text(name);
  if (value.size() != 4) throw BagDamage("the field '" + name + "' is not 4 bytes long");
  return little_endian<std::uint32_t>(value.data());
}

std::uint64_t RecordFields::uint64(const std::string& name) const {
  const std::string& value = text(name);
  if (value.size() != 8) throw BagDamage("the field '" + name + "' is not 8 bytes long");
  return little_endian<std::uint64_t>(value.data());
}

BagFile::BagFile(const std::string& path) : file_(std::fopen(path.c_str(), "rb"), std::fclose) {
  if (!file_) throw BagDamage(std::strerror(errno));
  if (std::fseek(file_.get(), 0, SEEK_END) != 0) throw BagDamage("it is no file");
  const auto end = ::ftello(file_.get());
  // Folders open, too.
  if (end < 0 || std::fseek(file_.get(), 0, SEEK_SET) != 0 || std::fgetc(file_.get()) == EOF) {
    throw BagDamage(std::ferror(file_.get()) != 0 ? std::strerror(errno) : "it is empty");
  }
  std::rewind(file_.get());
  size_ = static_cast<std::uint64_t>(end);
}

std::vector<char> BagFile::take(std::uint64_t size) {
  if (size > size_ - position_) {
    throw BagDamage("a record needs " + std::to_string(size) + " bytes from byte " +
                    std::to_string(position_) + " on, and there are only " +
                    std::to_string(size_ - position_));
  }
  std::vector<char> bytes(static_cast<std::size_t>(size));
  if (std::fread(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
    throw BagDamage(std::ferror(file_.get()) != 0 ? std::strerror(errno)
                                                  : "it became shorter while it was read");
  }
  position_ += size;
  return bytes;
}

std::uint32_t BagFile::take_uint32() {
  return little_endian<std::uint32_t>(take(sizeof(std::uint32_t)).data());
}

std::string BagFile::version_line() {
  std::string line;
  constexpr std::size_t kLongest = 32;
  while (line.size() < kLongest && position_ < size_) {
    const char c = take(1).front();
    if (c == '\n') break;
    line += c;
  }
  return line;
}

BagFile::Record BagFile::next() {
  Record record;
  record.position = position_;
  try {
    const std::vector<char> header = take(take_uint32());
    record.header = RecordFields(header.data(), header.size());
    record.data = take(take_uint32());
  } catch (const BagDamage& damage) {
    throw BagDamage("the record at byte " + std::to_string(record.position) + ": " + damage.what());
  }
  return record;
}

}  // namespace sampled_data_observers

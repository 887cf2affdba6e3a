#include "replay/message_shape.h"

#include <algorithm>
#include <sstream>

#include "replay/bag_records.h"

namespace sampled_data_observers {
namespace {

/// More than any message nests.
constexpr int kDeepest = 20;

/// Larger than any message.
constexpr std::size_t kLargest = std::size_t{1} << 30U;

/// Bytes of a number; nothing for another type.
std::optional<std::size_t> number_size(const std::string& type) {
  static const std::map<std::string, std::size_t> kSizes = {
      {"bool", 1},  {"byte", 1},   {"char", 1},    {"int8", 1},   {"uint8", 1},
      {"int16", 2}, {"uint16", 2}, {"int32", 4},   {"uint32", 4}, {"float32", 4},
      {"int64", 8}, {"uint64", 8}, {"float64", 8}, {"time", 8},   {"duration", 8}};
  const auto found = kSizes.find(type);
  return found == kSizes.end() ? std::nullopt : std::optional<std::size_t>(found->second);
}

}  // namespace

/// The bytes of one message, field by field.
class MessageShape::Walk {
 public:
  Walk(const MessageShape& shape, const std::uint8_t* bytes, std::size_t size)
      : shape_(shape), bytes_(reinterpret_cast<const char*>(bytes), size) {}

  void run() {
    pass_type(shape_.type_);
    if (bytes_.left() > 0) {
      throw BagDamage(std::to_string(bytes_.left()) + " bytes follow its last field");
    }
  }

 private:
  void pass_type(const std::string& type) {
    for (const Field& field : shape_.types_.at(type)) pass(field);
  }

  void pass(const Field& field) {
    const std::size_t length = field.is_list ? bytes_.take_uint32() : field.length;
    const Size size = field.type.empty() ? field.size : shape_.sizes_.at(field.type);
    // What varies has at least its length, of 4 bytes.
    const std::size_t least = std::max<std::size_t>(size.value_or(4), field.is_list ? 1 : 0);
    if (least > 0 && length > bytes_.left() / least) {
      throw BagDamage("its field " + field.name + " claims " + std::to_string(length) +
                      " entries, and only " + std::to_string(bytes_.left()) + " bytes follow");
    }
    if (size) {
      bytes_.take(*size * length);
      return;
    }
    for (std::size_t i = 0; i < length; ++i) {
      if (field.type.empty()) {
        bytes_.take(bytes_.take_uint32());
      } else {
        pass_type(field.type);
      }
    }
  }

  const MessageShape& shape_;
  ByteReader bytes_;
};

MessageShape::MessageShape(const std::string& type, const std::string& definition) : type_(type) {
  // Types in it follow below lines of '='.
  std::istringstream lines(definition);
  std::string name = type;
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.compare(0, 5, "MSG: ") == 0) {
      add_type(name, text);
      name = line.substr(5, line.find_last_not_of(" \r") - 4);
      text.clear();
    } else if (line.compare(0, 3, "===") != 0) {
      text += line + '\n';
    }
  }
  add_type(name, text);
  find_size(type_, 0);
}

void MessageShape::add_type(const std::string& name, const std::string& definition) {
  Fields fields;
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    const bool is_text_constant =
        line.find("string ") != std::string::npos && line.find('=') < line.find('#');
    if (!is_text_constant) line = line.substr(0, line.find('#'));
    if (line.find('=') != std::string::npos) continue;
    std::istringstream words(line);
    std::string type;
    std::string field;
    if (!(words >> type)) continue;
    if (!(words >> field)) throw BagDamage("the definition of " + name + " can't be read");
    fields.push_back(field_of(type, field, name));
  }
  types_.emplace(name, std::move(fields));
}

MessageShape::Field MessageShape::field_of(std::string type, const std::string& name,
                                           const std::string& within) const {
  Field field;
  field.name = name;
  const std::size_t bracket = type.find('[');
  if (bracket != std::string::npos) {
    const std::string length = type.substr(bracket + 1, type.find(']') - bracket - 1);
    field.is_list = length.empty();
    if (!field.is_list) {
      const bool is_number =
          length.size() < 10 && length.find_first_not_of("0123456789") == std::string::npos;
      if (!is_number) throw BagDamage("the definition of " + within + " can't be read");
      field.length = std::stoul(length);
    }
    type.resize(bracket);
  }
  field.size = number_size(type);
  if (field.size || type == "string") return field;
  if (type == "Header") type = "std_msgs/Header";
  if (type.find('/') == std::string::npos) type = within.substr(0, within.find('/') + 1) + type;
  field.type = type;
  return field;
}

MessageShape::Size MessageShape::find_size(const std::string& type, int depth) {
  const auto known = sizes_.find(type);
  if (known != sizes_.end()) return known->second;
  const auto found = types_.find(type);
  if (found == types_.end() || depth > kDeepest) {
    throw BagDamage("the definition of " + type_ + " does not say what " + type + " is");
  }
  const auto too_large = [this] {
    return BagDamage("the definition of " + type_ + " is of a message too large");
  };
  Size total = 0;
  for (const Field& field : found->second) {
    const Size size = field.type.empty() ? field.size : find_size(field.type, depth + 1);
    if (size.value_or(0) > 0 && field.length > kLargest / *size) throw too_large();
    const bool is_fixed = total && size && !field.is_list;
    total = is_fixed ? Size(*total + *size * field.length) : std::nullopt;
    if (total.value_or(0) > kLargest) throw too_large();
  }
  sizes_[type] = total;
  return total;
}

void MessageShape::require(const std::uint8_t* bytes, std::size_t size) const {
  Walk(*this, bytes, size).run();
}

}  // namespace sampled_data_observers

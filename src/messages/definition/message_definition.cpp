#include "messages/definition/message_definition.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "messages/definition/md5.h"

namespace sampled_data_observers {
namespace {

/// More than any message nests.
constexpr int kDeepest = 20;

/// Larger than any message [bytes].
constexpr std::size_t kLargest = std::size_t{1} << 30U;

struct NamedNumber {
  const char* name;
  NumberType type;
};

constexpr NamedNumber kNumbers[] = {
    {"bool", NumberType::kUint8},      {"byte", NumberType::kInt8},
    {"char", NumberType::kUint8},      {"uint8", NumberType::kUint8},
    {"int8", NumberType::kInt8},       {"uint16", NumberType::kUint16},
    {"int16", NumberType::kInt16},     {"uint32", NumberType::kUint32},
    {"int32", NumberType::kInt32},     {"uint64", NumberType::kUint64},
    {"int64", NumberType::kInt64},     {"float32", NumberType::kFloat32},
    {"float64", NumberType::kFloat64},
};

bool is_time(const std::string& type) { return type == "time" || type == "duration"; }

bool is_message(const std::string& type) { return type.find('/') != std::string::npos; }

std::string trimmed(const std::string& text) {
  const char* const kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string package_of(const std::string& type) { return type.substr(0, type.find('/')); }

/// A line of a definition.
struct Line {
  std::string type;      ///< with the package, without brackets
  std::string brackets;  ///< "", "[]" or "[3]"
  std::string name;
  std::optional<std::string> value;  ///< of a constant
};

/// Nothing for a line that says nothing.
std::optional<Line> read_line(const std::string& text, const std::string& package) {
  const auto fault = [&] { return DefinitionError("can't be read: '" + trimmed(text) + "'"); };
  const std::string bare = trimmed(text.substr(0, text.find('#')));
  if (bare.empty()) return std::nullopt;
  const std::size_t end = bare.find_first_of(" \t");
  if (end == std::string::npos) throw fault();
  Line line;
  line.type = bare.substr(0, end);
  // A text takes all that follows, '#' as well.
  std::string rest = line.type == "string" && bare.find('=') != std::string::npos
                         ? trimmed(trimmed(text).substr(end))
                         : trimmed(bare.substr(end));
  const std::size_t equals = rest.find('=');
  if (equals != std::string::npos) {
    line.value = trimmed(rest.substr(equals + 1));
    rest = trimmed(rest.substr(0, equals));
  }
  line.name = rest;
  const bool is_word = rest.find_first_of(" \t[]") == std::string::npos && !rest.empty();
  if (!is_word) throw fault();
  const std::size_t bracket = line.type.find('[');
  if (bracket != std::string::npos) {
    line.brackets = line.type.substr(bracket);
    line.type.resize(bracket);
    const std::string& all = line.brackets;
    constexpr std::size_t kMostDigits = 9;
    const bool is_length = all.back() == ']' && all.size() <= kMostDigits + 2 &&
                           all.find_first_not_of("0123456789", 1) == all.size() - 1;
    if (!is_length || line.value) throw fault();
  }
  if (line.type.empty()) throw fault();
  const bool is_basic = number_type(line.type) || line.type == "string" || is_time(line.type);
  if (!is_basic && line.value) throw fault();
  if (line.type == "Header") line.type = "std_msgs/Header";
  if (!is_basic && !is_message(line.type)) line.type = package + "/" + line.type;
  return line;
}

std::vector<Line> read_lines(const std::string& text, const std::string& package) {
  std::vector<Line> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (std::optional<Line> found = read_line(line, package)) lines.push_back(std::move(*found));
  }
  return lines;
}

}  // namespace

std::optional<NumberType> number_type(const std::string& name) {
  const auto found = std::find_if(std::begin(kNumbers), std::end(kNumbers),
                                  [&](const NamedNumber& number) { return name == number.name; });
  return found == std::end(kNumbers) ? std::nullopt : std::optional<NumberType>(found->type);
}

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::kUint8:
    case NumberType::kInt8:
      return 1;
    case NumberType::kUint16:
    case NumberType::kInt16:
      return 2;
    case NumberType::kUint32:
    case NumberType::kInt32:
    case NumberType::kFloat32:
      return 4;
    case NumberType::kUint64:
    case NumberType::kInt64:
    case NumberType::kFloat64:
      break;
  }
  return 8;
}

std::vector<std::string> types_within(const std::string& package, const std::string& text) {
  std::vector<std::string> types;
  for (const Line& line : read_lines(text, package)) {
    if (is_message(line.type)) types.push_back(line.type);
  }
  return types;
}

MessageDefinition::MessageDefinition(std::string type, std::string text)
    : type_(std::move(type)), text_(std::move(text)) {
  std::istringstream lines(text_);
  std::string name = type_;
  std::string one;
  for (std::string line; std::getline(lines, line);) {
    if (line.compare(0, 5, "MSG: ") == 0) {
      add_type(name, one);
      name = trimmed(line.substr(5));
      one.clear();
    } else if (line.compare(0, 3, "===") != 0) {
      one += line + '\n';
    }
  }
  add_type(name, one);
  complete(type_, 0);
}

void MessageDefinition::add_type(const std::string& name, const std::string& text) {
  Type type;
  try {
    for (const Line& line : read_lines(text, package_of(name))) {
      if (line.value) {
        type.constants += line.type + " " + line.name + "=" + *line.value + "\n";
        continue;
      }
      MessageMember member;
      member.name = line.name;
      member.type = line.type;
      member.is_several = !line.brackets.empty();
      if (line.brackets.size() > 2) member.length = std::stoul(line.brackets.substr(1));
      type.members.push_back(member);
      type.brackets.push_back(line.brackets);
    }
  } catch (const DefinitionError& error) {
    throw DefinitionError("the definition of " + name + " " + error.what());
  }
  types_.emplace(name, std::move(type));
}

/// The sum is that of genmsg's text: the constants, then the members, those of message types with
/// the sum of these in the place of their names.
void MessageDefinition::complete(const std::string& type, int depth) {
  if (md5sums_.count(type) != 0) return;
  const auto found = types_.find(type);
  if (found == types_.end() || depth > kDeepest) {
    throw DefinitionError("the definition of " + type_ + " does not say what " + type + " is");
  }
  std::string text = found->second.constants;
  for (std::size_t i = 0; i < found->second.members.size(); ++i) {
    const MessageMember& member = found->second.members[i];
    if (is_message(member.type)) {
      complete(member.type, depth + 1);
      text += md5sums_.at(member.type);
    } else {
      text += member.type + found->second.brackets[i];
    }
    text += " " + member.name + "\n";
  }
  sizes_[type] = size_of_members(found->second);
  md5sums_[type] = md5_of(trimmed(text));
}

std::optional<std::size_t> MessageDefinition::size_of_members(const Type& type) const {
  std::optional<std::size_t> total = 0;
  for (const MessageMember& member : type.members) {
    const std::optional<std::size_t> size = fixed_size(member.type);
    const std::size_t length = member.length.value_or(1);
    const bool is_too_large = size && *size > 0 && length > kLargest / *size;
    const bool is_fixed = total && !member.is_list() && (size || length == 0);
    if (is_fixed) *total += size.value_or(0) * length;
    if (!is_fixed) total.reset();
    if (is_too_large || total.value_or(0) > kLargest) {
      throw DefinitionError("the definition of " + type_ + " is of a message too large");
    }
  }
  return total;
}

std::optional<std::size_t> MessageDefinition::fixed_size(const std::string& type) const {
  if (const std::optional<NumberType> number = number_type(type)) return size_of(*number);
  if (is_time(type)) return 8;
  if (type == "string") return std::nullopt;
  return sizes_.at(type);
}

}  // namespace sampled_data_observers

#include "messages/definition/decoding_plan.h"

#include <algorithm>
#include <cstring>

namespace sampled_data_observers {
namespace {

constexpr std::size_t kLengthSize = 4;

/// Of entries that vary: each has at least the length of a text or list.
constexpr std::size_t kLeastVarying = 4;

/// As roscpp does, on machines of little-endian order.
template <class T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

double number_at(const std::uint8_t* bytes, NumberType type) {
  switch (type) {
    case NumberType::kUint8:
      return load<std::uint8_t>(bytes);
    case NumberType::kInt8:
      return load<std::int8_t>(bytes);
    case NumberType::kUint16:
      return load<std::uint16_t>(bytes);
    case NumberType::kInt16:
      return load<std::int16_t>(bytes);
    case NumberType::kUint32:
      return load<std::uint32_t>(bytes);
    case NumberType::kInt32:
      return load<std::int32_t>(bytes);
    case NumberType::kUint64:
      return static_cast<double>(load<std::uint64_t>(bytes));
    case NumberType::kInt64:
      return static_cast<double>(load<std::int64_t>(bytes));
    case NumberType::kFloat32:
      return static_cast<double>(load<float>(bytes));
    case NumberType::kFloat64:
      break;
  }
  return load<double>(bytes);
}

constexpr std::size_t kNotThere = static_cast<std::size_t>(-1);

}  // namespace

std::string Malformation::describe() const {
  switch (kind) {
    case Kind::kNone:
      break;
    case Kind::kEndsEarly:
      return "it ends in its field " + *member;
    case Kind::kTooMany:
      return "its field " + *member + " claims " + std::to_string(claimed) + " entries, and only " +
             std::to_string(left) + " bytes follow";
    case Kind::kGoesOn:
      return std::to_string(left) + " bytes follow its last field";
  }
  return "";
}

/// On its way through the bytes of one message.
class DecodingPlan::Run {
 public:
  Run(const DecodingPlan& plan, const std::uint8_t* bytes, std::size_t size,
      const DecodingSlots& slots)
      : plan_(plan), next_(bytes), left_(size), slots_(slots) {
    std::fill_n(slots_.is_held, plan.counts_.numbers, char{0});
    std::fill_n(slots_.texts, plan.counts_.texts, std::string_view());
    std::fill_n(slots_.lists, plan.counts_.lists, DecodingSlots::Place());
    std::fill_n(slots_.entries, plan.counts_.entries, kNotThere);
  }

  Malformation run() {
    if (pass(plan_.first_)) {
      for (const NamedRead& read : plan_.named_reads_) take_named(read);
      if (plan_.is_whole_ && left_ > 0) fail(Malformation::Kind::kGoesOn, nullptr);
    }
    return fault_;
  }

 private:
  // Each returns whether the bytes were there.

  bool pass(std::size_t program) {
    for (const Step& step : plan_.programs_[program]) {
      if (!pass(step)) return false;
    }
    return true;
  }

  bool pass(const Step& step) {
    switch (step.kind) {
      case Step::Kind::kPiece:
        return pass_piece(step);
      case Step::Kind::kText:
        return pass_text(step);
      case Step::Kind::kEntries:
        return pass_entries(step);
      case Step::Kind::kEach:
        return pass_each(step);
      case Step::Kind::kNames:
        break;
    }
    return pass_names(step);
  }

  bool pass_piece(const Step& step) {
    if (step.size > left_) return fail(Malformation::Kind::kEndsEarly, step.member);
    for (std::size_t i = step.reads.begin; i < step.reads.end; ++i) {
      take(plan_.reads_[i], next_ + plan_.reads_[i].offset);
    }
    skip(step.size);
    return true;
  }

  bool pass_text(const Step& step) {
    std::size_t length = 0;
    if (!take_length(step, 1, length)) return false;
    if (step.slot != kNoSlot) {
      slots_.texts[step.slot] = {reinterpret_cast<const char*>(next_), length};
    }
    skip(length);
    return true;
  }

  bool pass_entries(const Step& step) {
    std::size_t count = 0;
    if (!take_length(step, step.size, count)) return false;
    for (std::size_t i = step.reads.begin; i < step.reads.end; ++i) {
      const Read& read = plan_.reads_[i];
      if (read.index < count) take(read, next_ + read.index * step.size + read.offset);
    }
    if (step.slot != kNoSlot) slots_.lists[step.slot] = {next_, count};
    skip(count * step.size);
    return true;
  }

  bool pass_each(const Step& step) {
    std::size_t count = step.length;
    if (step.is_counted && !take_length(step, kLeastVarying, count)) return false;
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t program = step.program;
      for (std::size_t part = step.parts.begin; part < step.parts.end; ++part) {
        if (plan_.parts_[part].index == i) program = plan_.parts_[part].program;
      }
      if (!pass(program)) return false;
    }
    return true;
  }

  bool pass_names(const Step& step) {
    std::size_t count = 0;
    if (!take_length(step, kLeastVarying, count)) return false;
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t length = 0;
      if (!take_length(step, 1, length)) return false;
      const std::string_view name(reinterpret_cast<const char*>(next_), length);
      for (std::size_t wanted = step.names.begin; wanted < step.names.end; ++wanted) {
        std::size_t& entry = slots_.entries[plan_.names_[wanted].entry];
        if (entry == kNotThere && name == plan_.names_[wanted].text) entry = i;
      }
      skip(length);
    }
    return true;
  }

  /// The number of entries of at least so many bytes, which are there.
  bool take_length(const Step& step, std::size_t entry_size, std::size_t& length) {
    if (left_ < kLengthSize) return fail(Malformation::Kind::kEndsEarly, step.member);
    length = load<std::uint32_t>(next_);
    skip(kLengthSize);
    if (entry_size == 0 || length <= left_ / entry_size) return true;
    fault_.claimed = length;
    return fail(Malformation::Kind::kTooMany, step.member);
  }

  void take(const Read& read, const std::uint8_t* from) {
    slots_.numbers[read.slot] = read.type == NumberType::kFloat64 ? load<double>(from)  // as most
                                                                  : number_at(from, read.type);
    slots_.is_held[read.slot] = 1;
  }

  void take_named(const NamedRead& read) {
    const DecodingSlots::Place& list = slots_.lists[read.list];
    const std::size_t entry = slots_.entries[read.entry];
    if (entry >= list.count) return;
    slots_.numbers[read.slot] = number_at(list.base + entry * read.size + read.offset, read.type);
    slots_.is_held[read.slot] = 1;
  }

  void skip(std::size_t size) {
    next_ += size;
    left_ -= size;
  }

  bool fail(Malformation::Kind kind, const std::string* member) {
    fault_.kind = kind;
    fault_.member = member;
    fault_.left = left_;
    return false;
  }

  const DecodingPlan& plan_;
  const std::uint8_t* next_;
  std::size_t left_;
  const DecodingSlots& slots_;
  Malformation fault_;
};

Malformation DecodingPlan::run(const std::uint8_t* bytes, std::size_t size,
                               const DecodingSlots& slots) const {
  return Run(*this, bytes, size, slots).run();
}

DecodedMessage::DecodedMessage(const DecodingPlan::Counts& counts)
    : numbers_(counts.numbers),
      is_held_(counts.numbers),
      texts_(counts.texts),
      lists_(counts.lists),
      entries_(counts.entries) {}

DecodingSlots DecodedMessage::slots() {
  return {numbers_.data(), is_held_.data(), texts_.data(), lists_.data(), entries_.data()};
}

}  // namespace sampled_data_observers

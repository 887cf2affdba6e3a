#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "messages/definition/message_definition.h"

namespace sampled_data_observers {

/// What is wrong with the bytes of a message.
struct Malformation {
  enum class Kind : std::uint8_t {
    kNone,
    kEndsEarly,  ///< no bytes are left for a member
    kTooMany,    ///< a list claims more entries than the bytes that follow can be
    kGoesOn      ///< bytes follow the last member
  };

  Kind kind = Kind::kNone;
  /// In which member, where it is kEndsEarly or kTooMany; of the plan.
  const std::string* member = nullptr;
  /// Entries that the list claims to have.
  std::uint64_t claimed = 0;
  /// Bytes that are left.
  std::size_t left = 0;

  bool any() const { return kind != Kind::kNone; }
  /// In words. Allocates.
  std::string describe() const;
};

/// Room for what a plan finds in a message: its counts say how much of each.
struct DecodingSlots {
  struct Place {
    const std::uint8_t* base = nullptr;
    std::size_t count = 0;
  };

  double* numbers = nullptr;
  /// Whether the message holds them: lists may be shorter, and lack names.
  char* is_held = nullptr;
  std::string_view* texts = nullptr;
  Place* lists = nullptr;
  std::size_t* entries = nullptr;
};

/// How to take some numbers and texts out of the bytes of a message, found once from its
/// definition (PlanCompiler). What lies at fixed places is read from there; over texts and lists it
/// steps. Never reads past the end, whatever the bytes are, and allocates nothing.
class DecodingPlan {
 public:
  /// How much room it takes.
  struct Counts {
    std::size_t numbers = 0;
    std::size_t texts = 0;
    std::size_t lists = 0;
    std::size_t entries = 0;
  };

  const Counts& counts() const { return counts_; }

  /// Reads a message. The texts live as long as its bytes. What `slots` holds where it is malformed
  /// has no meaning.
  Malformation run(const std::uint8_t* bytes, std::size_t size, const DecodingSlots& slots) const;

 private:
  friend class PlanCompiler;
  class Run;

  /// Of vectors of the plan: [begin, end).
  struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  /// A number in a piece of fixed size, or in an entry of a list.
  struct Read {
    std::size_t index = 0;   ///< of the entry
    std::size_t offset = 0;  ///< in the piece or entry [bytes]
    NumberType type = NumberType::kUint8;
    std::size_t slot = 0;
  };

  /// A number in that entry of a list that bears a name.
  struct NamedRead {
    std::size_t list = 0;
    std::size_t entry = 0;  ///< slot of the number of the name's place
    std::size_t size = 0;   ///< of an entry [bytes]
    std::size_t offset = 0;
    NumberType type = NumberType::kUint8;
    std::size_t slot = 0;
  };

  struct Name {
    std::string text;
    std::size_t entry = 0;  ///< slot
  };

  /// Entries that are looked into: by what program.
  struct Part {
    std::size_t index = 0;
    std::size_t program = 0;
  };

  static constexpr std::size_t kNoSlot = static_cast<std::size_t>(-1);

  struct Step {
    enum class Kind : std::uint8_t {
      kPiece,    ///< `size` bytes
      kText,     ///< a text
      kEntries,  ///< a list of entries of `size` bytes
      kEach,     ///< a list or array of entries that vary
      kNames     ///< a list of texts that name entries of others
    };

    Kind kind = Kind::kPiece;
    std::size_t size = 0;
    bool is_counted = true;      ///< by the message
    std::size_t length = 0;      ///< of kEach, where it is not
    Range reads;                 ///< of kPiece and kEntries
    Range parts;                 ///< of kEach
    std::size_t program = 0;     ///< of kEach: over all other entries
    Range names;                 ///< of kNames
    std::size_t slot = kNoSlot;  ///< of kText: the text's; of kEntries: the list's
    const std::string* member = nullptr;
  };

  Counts counts_;
  std::vector<std::vector<Step>> programs_;
  std::vector<Read> reads_;
  std::vector<NamedRead> named_reads_;
  std::vector<Part> parts_;
  std::vector<Name> names_;
  std::size_t first_ = 0;  ///< program
  bool is_whole_ = true;   ///< whether it reads up to the message's end
  /// The definition's names of members live here.
  std::shared_ptr<const MessageDefinition> definition_;
};

/// Room of one's own.
class DecodedMessage {
 public:
  explicit DecodedMessage(const DecodingPlan::Counts& counts);

  DecodingSlots slots();
  double number(std::size_t slot) const { return numbers_[slot]; }
  double& number(std::size_t slot) { return numbers_[slot]; }
  bool holds(std::size_t slot) const { return is_held_[slot] != 0; }
  std::string_view text(std::size_t slot) const { return texts_[slot]; }

 private:
  std::vector<double> numbers_;
  std::vector<char> is_held_;
  std::vector<std::string_view> texts_;
  std::vector<DecodingSlots::Place> lists_;
  std::vector<std::size_t> entries_;
};

}  // namespace sampled_data_observers

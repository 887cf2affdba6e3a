#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "messages/definition/decoding_plan.h"
#include "messages/definition/message_path.h"

namespace sampled_data_observers {

/// Makes the plan by which some numbers and texts are taken out of messages of one definition.
class PlanCompiler {
 public:
  explicit PlanCompiler(std::shared_ptr<const MessageDefinition> definition);

  /// Asks for a number; for the same one twice it gives the same slot.
  /// @pre `path` leads to one
  std::size_t want_number(const MessagePath& path);

  /// Asks for a text. @pre `path` leads to one, over no lists
  std::size_t want_text(const MessagePath& path);

  /// Asks for a time; returns the slots of its seconds and nanoseconds.
  /// @pre `path` leads to one
  std::pair<std::size_t, std::size_t> want_time(const MessagePath& path);

  /// @param is_whole  whether messages are read, and checked, to their end instead of to the last
  ///   of what is wanted
  DecodingPlan compile(bool is_whole = true);

 private:
  enum class Half : std::uint8_t { kNone, kSeconds, kNanoseconds };
  struct Want {
    MessagePath path;
    std::size_t slot = 0;
    bool is_text = false;
    Half half = Half::kNone;  ///< of a time
  };
  /// A want seen from a type within: its path from the given step on.
  struct View {
    const Want* want = nullptr;
    std::size_t first = 0;
    const PathStep& step() const { return want->path[first]; }
    View inner() const { return {want, first + 1}; }
  };
  using Views = std::vector<View>;
  using Step = DecodingPlan::Step;
  using Steps = std::vector<Step>;
  /// Where a number lies in a value of fixed size.
  struct Place {
    std::size_t offset = 0;
    NumberType type = NumberType::kUint8;
  };

  std::size_t want(const Want& wanted);
  std::size_t compile_program(const std::string& type, const Views& views);
  void add_type(const std::string& type, const Views& views, Steps& steps);
  void add_list(const MessageMember& member, const Views& views, DecodingPlan::Range names,
                Steps& steps);
  DecodingPlan::Range register_names(const Views& views);
  void add_piece(const MessageMember& member, std::size_t size, const Views& views, Steps& steps);
  void add_text(const MessageMember& member, const Views& views, Steps& steps);
  void add_entries(const MessageMember& member, std::size_t size, const Views& views,
                   DecodingPlan::Range names, Steps& steps);
  void add_each(const MessageMember& member, const Views& views, Steps& steps);
  void add_names(const MessageMember& member, DecodingPlan::Range names, Steps& steps);
  std::size_t passing_program(const std::string& type);
  Place place_of(const std::string& type, const View& view) const;
  static bool is_of_use(const Step& step);

  std::shared_ptr<const MessageDefinition> definition_;
  std::vector<Want> wants_;
  /// Programs over types of which nothing is wanted.
  std::map<std::string, std::size_t> passing_;
  DecodingPlan plan_;
};

}  // namespace sampled_data_observers

#pragma once

#include <stdexcept>
#include <string>

namespace sampled_data_observers {

/// How a tool was called wrongly: its exit status then. They are above those that tools give a
/// meaning, and below those of programs that a signal ended.
enum class Misuse {
  kBadValue = 105,
  kMissing = 106,
  kNeedsAnother = 107,
  kUnknown = 109,
  kWrongCount = 114,
};

/// A command line that is refused.
class UsageError : public std::runtime_error {
 public:
  /// @param what_is_wrong  the option, or the argument
  /// @param reason  what was expected of it and what was found
  UsageError(const std::string& what_is_wrong, const std::string& reason,
             Misuse misuse = Misuse::kBadValue)
      : std::runtime_error(what_is_wrong + ": " + reason), misuse_(misuse) {}

  int exit_status() const { return static_cast<int>(misuse_); }

 private:
  Misuse misuse_;
};

}  // namespace sampled_data_observers

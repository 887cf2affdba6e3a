#pragma once

#include <string>
#include <vector>

#include "console/option_checks.h"
#include "console/option_value.h"

namespace sampled_data_observers {

/// An option or an argument of a command line, as it is declared.
class Option {
 public:
  /// @param spelling  as the help page shows it: "-o, --output FILE" with the names of its values,
  ///                  "--rigorous" for a flag, "BAG" for an argument
  Option(std::string spelling, OptionValue value, std::string help);

  // These say more about it, one after the other.

  /// What each of its values must be.
  Option& check(OptionCheck check);
  /// Its values must be of these, which the help page lists.
  Option& choices(const std::vector<std::string>& choices);
  Option& required();
  /// It has a meaning beside this other option only.
  Option& needs(const Option& other);

  const std::string& spelling() const { return spelling_; }
  const std::string& long_name() const { return long_name_; }    ///< "output"
  const std::string& short_name() const { return short_name_; }  ///< "o", or empty
  const OptionValue& value() const { return value_; }
  bool is_required() const { return is_required_; }
  const Option* needed() const { return needed_; }

  const std::string& value_names() const { return value_names_; }  ///< "FILE"
  /// "--output FILE", or "BAG"
  std::string usage() const;
  /// What faults call it: "--output", or "BAG".
  std::string title() const;
  /// What it is for, what its values may be, and what holds without it.
  std::string help() const;

  /// @throws UsageError where these are not what was declared
  void store(const std::vector<std::string>& texts) const;

 private:
  std::string spelling_;
  std::string short_name_;
  std::string long_name_;
  std::string value_names_;
  OptionValue value_;
  std::string help_;
  std::vector<std::string> choices_;
  OptionCheck check_;
  bool is_required_ = false;
  const Option* needed_ = nullptr;
};

}  // namespace sampled_data_observers

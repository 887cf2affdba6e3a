#pragma once

#include <functional>
#include <list>
#include <string>
#include <vector>

#include "console/help_page.h"
#include "console/option.h"

namespace sampled_data_observers {

/// The command line of a tool, or of one of its commands: what it takes, what it does with that,
/// and its help page.
///
/// What options and arguments are stored in must live until run() returns; the types say how many
/// values they take (see option_value.h).
class CommandLine {
 public:
  /// @param footer  ends the help pages of the tool and of all its commands
  CommandLine(std::string name, std::string description, std::string footer);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// What stands without a name, in this order; a vector takes what is left.
  template <class T>
  Option& argument(const std::string& name, T& target, const std::string& help) {
    return arguments_.emplace_back(name, value_for(target), help).required();
  }

  /// @param spelling  "-o, --output FILE": a letter where it has one, its name, those of its values
  template <class T>
  Option& option(const std::string& spelling, T& target, const std::string& help) {
    return options_.emplace_back(spelling, value_for(target), help);
  }

  /// An option without value, which sets `target`.
  Option& flag(const std::string& spelling, bool& target, const std::string& help);

  /// A command of this tool, which its first argument names then.
  CommandLine& command(const std::string& name, const std::string& description);

  /// What to do; it returns the exit status. UsageError thrown there is wrong usage, too.
  void action(std::function<int()> action);

  /// Stores what is given, and does the action, that of a command included. Where help is asked for
  /// or usage is wrong it prints the page, or the fault, instead.
  /// @return the exit status: that of the action, 0 after help, one of Misuse after a fault
  int run(int argc, const char* const* argv) const;

 private:
  int run(const std::vector<std::string>& given) const;
  void store(const std::vector<std::string>& given) const;
  void store_arguments(const std::vector<std::string>& texts) const;
  /// @throws UsageError where there are commands, of which none is given
  void refuse_other_commands(const std::vector<std::string>& given) const;
  std::string last_name() const;  ///< "verify" of "design verify"
  HelpPage help_page() const;

  std::string name_;
  std::string description_;
  std::string footer_;
  std::list<Option> arguments_;
  std::list<Option> options_;
  std::list<CommandLine> commands_;
  std::function<int()> action_;
};

}  // namespace sampled_data_observers

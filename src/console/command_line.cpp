#include "console/command_line.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include "console/option_checks.h"
#include "console/option_parser.h"
#include "console/usage_error.h"

namespace sampled_data_observers {
namespace {

using Texts = std::vector<std::string>;

bool asks_for_help(const Texts& given) {
  return std::any_of(given.begin(), std::find(given.begin(), given.end(), "--"),
                     [](const std::string& text) { return text == "-h" || text == "--help"; });
}

struct SortedTexts {
  std::map<const Option*, Texts> of_options;
  Texts of_arguments;
};

/// Options of any number of values take the texts behind them, too, but leave one for each
/// argument.
SortedTexts sorted(const ParsedArguments& parsed, std::size_t arguments) {
  const auto is_free = [](const ParsedPart& part) { return part.option == nullptr; };
  const auto beside =
      static_cast<std::size_t>(std::count_if(parsed.parts.begin(), parsed.parts.end(), is_free));
  const std::size_t free = beside + parsed.rest.size();
  std::size_t spare = free - std::min(free, arguments);
  SortedTexts result;
  const Option* taker = nullptr;
  for (const ParsedPart& part : parsed.parts) {
    if (is_free(part)) {
      if (spare == 0) taker = nullptr;
      if (taker != nullptr) --spare;
    } else {
      taker = part.option;
    }
    Texts& texts = taker == nullptr ? result.of_arguments : result.of_options[taker];
    texts.insert(texts.end(), part.texts.begin(), part.texts.end());
    if (taker != nullptr && taker->value().most != OptionValue::kAnyNumber) taker = nullptr;
  }
  result.of_arguments.insert(result.of_arguments.end(), parsed.rest.begin(), parsed.rest.end());
  return result;
}

UsageError missing(const std::string& what) {
  return UsageError(what, "expected, but not given", Misuse::kMissing);
}

}  // namespace

CommandLine::CommandLine(std::string name, std::string description, std::string footer)
    : name_(std::move(name)), description_(std::move(description)), footer_(std::move(footer)) {}

Option& CommandLine::flag(const std::string& spelling, bool& target, const std::string& help) {
  const auto set = [&target](const Texts&) {
    target = true;
    return std::string();
  };
  return options_.emplace_back(spelling, OptionValue{0, 0, set, ""}, help);
}

CommandLine& CommandLine::command(const std::string& name, const std::string& description) {
  return commands_.emplace_back(name_ + " " + name, description, footer_);
}

void CommandLine::action(std::function<int()> action) { action_ = std::move(action); }

int CommandLine::run(int argc, const char* const* argv) const {
  return run(Texts(argv + std::min(argc, 1), argv + argc));
}

int CommandLine::run(const Texts& given) const {
  for (const CommandLine& command : commands_) {
    if (!given.empty() && command.last_name() == given.front()) {
      return command.run(Texts(given.begin() + 1, given.end()));
    }
  }
  try {
    if (asks_for_help(given)) {
      std::printf("%s", laid_out(help_page()).c_str());
      return 0;
    }
    refuse_other_commands(given);
    store(given);
    return action_();
  } catch (const UsageError& fault) {
    std::fprintf(stderr, "%s: %s\nSee '%s --help'.\n", name_.c_str(), fault.what(), name_.c_str());
    return fault.exit_status();
  }
}

void CommandLine::store(const Texts& given) const {
  const SortedTexts texts = sorted(parse_arguments(options_, given), arguments_.size());
  const auto is_given = [&](const Option& option) { return texts.of_options.count(&option) > 0; };
  for (const Option& option : options_) {
    if (is_given(option)) option.store(texts.of_options.at(&option));
  }
  for (const Option& option : options_) {
    if (option.is_required() && !is_given(option)) throw missing(option.usage());
    if (option.needed() != nullptr && is_given(option) && !is_given(*option.needed())) {
      throw UsageError(option.title(), "needs " + option.needed()->usage(), Misuse::kNeedsAnother);
    }
  }
  store_arguments(texts.of_arguments);
}

void CommandLine::store_arguments(const Texts& texts) const {
  auto next = texts.begin();
  for (const Option& argument : arguments_) {
    if (next == texts.end()) throw missing(argument.usage());
    const bool takes_all = argument.value().most == OptionValue::kAnyNumber;
    const auto end = takes_all ? texts.end() : next + 1;
    argument.store(Texts(next, end));
    next = end;
  }
  if (next != texts.end()) {
    throw UsageError(*next, "expected no further argument", Misuse::kUnknown);
  }
}

void CommandLine::refuse_other_commands(const Texts& given) const {
  if (commands_.empty()) return;
  Texts names;
  for (const CommandLine& command : commands_) names.push_back(command.last_name());
  throw UsageError("COMMAND", one_of(names)(given.empty() ? "" : given.front()), Misuse::kMissing);
}

std::string CommandLine::last_name() const { return name_.substr(name_.rfind(' ') + 1); }

HelpPage CommandLine::help_page() const {
  HelpPage page;
  page.usage = name_;
  HelpSection arguments = {"Arguments", {}};
  for (const Option& argument : arguments_) {
    page.usage += " " + argument.usage();
    arguments.entries.push_back({argument.spelling(), argument.help()});
  }
  HelpSection options = {"Options", {}};
  for (const Option& option : options_) {
    if (option.is_required()) page.usage += " " + option.usage();
    // Names without a letter stand below those with one.
    const std::string indent = option.short_name().empty() ? "    " : "";
    options.entries.push_back({indent + option.spelling(), option.help()});
  }
  options.entries.push_back({"-h, --help", "Print this page"});
  HelpSection commands = {"Commands", {}};
  for (const CommandLine& command : commands_) {
    commands.entries.push_back({command.last_name(), command.description_});
  }
  page.description = description_;
  page.footer = footer_;
  if (commands_.empty()) {
    page.usage += " [OPTIONS]";
  } else {
    page.usage += " COMMAND ...";
    page.footer = "'" + name_ + " COMMAND --help' tells more of a command.\n" + footer_;
  }
  page.sections = {arguments, commands, options};
  return page;
}

}  // namespace sampled_data_observers

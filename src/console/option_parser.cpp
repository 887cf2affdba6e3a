#include "console/option_parser.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <boost/program_options.hpp>

#include "console/usage_error.h"

namespace sampled_data_observers {
namespace {

namespace po = boost::program_options;

using Texts = std::vector<std::string>;

/// Takes just so many texts, whatever they look like.
class TextCount : public po::typed_value<Texts> {
 public:
  explicit TextCount(std::size_t count)
      : po::typed_value<Texts>(nullptr), count_(static_cast<unsigned>(count)) {}
  unsigned min_tokens() const override { return count_; }
  unsigned max_tokens() const override { return count_; }

 private:
  unsigned count_;
};

po::options_description described(const std::list<Option>& options) {
  po::options_description description;
  for (const Option& option : options) {
    const std::string& letter = option.short_name();
    const std::string names = option.long_name() + (letter.empty() ? "" : "," + letter);
    // The description owns and deletes what stands for the value.
    description.add(boost::make_shared<po::option_description>(
        names.c_str(), new TextCount(option.value().least)));
  }
  return description;
}

/// The option of a long name.
const Option& find(const std::list<Option>& options, const std::string& long_name) {
  return *std::find_if(options.begin(), options.end(),
                       [&](const Option& option) { return option.long_name() == long_name; });
}

/// The option of a name with its dashes; null where there is none.
const Option* find_spelt(const std::list<Option>& options, const std::string& text) {
  for (const Option& option : options) {
    const std::string& letter = option.short_name();
    if (text == option.title() || (!letter.empty() && text == "-" + letter)) return &option;
  }
  return nullptr;
}

/// Where the value would be the name of an option, the value itself was forgotten.
void refuse_names_as_values(const std::list<Option>& options, const ParsedPart& part) {
  for (const std::string& text : part.texts) {
    if (find_spelt(options, text) == nullptr) continue;
    throw UsageError(part.option->title(),
                     "expected " + part.option->value_names() + ", found the option " + text,
                     Misuse::kWrongCount);
  }
}

std::string reason_of(const po::invalid_command_line_syntax& fault, const Option* option) {
  if (fault.kind() == po::invalid_syntax::extra_parameter) return "expected no value, found one";
  const std::string expected = option == nullptr ? "an option" : option->value_names();
  const bool takes_several = option != nullptr && option->value().least > 1;
  return "expected " + expected + ", found " + (takes_several ? "fewer values" : "nothing");
}

}  // namespace

ParsedArguments parse_arguments(const std::list<Option>& options, const Texts& arguments) {
  const auto end = std::find(arguments.begin(), arguments.end(), "--");
  ParsedArguments parsed;
  if (end != arguments.end()) parsed.rest.assign(end + 1, arguments.end());
  const po::options_description description = described(options);
  namespace style = po::command_line_style;
  try {
    const auto found = po::command_line_parser(Texts(arguments.begin(), end))
                           .options(description)
                           .style(style::unix_style & ~style::allow_guessing)
                           .run();
    for (const po::option& part : found.options) {
      if (part.string_key.empty()) {
        parsed.parts.push_back({nullptr, part.original_tokens});
      } else {
        parsed.parts.push_back({&find(options, part.string_key), part.value});
        refuse_names_as_values(options, parsed.parts.back());
      }
    }
  } catch (const po::unknown_option& fault) {
    throw UsageError(fault.get_option_name(), "there is no such option", Misuse::kUnknown);
  } catch (const po::invalid_command_line_syntax& fault) {
    const std::string name = fault.get_option_name();
    throw UsageError(name, reason_of(fault, find_spelt(options, name)), Misuse::kWrongCount);
  }
  return parsed;
}

}  // namespace sampled_data_observers

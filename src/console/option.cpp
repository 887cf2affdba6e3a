#include "console/option.h"

#include <sstream>
#include <utility>

#include "console/usage_error.h"

namespace sampled_data_observers {

Option::Option(std::string spelling, OptionValue value, std::string help)
    : spelling_(std::move(spelling)), value_(std::move(value)), help_(std::move(help)) {
  std::istringstream words(spelling_);
  for (std::string word; words >> word;) {
    if (word.back() == ',') word.pop_back();
    if (word.compare(0, 2, "--") == 0) {
      long_name_ = word.substr(2);
    } else if (word.front() == '-') {
      short_name_ = word.substr(1);
    } else {
      value_names_ += (value_names_.empty() ? "" : " ") + word;
    }
  }
}

Option& Option::check(OptionCheck check) {
  check_ = std::move(check);
  return *this;
}

Option& Option::choices(const std::vector<std::string>& choices) {
  choices_ = choices;
  return check(one_of(choices));
}

Option& Option::required() {
  is_required_ = true;
  return *this;
}

Option& Option::needs(const Option& other) {
  needed_ = &other;
  return *this;
}

std::string Option::usage() const {
  if (long_name_.empty()) return value_names_;
  return title() + (value_names_.empty() ? "" : " " + value_names_);
}

std::string Option::title() const { return long_name_.empty() ? value_names_ : "--" + long_name_; }

std::string Option::help() const {
  std::string text = help_;
  if (is_required_ && !long_name_.empty()) text += " (required)";
  if (!value_.default_text.empty()) text += " (default: " + value_.default_text + ")";
  if (needed_ != nullptr) text += " (needs " + needed_->title() + ")";
  std::string separator = "\nOne of ";
  for (const std::string& choice : choices_) {
    text += std::exchange(separator, ", ") + choice;
  }
  return text;
}

void Option::store(const std::vector<std::string>& texts) const {
  if (texts.size() < value_.least || texts.size() > value_.most) {
    throw UsageError(
        title(),
        "expected " + value_names_ + " once, found " + std::to_string(texts.size()) + " values",
        Misuse::kWrongCount);
  }
  for (const std::string& text : texts) {
    const std::string fault = check_ ? check_(text) : "";
    if (!fault.empty()) throw UsageError(title(), fault);
  }
  const std::string fault = value_.store(texts);
  if (!fault.empty()) throw UsageError(title(), fault);
}

}  // namespace sampled_data_observers

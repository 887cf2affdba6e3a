#include "console/help_page.h"

#include <algorithm>
#include <sstream>

namespace sampled_data_observers {
namespace {

constexpr std::size_t kWidth = 96;
/// Where the second column begins.
constexpr std::size_t kColumn = 28;

/// One line, broken into several, the first of which begins with `indent` spaces.
std::string broken(const std::string& line, std::size_t indent, std::size_t indent_of_others) {
  std::istringstream words(line);
  std::string text;
  std::size_t used = kWidth;  // no word fits any more
  for (std::string word; words >> word;) {
    if (used + 1 + word.size() > kWidth) {
      const std::size_t begin = text.empty() ? indent : indent_of_others;
      text += (text.empty() ? "" : "\n") + std::string(begin, ' ') + word;
      used = begin + word.size();
    } else {
      text += " " + word;
      used += 1 + word.size();
    }
  }
  return text;
}

std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t inner = std::min(line.find_first_not_of(' '), line.size());
    result += broken(line, indent + inner, indent + 2 * inner) + "\n";
  }
  return result;
}

std::string in_columns(const HelpSection::Entry& entry) {
  std::string name = "  " + entry.name;
  const std::string text = wrapped(entry.text, kColumn);
  if (text.empty() || name.size() + 2 > kColumn) return name + "\n" + text;
  name.resize(kColumn, ' ');
  return name + text.substr(kColumn);
}

}  // namespace

std::string laid_out(const HelpPage& page) {
  std::string text = wrapped("Usage: " + page.usage, 0) + "\n" + wrapped(page.description, 0);
  for (const HelpSection& section : page.sections) {
    if (section.entries.empty()) continue;
    text += "\n" + section.title + ":\n";
    for (const HelpSection::Entry& entry : section.entries) text += in_columns(entry);
  }
  return text + "\n" + wrapped(page.footer, 0);
}

}  // namespace sampled_data_observers

#pragma once

#include <string>
#include <vector>

namespace sampled_data_observers {

/// What there is to say, in two columns.
struct HelpSection {
  struct Entry {
    std::string name;
    std::string text;  ///< a line that begins with spaces is a point of a list
  };
  std::string title;
  std::vector<Entry> entries;
};

struct HelpPage {
  std::string usage;
  std::string description;
  std::vector<HelpSection> sections;  ///< those without entries are left out
  std::string footer;
};

/// The page for a terminal, in lines of at most 96 columns where no word is longer.
std::string laid_out(const HelpPage& page);

}  // namespace sampled_data_observers

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// A table of a page, with its heading and what stands above it.
struct PageTable {
  std::string title;
  std::string note;
  std::vector<std::string> heads;
  std::vector<std::size_t> texts;  ///< columns of texts, which stand to the left
  std::vector<std::vector<std::string>> rows;
};

/// A page about designs for plants: text, charts and tables, from top to bottom.
struct DesignPage {
  std::string title;
  std::string subtitle;
  std::string text;  ///< headings at the left margin, what is below them indented
  /// As the program plot_curves takes them. `candidates` {x, y} of a curve are points beside it;
  /// charts of one `heading` share a section, with the `note` of the first; with `marks` the points
  /// of curves are marked, and with `fills` there is no room beside them; `height` is in pixels.
  std::vector<nlohmann::json> charts;
  std::vector<PageTable> tables;
};

/// Writes it into one file that a browser shows without network.
/// @throws OutputError
void write_page(const DesignPage& page, const std::string& path);

}  // namespace sampled_data_observers

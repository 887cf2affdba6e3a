#include "tools/design/design_page.h"

#include "console/html_page.h"
#include "files/output_file.h"

namespace sampled_data_observers {

namespace page_parts {

/// The files of page/design: what makes the page.
std::string design();

}  // namespace page_parts

namespace {

nlohmann::json to_json(const PageTable& table) {
  return {{"title", table.title},
          {"note", table.note},
          {"heads", table.heads},
          {"texts", table.texts},
          {"rows", table.rows}};
}

}  // namespace

void write_page(const DesignPage& page, const std::string& path) {
  nlohmann::json tables = nlohmann::json::array();
  for (const PageTable& table : page.tables) tables.push_back(to_json(table));
  const nlohmann::json data = {{"title", page.title},
                               {"subtitle", page.subtitle},
                               {"text", page.text},
                               {"charts", page.charts},
                               {"tables", tables}};
  write_output(path, html_page(data, page_parts::design()));
}

}  // namespace sampled_data_observers

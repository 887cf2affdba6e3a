#include "console/html_page.h"

#include <cstddef>
#include <stdexcept>

#include "console/json_text.h"

namespace sampled_data_observers {
namespace {

/// As text within an element `script`, which no text in it can end, nor begin a comment.
std::string without_markup(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

void put(const std::string& place, const std::string& text, std::string& page) {
  const std::size_t at = page.find(place);
  if (at == std::string::npos) throw std::logic_error("page/frame.html has no " + place);
  page.replace(at, place.size(), text);
}

}  // namespace

std::string html_page(const nlohmann::json& data, const std::string& script) {
  std::string page = page_parts::frame();
  // The data last: nothing is looked for in what it holds.
  put("/* STYLE */", page_parts::style(), page);
  put("/* SCRIPT */", page_parts::charts() + script, page);
  put("/* DATA */", without_markup(json_text(data)), page);
  return page;
}

}  // namespace sampled_data_observers

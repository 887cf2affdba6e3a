#include "sampled_data_observers/config/config_section.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <locale>
#include <sstream>
#include <utility>

#include "config/fault_list.h"
#include "config/misspelling.h"
#include "config/number_text.h"

namespace sampled_data_observers {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// Whether the text is a decimal number, such as -1, 2.5, .5 or 1e-3. Leading zeros are refused:
/// ROS' parameter loader reads 010 as eight, other readers as ten.
bool is_decimal(const std::string& text) {
  std::size_t at = 0;
  const auto skip_one_of = [&](const char* characters) {
    const bool found = at < text.size() && std::strchr(characters, text[at]) != nullptr;
    if (found) ++at;
    return found;
  };
  const auto skip_digits = [&] {
    const std::size_t start = at;
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
    return at - start;
  };
  skip_one_of("+-");
  const std::size_t start = at;
  const std::size_t whole = skip_digits();
  if (whole > 1 && text[start] == '0') return false;
  const std::size_t fraction = skip_one_of(".") ? skip_digits() : 0;
  if (whole + fraction == 0) return false;
  if (skip_one_of("eE")) {
    skip_one_of("+-");
    if (skip_digits() == 0) return false;
  }
  return at == text.size();
}

/// As YAML writes infinity, and as the parameter server hands it on.
bool is_infinity(const ConfigNode& node) {
  constexpr const char* kInfinities[] = {".inf", ".Inf", ".INF", "inf"};
  return node.kind == ConfigNode::Kind::kScalar &&
         std::count(std::begin(kInfinities), std::end(kInfinities), node.scalar) > 0;
}

/// Nothing where the node is not a finite decimal number.
std::optional<double> as_number(const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::kScalar || !is_decimal(node.scalar)) return std::nullopt;
  std::istringstream in(node.scalar[0] == '+' ? node.scalar.substr(1) : node.scalar);
  in.imbue(std::locale::classic());
  double value = 0.0;
  in >> value;
  // Overflow sets failbit; underflow gives the nearest number.
  if (!std::isfinite(value) || (in.fail() && std::abs(value) > 1.0)) return std::nullopt;
  return value;
}

std::string sized(Eigen::Index size, const char* free_name) {
  return size < 0 ? free_name : std::to_string(size);
}

}  // namespace

ConfigSection::ConfigSection(const ConfigNode& node, std::string path)
    : node_(node), path_(std::move(path)) {
  if (node.kind != ConfigNode::Kind::kMap) {
    throw ConfigError(node.origin, path_, "a map of keys", node.describe());
  }
}

std::string ConfigSection::path_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "/" + key;
}

ConfigError ConfigSection::error(const std::string& key, const std::string& expected,
                                 const std::string& found) const {
  const ConfigNode* node = node_.find(key);
  return ConfigError(node != nullptr ? node->origin : node_.origin, path_of(key), expected, found);
}

std::string ConfigSection::absence_of(const std::string& key) const {
  std::vector<std::string> others;
  for (const auto& entry : node_.entries) {
    if (asked_.count(entry.first) == 0) others.push_back(entry.first);
  }
  const std::string misspelt = misspelling_of(key, others);
  return "nothing (the key is missing" +
         (misspelt.empty() ? ")" : "; is '" + misspelt + "' a misspelling of it?)");
}

const ConfigNode& ConfigSection::required(const std::string& key, const std::string& expected) {
  if (!has(key)) throw error(key, expected, absence_of(key));
  return *node_.find(key);
}

bool ConfigSection::has(const std::string& key) {
  asked_.insert(key);
  return node_.find(key) != nullptr;
}

bool ConfigSection::is_map(const std::string& key) {
  return has(key) && node_.find(key)->kind == ConfigNode::Kind::kMap;
}

bool ConfigSection::is_list(const std::string& key) {
  return has(key) && node_.find(key)->kind == ConfigNode::Kind::kSequence;
}

bool ConfigSection::is_number(const std::string& key) {
  return has(key) && as_number(*node_.find(key)).has_value();
}

double ConfigSection::number(const std::string& key) {
  const ConfigNode& node = required(key, "a finite number");
  const std::optional<double> value = as_number(node);
  if (!value) throw error(key, "a finite number", node.describe());
  return *value;
}

double ConfigSection::number_in(const std::string& key, double low, double high,
                                std::optional<double> fallback) {
  if (fallback && !has(key)) return *fallback;
  const double value = number(key);
  if (value < low || value > high) {
    throw error(key, "a number from " + number_text(low) + " to " + number_text(high),
                number_text(value));
  }
  return value;
}

std::size_t ConfigSection::count(const std::string& key, std::size_t low, std::size_t high,
                                 std::size_t fallback) {
  const double value = number_in(key, static_cast<double>(low), static_cast<double>(high),
                                 static_cast<double>(fallback));
  if (value != std::floor(value)) throw error(key, "a whole number", number_text(value));
  return static_cast<std::size_t>(value);
}

std::string ConfigSection::text(const std::string& key) {
  const ConfigNode& node = required(key, "a text");
  if (node.kind != ConfigNode::Kind::kScalar || node.scalar.empty()) {
    throw error(key, "a text that is not empty", node.describe());
  }
  return node.scalar;
}

std::string ConfigSection::text(const std::string& key, const std::string& fallback) {
  return has(key) ? text(key) : fallback;
}

std::string ConfigSection::choice(const std::string& key, const std::vector<std::string>& choices) {
  std::string value = text(key);
  for (const std::string& choice : choices) {
    if (value == choice) return value;
  }
  throw error(key, "one of " + joined(choices), "'" + value + "'");
}

std::vector<std::string> ConfigSection::texts(const std::string& key) {
  const ConfigNode& node = required(key, "a list of names");
  if (node.kind != ConfigNode::Kind::kSequence) {
    throw error(key, "a list of names", node.describe());
  }
  std::vector<std::string> result;
  for (const ConfigNode& item : node.items) {
    if (item.kind != ConfigNode::Kind::kScalar) throw error(key, "names in it", item.describe());
    result.push_back(item.scalar);
  }
  return result;
}

std::vector<std::string> ConfigSection::texts(const std::string& key, std::size_t size) {
  std::vector<std::string> result = texts(key);
  if (result.size() != size) {
    throw error(key, "a list of " + std::to_string(size),
                "one of " + std::to_string(result.size()));
  }
  return result;
}

bool ConfigSection::flag(const std::string& key, bool fallback) {
  return has(key) ? choice(key, {"true", "false"}) == "true" : fallback;
}

std::vector<bool> ConfigSection::flags(const std::string& key, std::size_t size) {
  const std::string expected = "a list of " + std::to_string(size) + " of true and false";
  std::vector<bool> result;
  const ConfigNode& node = required(key, expected);
  if (node.kind != ConfigNode::Kind::kSequence || node.items.size() != size) {
    throw error(key, expected, node.describe());
  }
  for (const ConfigNode& item : node.items) {
    if (item.scalar != "true" && item.scalar != "false")
      throw error(key, expected, item.describe());
    result.push_back(item.scalar == "true");
  }
  return result;
}

Eigen::MatrixXd ConfigSection::matrix(const std::string& key, Eigen::Index rows,
                                      Eigen::Index cols) {
  const std::string expected = (rows < 0 ? "an " : "a ") + sized(rows, "m") + " x " +
                               sized(cols, "n") +
                               " matrix of finite numbers as a list of rows, each a list";
  const ConfigNode& node = required(key, expected);
  if (node.kind != ConfigNode::Kind::kSequence || node.items.empty()) {
    throw error(key, expected, node.describe());
  }
  const auto found_rows = static_cast<Eigen::Index>(node.items.size());
  const auto found_cols = static_cast<Eigen::Index>(node.items.front().items.size());
  Eigen::MatrixXd result(found_rows, found_cols);
  for (Eigen::Index i = 0; i < found_rows; ++i) {
    const ConfigNode& row = node.items[static_cast<std::size_t>(i)];
    const std::string where = "row " + std::to_string(i + 1);
    if (row.kind != ConfigNode::Kind::kSequence) {
      throw error(key, expected, row.describe() + " as " + where);
    }
    if (static_cast<Eigen::Index>(row.items.size()) != found_cols) {
      throw error(key, expected, where + " of another length than row 1");
    }
    for (Eigen::Index j = 0; j < found_cols; ++j) {
      const ConfigNode& item = row.items[static_cast<std::size_t>(j)];
      const std::optional<double> value = as_number(item);
      if (!value) {
        throw error(key, expected,
                    item.describe() + " in " + where + ", column " + std::to_string(j + 1));
      }
      result(i, j) = *value;
    }
  }
  if ((rows >= 0 && found_rows != rows) || (cols >= 0 && found_cols != cols) || found_cols == 0) {
    throw error(key, expected,
                "a " + std::to_string(found_rows) + " x " + std::to_string(found_cols) + " matrix");
  }
  return result;
}

bool ConfigSection::is_matrix(const std::string& key) {
  if (!is_list(key)) return false;
  const std::vector<ConfigNode>& rows = node_.find(key)->items;
  return std::all_of(rows.begin(), rows.end(), [](const ConfigNode& row) {
    return row.kind == ConfigNode::Kind::kSequence &&
           std::all_of(row.items.begin(), row.items.end(),
                       [](const ConfigNode& item) { return as_number(item).has_value(); });
  });
}

double ConfigSection::number_or_infinity_in(const std::string& key, double low, double high) {
  if (has(key) && is_infinity(*node_.find(key))) return std::numeric_limits<double>::infinity();
  return number_in(key, low, high, std::nullopt);
}

Eigen::Vector2d ConfigSection::interval_in(const std::string& key, double low, double high) {
  const std::string expected = "a list of two numbers from " + number_text(low) + " to " +
                               number_text(high) + ", the second not below the first, or .inf";
  const ConfigNode& node = required(key, expected);
  if (node.items.size() != 2) throw error(key, expected, node.describe());
  const bool is_unbounded = is_infinity(node.items[1]);
  const double infinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d result(as_number(node.items[0]).value_or(-infinity),
                         as_number(node.items[1]).value_or(is_unbounded ? infinity : low));
  if (result(0) < low || result(1) < result(0) || (!is_unbounded && !(result(1) <= high)) ||
      (!is_unbounded && !as_number(node.items[1]))) {
    throw error(key, expected, "[" + joined({node.items[0].scalar, node.items[1].scalar}) + "]");
  }
  return result;
}

Eigen::VectorXd ConfigSection::vector(const std::string& key, Eigen::Index size) {
  const std::string expected =
      "a list of " + (size < 0 ? "" : std::to_string(size) + " ") + "finite numbers";
  const ConfigNode& node = required(key, expected);
  const auto found = static_cast<Eigen::Index>(node.items.size());
  if (node.kind != ConfigNode::Kind::kSequence || (size >= 0 && found != size)) {
    throw error(key, expected, node.describe());
  }
  Eigen::VectorXd result(found);
  for (Eigen::Index i = 0; i < found; ++i) {
    const ConfigNode& item = node.items[static_cast<std::size_t>(i)];
    const std::optional<double> value = as_number(item);
    if (!value) throw error(key, expected, item.describe());
    result(i) = *value;
  }
  return result;
}

std::vector<Eigen::VectorXd> ConfigSection::vectors(const std::string& key) {
  const std::string expected = "a list of finite numbers, or a list of such lists";
  const ConfigNode& node = required(key, expected);
  if (node.kind != ConfigNode::Kind::kSequence || node.items.empty()) {
    throw error(key, expected, node.describe());
  }
  const bool nested = node.items.front().kind == ConfigNode::Kind::kSequence;
  std::vector<const ConfigNode*> lists;
  if (!nested) lists.push_back(&node);
  for (const ConfigNode& item : node.items) {
    if ((item.kind == ConfigNode::Kind::kSequence) != nested) {
      throw error(key, expected, item.describe() + " in it");
    }
    if (nested) lists.push_back(&item);
  }
  std::vector<Eigen::VectorXd> result;
  for (const ConfigNode* list : lists) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(list->items.size()));
    for (std::size_t i = 0; i < list->items.size(); ++i) {
      const std::optional<double> value = as_number(list->items[i]);
      if (!value) throw error(key, expected, list->items[i].describe() + " in it");
      values(static_cast<Eigen::Index>(i)) = *value;
    }
    result.push_back(std::move(values));
  }
  return result;
}

ConfigSection ConfigSection::section(const std::string& key) {
  return ConfigSection(required(key, "a map of keys"), path_of(key));
}

std::vector<ConfigSection> ConfigSection::sections(const std::string& key) {
  const std::string expected = "a list of maps";
  const ConfigNode& node = required(key, expected);
  if (node.kind != ConfigNode::Kind::kSequence) throw error(key, expected, node.describe());
  std::vector<ConfigSection> result;
  for (const ConfigNode& item : node.items) {
    result.emplace_back(item, path_of(key) + "/" + std::to_string(result.size() + 1));
  }
  return result;
}

ConfigSection ConfigSection::section_or_empty(const std::string& key) {
  static const ConfigNode kEmptyMap = [] {
    ConfigNode node;
    node.kind = ConfigNode::Kind::kMap;
    return node;
  }();
  return has(key) ? section(key) : ConfigSection(kEmptyMap, path_of(key));
}

std::vector<std::string> ConfigSection::keys() const {
  std::vector<std::string> result;
  for (const auto& entry : node_.entries) result.push_back(entry.first);
  return result;
}

void ConfigSection::finish() const {
  const std::vector<std::string> known(asked_.begin(), asked_.end());
  std::vector<std::string> missing;
  for (const std::string& key : known) {
    if (node_.find(key) == nullptr) missing.push_back(key);
  }
  FaultList faults;
  for (const auto& [key, node] : node_.entries) {
    if (asked_.count(key) != 0) continue;
    const std::string meant = misspelling_of(key, missing);
    faults.add(ConfigError(node.origin, path_of(key), "one of the keys " + joined(known),
                           "the unknown key '" + key + "'" +
                               (meant.empty() ? "" : "; is it a misspelling of '" + meant + "'?")));
  }
  faults.require_none();
}

}  // namespace sampled_data_observers

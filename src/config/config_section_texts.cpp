// Lists and matrices of texts.
#include <utility>

#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {

std::vector<std::pair<std::string, std::string>> ConfigSection::named_texts(
    const std::string& key) {
  const std::string expected = "a list of maps of one key each";
  const ConfigNode& node = required(key, expected);
  if (node.kind != ConfigNode::Kind::kSequence) throw error(key, expected, node.describe());
  std::vector<std::pair<std::string, std::string>> result;
  for (const ConfigNode& item : node.items) {
    if (item.kind != ConfigNode::Kind::kMap || item.entries.size() != 1 ||
        item.entries.front().second.kind != ConfigNode::Kind::kScalar) {
      throw error(key, expected, item.describe());
    }
    result.emplace_back(item.entries.front().first, item.entries.front().second.scalar);
  }
  return result;
}

std::vector<std::vector<std::string>> ConfigSection::text_matrix(const std::string& key,
                                                                 std::size_t rows,
                                                                 std::size_t cols) {
  const std::string expected = "a " + std::to_string(rows) + " x " + std::to_string(cols) +
                               " matrix of numbers and formulas as a list of rows, each a list";
  const ConfigNode& node = required(key, expected);
  if (node.kind != ConfigNode::Kind::kSequence || node.items.size() != rows) {
    throw error(key, expected, node.describe());
  }
  std::vector<std::vector<std::string>> result;
  for (const ConfigNode& row : node.items) {
    if (row.kind != ConfigNode::Kind::kSequence || row.items.size() != cols) {
      throw error(key, expected, row.describe() + " as row " + std::to_string(result.size() + 1));
    }
    result.emplace_back();
    for (const ConfigNode& item : row.items) {
      if (item.kind != ConfigNode::Kind::kScalar) throw error(key, expected, item.describe());
      result.back().push_back(item.scalar);
    }
  }
  return result;
}

Eigen::MatrixXd ConfigSection::square_matrix(const std::string& key, Eigen::Index size) {
  if (!is_map(key)) return matrix(key, size, size);
  ConfigSection map = section(key);
  const Eigen::VectorXd diagonal = map.vector("diagonal", size);
  map.finish();
  return diagonal.asDiagonal();
}

std::vector<std::vector<std::string>> ConfigSection::text_lists(const std::string& key) {
  const std::string expected = "a list of lists of names";
  const ConfigNode& node = required(key, expected);
  if (node.kind != ConfigNode::Kind::kSequence) throw error(key, expected, node.describe());
  std::vector<std::vector<std::string>> result;
  for (const ConfigNode& list : node.items) {
    if (list.kind != ConfigNode::Kind::kSequence) {
      throw error(key, expected, list.describe() + " in the list");
    }
    result.emplace_back();
    for (const ConfigNode& item : list.items) {
      if (item.kind != ConfigNode::Kind::kScalar) throw error(key, expected, item.describe());
      result.back().push_back(item.scalar);
    }
  }
  return result;
}

}  // namespace sampled_data_observers

#pragma once

#include <Eigen/Core>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sampled_data_observers/config/config_node.h"

namespace sampled_data_observers {

/// A map of the configuration while it is read: strict conversions, and a record of the keys asked
/// for, so that finish() finds those that mean nothing.
///
/// Every reader throws a ConfigError when the key is missing (unless it has a fallback) or its
/// value is not what was asked for.
class ConfigSection {
 public:
  /// @param node  must outlive the section
  /// @param path  keys joined by '/', as messages show it; empty at the root
  /// @throws ConfigError when `node` is not a map.
  ConfigSection(const ConfigNode& node, std::string path);

  /// Whether the key is there, of whatever kind its value is; it counts as asked for.
  bool has(const std::string& key);

  /// A finite number.
  double number(const std::string& key);
  /// A finite number in [low, high].
  double number_in(const std::string& key, double low, double high, std::optional<double> fallback);
  /// A whole number in [low, high].
  std::size_t count(const std::string& key, std::size_t low, std::size_t high,
                    std::size_t fallback);

  /// A scalar that is not empty, as written.
  std::string text(const std::string& key);
  /// The same, or `fallback` where the key is missing.
  std::string text(const std::string& key, const std::string& fallback);
  /// One of `choices`.
  std::string choice(const std::string& key, const std::vector<std::string>& choices);
  /// A list of scalars of any length.
  std::vector<std::string> texts(const std::string& key);
  /// A list of `size` scalars.
  std::vector<std::string> texts(const std::string& key, std::size_t size);
  /// true or false.
  bool flag(const std::string& key, bool fallback);
  /// A list of `size` times true or false.
  std::vector<bool> flags(const std::string& key, std::size_t size);

  /// A matrix as nested lists, row by row. A negative size is free.
  Eigen::MatrixXd matrix(const std::string& key, Eigen::Index rows, Eigen::Index cols);
  /// A square matrix as nested lists, row by row, or as a map {diagonal: [its diagonal]}.
  Eigen::MatrixXd square_matrix(const std::string& key, Eigen::Index size);
  /// Whether the key has a matrix of finite numbers.
  bool is_matrix(const std::string& key);
  /// Names and texts in order, as a list of maps of one key each.
  std::vector<std::pair<std::string, std::string>> named_texts(const std::string& key);
  /// A matrix of texts, as nested lists, row by row.
  std::vector<std::vector<std::string>> text_matrix(const std::string& key, std::size_t rows,
                                                    std::size_t cols);
  /// A list of lists of scalars, each of any length.
  std::vector<std::vector<std::string>> text_lists(const std::string& key);
  /// A list of `size` finite numbers; of any number of them for -1.
  Eigen::VectorXd vector(const std::string& key, Eigen::Index size);
  /// A finite number from `low` to `high`, or infinity: `.inf`.
  double number_or_infinity_in(const std::string& key, double low, double high);
  /// A list of two numbers, low <= first <= second <= high, the second of which may also be
  /// infinite: `.inf`.
  Eigen::Vector2d interval_in(const std::string& key, double low, double high);
  /// A list of lists of finite numbers, each of any length; or one such list alone.
  std::vector<Eigen::VectorXd> vectors(const std::string& key);

  /// The map below a key, to be finished by itself.
  ConfigSection section(const std::string& key);
  /// A list of maps.
  std::vector<ConfigSection> sections(const std::string& key);
  /// A map whose keys are names that the user chose.
  std::vector<std::string> keys() const;
  /// Whether the key is there and its value is a map; it counts as asked for.
  bool is_map(const std::string& key);
  /// Whether the key is there and its value is a list; it counts as asked for.
  bool is_list(const std::string& key);
  /// Whether the key has a finite number.
  bool is_number(const std::string& key);
  /// A section that has no keys where the key is missing.
  ConfigSection section_or_empty(const std::string& key);

  /// @throws ConfigError for a key that was never asked for.
  void finish() const;

  /// Keys from the root to this section, joined by '/'; empty at the root.
  const std::string& path() const { return path_; }
  /// File and line, or parameters of a node, where the section stands.
  const std::string& origin() const { return node_.origin; }
  /// The path of a key of this section, as messages show it.
  std::string path_of(const std::string& key) const;

  /// A ConfigError at a key of this section.
  ConfigError error(const std::string& key, const std::string& expected,
                    const std::string& found) const;

  /// What is found where a key is missing, for a ConfigError: nothing, or a key that was not asked
  /// for yet and is likely to be a misspelling of it.
  std::string absence_of(const std::string& key) const;

 private:
  const ConfigNode& required(const std::string& key, const std::string& expected);

  const ConfigNode& node_;
  std::string path_;
  std::set<std::string> asked_;
};

}  // namespace sampled_data_observers

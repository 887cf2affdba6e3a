#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/plant/expression_map.h"

namespace sampled_data_observers {

/// Formulas and the names they may use, while a section is read.
class ExpressionReader {
 public:
  explicit ExpressionReader(ExpressionNames names) : names_(std::move(names)) {}

  /// Adds the formulas of a list of one-key maps, `- name: formula`, each for the later ones. Does
  /// nothing where the key is missing.
  void read_definitions(ConfigSection& section, const std::string& key);

  /// The map by the formulas below `key`, one for each of `names`, in their order.
  std::shared_ptr<const VectorMap> read_map(ConfigSection& section, const std::string& key,
                                            const std::vector<std::string>& names) const;

  /// The map by a list of formulas; any number where `size` is 0.
  std::shared_ptr<const VectorMap> read_list(ConfigSection& section, const std::string& key,
                                             std::size_t size) const;

  /// The map to one entry by the formula below `key`.
  std::shared_ptr<const VectorMap> read_text(ConfigSection& section, const std::string& key) const;

  /// The map whose entries are those of a matrix, row by row: an AffineMap where these are numbers.
  std::shared_ptr<const VectorMap> read_matrix(ConfigSection& section, const std::string& key,
                                               std::size_t rows, std::size_t cols) const;

  const ExpressionNames& names() const { return names_; }

 private:
  std::shared_ptr<const VectorMap> make(ConfigSection& section, const std::string& key,
                                        const std::vector<NamedExpression>& expressions) const;
  std::shared_ptr<const VectorMap> constant_map(const Eigen::MatrixXd& matrix) const;

  ExpressionNames names_;
  std::vector<NamedExpression> definitions_;
};

/// Reads a map of names to numbers; empty where the key is missing.
std::vector<std::pair<std::string, double>> read_constants(ConfigSection& root,
                                                           const std::string& key);

}  // namespace sampled_data_observers

#include "config/expression_config.h"

#include <utility>

#include "config/size_limits.h"

namespace sampled_data_observers {

void ExpressionReader::read_definitions(ConfigSection& section, const std::string& key) {
  if (!section.has(key)) return;
  auto texts = section.named_texts(key);
  require_at_most(kMostDefinitions, texts.size(), "definitions", section, key);
  for (auto& [name, formula] : texts) {
    definitions_.push_back({std::move(name), std::move(formula)});
  }
  make(section, key, {});  // reports faults where they stand
}

std::shared_ptr<const VectorMap> ExpressionReader::read_map(
    ConfigSection& section, const std::string& key, const std::vector<std::string>& names) const {
  ConfigSection formulas = section.section(key);
  std::vector<NamedExpression> expressions;
  for (const std::string& name : names) expressions.push_back({name, formulas.text(name)});
  formulas.finish();
  return make(section, key, expressions);
}

std::shared_ptr<const VectorMap> ExpressionReader::read_list(ConfigSection& section,
                                                             const std::string& key,
                                                             std::size_t size) const {
  const std::vector<std::string> texts = size == 0 ? section.texts(key) : section.texts(key, size);
  if (texts.empty()) throw section.error(key, "at least one formula", "an empty list");
  require_at_most(kMostFormulas, texts.size(), "formulas", section, key);
  std::vector<NamedExpression> expressions;
  for (const std::string& text : texts) {
    expressions.push_back({std::to_string(expressions.size() + 1), text});
  }
  return make(section, key, expressions);
}

std::shared_ptr<const VectorMap> ExpressionReader::read_text(ConfigSection& section,
                                                             const std::string& key) const {
  return make(section, key, {{key, section.text(key)}});
}

std::shared_ptr<const VectorMap> ExpressionReader::read_matrix(ConfigSection& section,
                                                               const std::string& key,
                                                               std::size_t rows,
                                                               std::size_t cols) const {
  const auto texts = section.text_matrix(key, rows, cols);
  if (section.is_matrix(key)) return constant_map(section.matrix(key, -1, -1));
  std::vector<NamedExpression> expressions;
  std::size_t i = 0;
  for (const std::vector<std::string>& row : texts) {
    ++i;
    std::size_t j = 0;
    for (const std::string& text : row) {
      expressions.push_back({"row " + std::to_string(i) + ", column " + std::to_string(++j), text});
    }
  }
  return make(section, key, expressions);
}

std::shared_ptr<const VectorMap> ExpressionReader::constant_map(
    const Eigen::MatrixXd& matrix) const {
  const Eigen::MatrixXd rows = matrix.transpose();
  const auto of = [&](const std::vector<std::string>& names) {
    return Eigen::MatrixXd::Zero(rows.size(), static_cast<Eigen::Index>(names.size()));
  };
  return std::make_shared<const AffineMap>(
      of(names_.x), of(names_.u), Eigen::Map<const Eigen::VectorXd>(rows.data(), rows.size()));
}

std::shared_ptr<const VectorMap> ExpressionReader::make(
    ConfigSection& section, const std::string& key,
    const std::vector<NamedExpression>& expressions) const {
  try {
    return std::make_shared<const ExpressionMap>(names_, definitions_, expressions);
  } catch (const ExpressionError& fault) {
    throw section.error(key, "formulas that can be evaluated", fault.name() + ": " + fault.what());
  }
}

std::vector<std::pair<std::string, double>> read_constants(ConfigSection& root,
                                                           const std::string& key) {
  std::vector<std::pair<std::string, double>> constants;
  ConfigSection section = root.section_or_empty(key);
  require_at_most(kMostParameters, section.keys().size(), "parameters", root, key);
  for (const std::string& name : section.keys()) {
    if (section.is_map(name)) {
      throw section.error(name, "a number: places of frames are known live and in replay only",
                          "a map");
    }
    constants.emplace_back(name, section.number(name));
  }
  return constants;
}

}  // namespace sampled_data_observers

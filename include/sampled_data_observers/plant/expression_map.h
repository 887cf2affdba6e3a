#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// A formula that can't be used; name() tells which one.
class ExpressionError : public std::invalid_argument {
 public:
  /// @param name   of the formula
  /// @param fault  what is wrong with it, for the user
  ExpressionError(std::string name, const std::string& fault)
      : std::invalid_argument(fault), name_(std::move(name)) {}

  /// The name of the formula as ExpressionMap got it.
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

/// A formula with the name by which messages, and later formulas, call it.
struct NamedExpression {
  std::string name;  ///< a letter or _, then letters, digits and _
  std::string text;  ///< in the syntax of ExpressionMap
};

/// The names that formulas may use.
struct ExpressionNames {
  std::vector<std::string> x;                             ///< of the states, n
  std::vector<std::string> u;                             ///< of the inputs, p
  std::vector<std::pair<std::string, double>> constants;  ///< and their values
};

/// A vector map by formulas such as "-2*sin(x1) - 3*x2 + x3", evaluated by muParser: the usual
/// operators and functions, `^` for powers, `c ? a : b`, and the constant `pi`.
///
/// Definitions are formulas that the later ones may use by their names; they are evaluated once
/// each time. Where a formula has no value (the root of -1, say), its entry is NaN or infinite.
class ExpressionMap : public VectorMap {
 public:
  /// @throws ExpressionError for a formula that does not parse or uses an unknown name, and for a
  /// name that formulas can't use.
  ExpressionMap(const ExpressionNames& names, const std::vector<NamedExpression>& definitions,
                const std::vector<NamedExpression>& expressions);
  ~ExpressionMap() override;

  Eigen::Index size() const override;
  void evaluate(const double* x, const double* u, double* out) const override;
  /// By symbolic differentiation. Where a formula jumps or has a kink, it is that of one side.
  std::shared_ptr<const VectorMap> jacobian() const override;

 private:
  struct Program;
  std::unique_ptr<Program> program_;
  ExpressionNames names_;
  std::vector<NamedExpression> definitions_;
  std::vector<NamedExpression> expressions_;
};

}  // namespace sampled_data_observers

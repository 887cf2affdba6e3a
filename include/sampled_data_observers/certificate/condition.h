#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/certificate/matrix_expression.h"
#include "sampled_data_observers/certificate/numeric_algebra.h"

namespace sampled_data_observers {

/// A matrix inequality of a theorem: a symmetric matrix that must be positive definite, for all τ
/// of an interval where it depends on τ.
struct Condition {
  /// The inequality as the paper has it, with its number: "M(T2) <= 0, ferrante2019 (28)".
  std::string name;
  /// What must be positive definite: for an inequality M < 0, −M.
  MatrixExpression positive_definite;
  /// [low, high] of τ [s]; none where the matrix does not depend on τ.
  struct Range {
    double low = 0.0;
    double high = 0.0;
  };
  std::optional<Range> tau;
};

/// How a condition came out in floating point.
struct ConditionCheck {
  std::string name;
  /// Least eigenvalue found, over its τ.
  double min_eigenvalue = 0.0;
  /// Where it was found [s].
  std::optional<double> tau;

  bool holds() const { return min_eigenvalue > 0.0; }
};

/// Least eigenvalue of each condition, in floating point; over τ on `points` equidistant values of
/// the interval (where its ends are far apart, also on as many of equal ratio), and refined between
/// them.
/// @throws as evaluate()
std::vector<ConditionCheck> check(const std::vector<Condition>& conditions,
                                  const NamedMatrices& values, std::size_t points = 65);

/// Whether all hold, and, where not, which ones do not and by how much, for a message.
bool all_hold(const std::vector<ConditionCheck>& checks);
std::string describe_violations(const std::vector<ConditionCheck>& checks);

}  // namespace sampled_data_observers

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "certificate/matrix_expression.h"
#include "certificate/numeric_algebra.h"

namespace sampled_data_observers {

/// A matrix inequality of a theorem: a symmetric matrix that must be positive definite, for all τ
/// of an interval where it depends on τ; or the domain of a number that the theorem speaks of.
struct Condition {
  enum class Kind {
    kDefinite,    ///< a matrix inequality
    kPositive,    ///< a number of the theorem is > 0
    kNonNegative  ///< a number of the theorem is >= 0
  };

  /// The inequality as the paper has it, with its number: "M(T2) <= 0, ferrante2019 (28)".
  std::string name;
  /// What must be positive definite: for an inequality M < 0, −M. Of a domain, a 1 x 1 matrix.
  MatrixExpression positive_definite;
  /// [low, high] of τ [s]; none where the matrix does not depend on τ.
  struct Range {
    double low = 0.0;
    double high = 0.0;
  };
  std::optional<Range> tau;
  Kind kind = Kind::kDefinite;
  /// Of a condition at a corner of a cell of a grid: which cell.
  std::optional<std::size_t> cell = std::nullopt;

  bool is_domain() const { return kind != Kind::kDefinite; }
};

/// "name > 0" and "name >= 0", for a scalar symbol of a theorem.
Condition positive(const std::string& name);
Condition not_negative(const std::string& name);

/// T1 >= 0, T2 > 0 and T1 <= T2: what all theorems ask of the times between samples or jumps [s].
/// A theorem that says nothing of T2 may have none, T2 = ∞.
std::vector<Condition> domain_of_times(double T1, double T2);

/// How a condition came out in floating point.
struct ConditionCheck {
  std::string name;
  Condition::Kind kind = Condition::Kind::kDefinite;
  /// Of a matrix inequality, the least eigenvalue that was found over its τ once the matrix is
  /// scaled by a congruence so that the absolute values on its diagonal are 1. So it does not
  /// depend on units, and is at most 1. Of a domain, the number itself. −∞ where not finite.
  double min_eigenvalue = 0.0;
  /// By how much rounding, and what lies between the values of τ looked at, may have changed it.
  double rounding = 0.0;
  /// Where it was found [s].
  std::optional<double> tau;

  /// How far inside, certainly.
  double margin() const { return min_eigenvalue - rounding; }
  bool holds() const {
    return kind == Condition::Kind::kNonNegative ? margin() >= 0.0 : margin() > 0.0;
  }
};

/// Checks conditions in floating point, with a bound on its own rounding; over τ on `points`
/// equidistant values of the interval (where its ends are far apart, also on as many of equal
/// ratio), refined between them, and enclosed between them by slope and curvature, on up to 512
/// cells; where these are used up, the points decide. Only prove() looks at all τ.
/// @throws as evaluate()
std::vector<ConditionCheck> check(const std::vector<Condition>& conditions,
                                  const NamedMatrices& values, std::size_t points = 65);

/// The least eigenvalue of a symmetric matrix over τ as it is, not scaled, found as by check(): for
/// figures of a theorem, not for its conditions. −∞ where it is not finite.
/// @throws as evaluate()
double least_eigenvalue(const MatrixExpression& matrix, const NamedMatrices& values,
                        Condition::Range range, std::size_t points = 65);

/// Whether all hold, and, where not, which one does least, by how much, and how many do not, for a
/// message.
bool all_hold(const std::vector<ConditionCheck>& checks);
std::string describe_violations(const std::vector<ConditionCheck>& checks);

/// The least margin() of the matrix inequalities and of the domains that are violated.
double least_margin(const std::vector<ConditionCheck>& checks);

}  // namespace sampled_data_observers

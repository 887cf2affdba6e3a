#pragma once

#include <optional>
#include <string>
#include <vector>

#include "certificate/condition.h"
#include "certificate/matrix_expression.h"
#include "certificate/numeric_algebra.h"
#include "design/affine_matrix.h"

namespace sampled_data_observers {

/// A semidefinite program in the notation of the papers: decision variables by name, and named
/// blocks, matrix expressions in them, that must be positive definite.
///
///     LmiProgram program;
///     const auto P = program.symmetric("P", n);
///     program.require_positive("P > 0", P);
///     program.require_negative("He(P A) < 0", He(P * A));
///     program.bound_above("P <= I", P, identity(n));
///     const LmiSolution solution = solve_lmi(program);
class LmiProgram {
 public:
  // Decision variables. Each may be used in expressions by its name as well.
  MatrixExpression symmetric(const std::string& name, Eigen::Index n);
  MatrixExpression matrix(const std::string& name, Eigen::Index rows, Eigen::Index cols);
  MatrixExpression scalar(const std::string& name);
  /// The square of a scalar symbol, such as γ², as variable; solutions have the scalar itself.
  MatrixExpression squared(const std::string& name);

  /// A symbol that is no variable here.
  void fix(const std::string& name, const Eigen::MatrixXd& value);

  /// Strict inequalities: kept away from the edge, by as much as possible where there is no
  /// objective.
  void require_positive(const std::string& name, const MatrixExpression& block);
  void require_negative(const std::string& name, const MatrixExpression& block);
  /// A condition of a theorem; where it depends on τ, one block at each of `points` values of it.
  /// The domain of a number that is no variable here, or a variable by its square, is none: the
  /// solver has no say in it.
  void require(const Condition& condition, std::size_t points);
  /// A condition of a theorem, at one value of τ [s].
  void require_at(const Condition& condition, double tau);
  /// Inequalities that only bound the solution: small <= large, met up to their edge.
  void bound_above(const std::string& name, const MatrixExpression& small,
                   const MatrixExpression& large);

  /// Minimizes a scalar expression. Without objective the solution is as far inside the strict
  /// inequalities as the bounds allow.
  void minimize(const MatrixExpression& objective);
  bool has_objective() const { return objective_.has_value(); }

  /// Number of scalar decision variables (as in Table II of ferrante2019).
  int scalar_variables() const { return variables_; }

  // What a solver needs.

  struct Block {
    std::string name;
    /// Must be positive semidefinite.
    AffineMatrix matrix;
    bool is_strict = false;
  };
  /// The blocks, symmetric to rounding, with all symbols in place, and each equilibrated: by a
  /// diagonal congruence its diagonal entries have 1 as their largest coefficient.
  std::vector<Block> compile() const;
  /// The objective, a 1 x 1 matrix, if there is one.
  std::optional<AffineMatrix> compile_objective() const;
  /// The values of the named variables from those of the scalar ones.
  NamedMatrices unpack(const std::vector<double>& x) const;
  /// The scalar variables in words, one named variable after the other, each column by column: "x1
  /// to x3: P, 2 x 2, symmetric".
  std::vector<std::string> describe_variables() const;

 private:
  struct Variable {
    std::string name;
    Eigen::Index rows = 1;
    Eigen::Index cols = 1;
    bool is_symmetric = false;
    bool is_square = false;
    int first = 0;
  };
  struct NamedBlock {
    std::string name;
    MatrixExpression expression;
    bool is_strict = false;
    double tau = 0.0;
  };

  class Algebra;

  MatrixExpression add(Variable variable, int scalars);
  static AffineMatrix of_variable(const Variable& variable);
  const Variable* find(const std::string& name, bool is_square) const;

  std::vector<Variable> variables_of_;
  int variables_ = 0;
  NamedMatrices fixed_;
  std::vector<NamedBlock> blocks_;
  std::optional<MatrixExpression> objective_;
};

}  // namespace sampled_data_observers

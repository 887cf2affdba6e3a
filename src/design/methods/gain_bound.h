#pragma once

#include <string>

#include "design/lmi_program.h"

namespace sampled_data_observers {

/// By which a bound in an inequality is smaller than what it stands for, which the solution, exact
/// to its tolerances only, is then within.
constexpr double kBoundShare = 1.0 - 1e-6;

/// Bounds a gain that is a variable itself by ‖L‖₂ <= k.
inline void bound_norm(LmiProgram& program, const std::string& gain, const MatrixExpression& L,
                       double bound) {
  const MatrixExpression k = kBoundShare * bound;
  const Eigen::Index size = L.rows() + L.cols();
  program.bound_above("norm of " + gain, zeros(size, size),
                      symmetric_blocks({{k * identity(L.rows()), L}, {k * identity(L.cols())}}));
}

/// Bounds a gain P⁻¹ J by ‖P⁻¹ J‖₂ <= k: Jᵀ P⁻¹ J <= q k² I and P >= q I with a new variable q.
inline void bound_gain(LmiProgram& program, const std::string& gain, const MatrixExpression& P,
                       const MatrixExpression& J, double bound) {
  const double k = kBoundShare * bound;
  const MatrixExpression q = program.scalar("q of " + gain);
  program.bound_above("q I <= P of " + gain, q * identity(P.rows()), P);
  const Eigen::Index size = J.rows() + J.cols();
  program.bound_above("norm of " + gain, zeros(size, size),
                      symmetric_blocks({{P, J}, {k * k * q * identity(J.cols())}}));
}

}  // namespace sampled_data_observers

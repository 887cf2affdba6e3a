#pragma once

#include <Eigen/Core>

#include "design/lmi_program.h"

namespace sampled_data_observers::test {

/// He(P A) < 0 with 0 < P <= I.
inline LmiProgram lyapunov(const Eigen::MatrixXd& A) {
  LmiProgram program;
  const MatrixExpression P = program.symmetric("P", A.rows());
  program.require_positive("P > 0", P);
  program.require_negative("He(P A) < 0", He(P * A));
  program.bound_above("P <= I", P, identity(A.rows()));
  return program;
}

/// A matrix with the eigenvalues -1 and -2.
inline Eigen::MatrixXd stable_plant() { return (Eigen::Matrix2d() << 0, 1, -2, -3).finished(); }

/// The L2 gain of dx/dt = -2 x + w, y = x, which is 1/2, by the bounded real lemma.
inline LmiProgram low_pass() {
  LmiProgram program;
  const MatrixExpression P = program.scalar("P");
  const MatrixExpression mu = program.squared("gamma");
  program.require_positive("P > 0", P);
  program.require_negative("bounded real lemma", symmetric_blocks({{-4.0 * P + 1.0, P}, {-mu}}));
  program.minimize(mu);
  return program;
}

/// x <= 1 and x >= 2.
inline LmiProgram contradiction() {
  LmiProgram program;
  const MatrixExpression x = program.scalar("x");
  program.bound_above("x <= 1", x, 1.0);
  program.bound_above("2 <= x", 2.0, x);
  program.minimize(x);
  return program;
}

}  // namespace sampled_data_observers::test

#include <stdexcept>

#include "certificate/ferrante2019_matrix.h"
#include "design/explanation_parts.h"
#include "design/lmi_solver.h"

namespace sampled_data_observers {
namespace {

bool is_about(const CertificateSubject& subject) {
  try {
    require_subject(*find_theorem("ferrante2019_theorem2"), subject);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

/// (31), with J = P1 L. It is what remains of M(τ) of (28) without the row and column of θ̃.
LmiProgram continuous_program(const PlantMatrices& plant) {
  const Eigen::Index n = plant.states();
  LmiProgram program;
  const MatrixExpression P1 = program.symmetric("P1", n);
  const MatrixExpression J = program.matrix("J", n, plant.C().rows());
  program.require_positive("P1 > 0", P1);
  if (!plant.is_linear()) program.require_positive("chi > 0", program.scalar("chi"));
  if (plant.N.cols() > 0 && plant.C_p.rows() > 0) {
    program.minimize(program.squared("gamma"));
  } else {
    program.bound_above("P1 <= I", P1, identity(n));
  }
  program.require_negative(
      "(31)",
      ferrante2019_with_inputs(
          plant, {{He(P1 * plant.A() - J * plant.C()) + ferrante2019_error_weight(plant, 0.0)}},
          [&](const MatrixExpression& input) {
            return std::vector<MatrixExpression>{P1 * input};
          }));
  return program;
}

}  // namespace

void say_least_gain(ExplanationContext& c) {
  if (!is_about(c.subject)) return;
  CertificateSubject relevant = c.subject;
  const bool has_gain = relevant.plant.N.cols() > 0 && relevant.plant.C_p.rows() > 0;
  if (!has_gain) {
    relevant.plant.N.resize(relevant.plant.states(), 0);
    relevant.plant.C_p.resize(0, relevant.plant.states());
  }
  // What samples at any interval, however short, can't do either.
  const LmiSolution solution = solve_here(continuous_program(relevant.plant));
  c.out.heading("WHAT NO T2 CAN DO");
  if (!solution.satisfies_all()) {
    c.out.paragraph("(31) of ferrante2019, of an observer that measures at all times, " +
                    why_unsolved(solution) +
                    (solution.status == SolverStatus::kInfeasible
                         ? ": its methods find no gains, however short T2 is."
                         : "."));
    return;
  }
  c.out.paragraph(
      "(31) of ferrante2019 has a solution: by Proposition 1 its methods find gains for a T2 that "
      "is "
      "short enough.");
  if (!has_gain) return;
  c.out.paragraph(
      "Even an observer that measures at all times has no gain gamma from the disturbance less "
      "than "
      "about " +
      brief(scalar_value(solution.values, "gamma")) +
      " by these methods (Remark 3: the H-infinity norm of its error, for any gain L and any "
      "rate); a T2 that asks for less has no design.");
}

}  // namespace sampled_data_observers

#include "design/assumed_disturbance.h"

#include "design/plant_scaling.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// In which a disturbance is taken to show as much as noise does, in multiples of T2.
constexpr double kDefaultHorizon = 5.0;
/// Of the weight of the state that shows most: the least of any other.
constexpr double kLeastWeight = 1e-3;

/// Whether the derivative of state i is a multiple of that of one other state, which is not its own
/// derivative: position of speed, angle of rate.
bool is_kinematic(const Eigen::MatrixXd& A, const Eigen::MatrixXd& G, Eigen::Index i) {
  const auto only_entry = [&](Eigen::Index row) {
    Eigen::Index entry = -1;
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      if (A(row, j) == 0.0) continue;
      if (entry >= 0) return Eigen::Index{-1};
      entry = j;
    }
    return entry;
  };
  if (G.row(i).cwiseAbs().sum() > 0.0) return false;
  const Eigen::Index j = only_entry(i);
  return j >= 0 && j != i && (j > i || only_entry(j) != i);
}

/// The largest |C ∫_0^t e^{As} ds N| for t up to the horizon, column by column of N.
Eigen::VectorXd shown_within_horizon(const CertificateSubject& subject, const Eigen::MatrixXd& N) {
  constexpr int kSteps = 100;
  const Eigen::MatrixXd& A = subject.plant.A();
  const Eigen::Index n = A.rows();
  const double step = kDefaultHorizon * time_scale(subject) / kSteps;
  Eigen::MatrixXd augmented = Eigen::MatrixXd::Zero(n + N.cols(), n + N.cols());
  augmented.topLeftCorner(n, n) = A;
  augmented.topRightCorner(n, N.cols()) = N;
  const Eigen::MatrixXd flow = exponential_of(augmented * step);
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(n, N.cols());
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(N.cols());
  for (int i = 0; i < kSteps; ++i) {
    state = (flow.topLeftCorner(n, n) * state + flow.topRightCorner(n, N.cols())).eval();
    largest = largest.cwiseMax((subject.plant.C() * state).colwise().norm().transpose()).eval();
  }
  return largest;
}

}  // namespace

Eigen::VectorXd weights_of_design(const CertificateSubject& subject) {
  if (subject.error_weights.size() > 0) {
    return subject.error_weights.cwiseMax(kLeastWeight * subject.error_weights.maxCoeff());
  }
  constexpr int kSteps = 100;
  const Eigen::MatrixXd flow =
      exponential_of(subject.plant.A() * (kDefaultHorizon * time_scale(subject) / kSteps));
  Eigen::MatrixXd outputs = subject.plant.C();
  Eigen::VectorXd weights = outputs.colwise().norm().transpose();
  for (int i = 0; i < kSteps; ++i) {
    outputs = (outputs * flow).eval();
    weights = weights.cwiseMax(outputs.colwise().norm().transpose()).eval();
  }
  return weights.cwiseMax(kLeastWeight * weights.maxCoeff());
}

Eigen::MatrixXd default_disturbance_input(const CertificateSubject& subject) {
  const Eigen::MatrixXd& A = subject.plant.A();
  const Eigen::Index n = A.rows();
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd shown = shown_within_horizon(subject, unit);
  const Eigen::VectorXd in_any_units = shown_within_horizon(balanced(subject), unit);
  Eigen::MatrixXd N(n, 0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool is_shown = in_any_units(i) > 1e-12 * in_any_units.maxCoeff();
    if (is_kinematic(A, subject.plant.G, i) || !is_shown) continue;
    N.conservativeResize(n, N.cols() + 1);
    N.rightCols(1) = unit.col(i) / shown(i);
  }
  return N;
}

double default_disturbance(const CertificateSubject& subject, double noise) {
  if (subject.plant.N.cols() == 0) return 0.0;
  const double shown = shown_within_horizon(subject, subject.plant.N).maxCoeff();
  return shown > 0.0 ? noise / shown : 0.0;
}

void assume(const DeclaredAssumptions& declared, DesignProblem& problem) {
  PlantMatrices& plant = problem.subject.plant;
  ErrorAssumptions& assumptions = problem.assumptions;
  plant.C_p.resize(0, plant.states());
  assumptions.noise = declared.noise.value_or(1.0);
  const bool has_disturbance = declared.disturbance.value_or(1.0) > 0.0;
  if (has_disturbance && plant.N.cols() == 0) plant.N = default_disturbance_input(problem.subject);
  assumptions.disturbance = declared.disturbance
                                ? *declared.disturbance
                                : default_disturbance(problem.subject, assumptions.noise);
  if (assumptions.disturbance == 0.0) plant.N.resize(plant.states(), 0);
  // Of nothing at all no gains are the best.
  if (assumptions.noise == 0.0 && assumptions.disturbance == 0.0) assumptions.noise = 1.0;
}

}  // namespace sampled_data_observers

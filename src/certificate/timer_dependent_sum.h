#pragma once

#include <optional>
#include <string>
#include <vector>

#include "certificate/condition.h"
#include "certificate/error_system.h"

namespace sampled_data_observers {

/// A Lyapunov function V(e, τ) = eᵀ (P_c + Σ_i P_i(τ_i)) e of an error, each P_i affine in the
/// timer i between nodes, and what must hold of it: doc/timer_dependent.md has the theorem and its
/// proof. Its conditions are split over the timers, each of which sees the nodes of one timer, so
/// that their number grows with the square of that of the sensors, and not exponentially.
///
/// The symbols, with `size` N of the error, s of its nonlinearity, n_w of its disturbance:
///   P_constant         N x N: P_c
///   P/SENSOR/k         N x N: P_i at the node k of its timer
///   P_most/SENSOR      N x N: not less than P_i at any node
///   P_after/SENSOR     N x N: not less than P just after a sample, P_c + P_i(0) + Σ P_most_j, j ≠
///   i flow_part/SENSOR   N + s + n_w: not less than what P_i has of the flow condition; of flows
///   in
///                      a convex hull, flow_part/SENSOR/v of each vertex
///   jump_part/SENSOR/OTHER  N + m: not more than what P_OTHER has of the condition of SENSOR
///   jump_parts/SENSOR  N + m: not more than their sum over all others
///   nu/SENSOR          noise level ν_i
///   chi/SENSOR/k       where the error has a nonlinearity
class TimerDependentSum {
 public:
  /// @param nodes     of each timer [s]
  /// @param shortest  of each timer [s]
  /// @pre the system's resets have constant gains, J = I and T1 > 0
  TimerDependentSum(ErrorSystem system, std::vector<std::vector<double>> nodes,
                    std::vector<double> shortest);

  const ErrorSystem& system() const { return system_; }
  std::size_t timers() const { return nodes_.size(); }
  /// Of one timer [s].
  const std::vector<double>& nodes(std::size_t timer) const { return nodes_[timer]; }
  double shortest(std::size_t timer) const { return shortest_[timer]; }

  // N x N each
  MatrixExpression P_constant() const;
  MatrixExpression P(std::size_t timer, std::size_t node) const;
  MatrixExpression P_most(std::size_t timer) const;
  MatrixExpression P_after(std::size_t timer) const;
  // N + m_i each
  MatrixExpression jump_part(std::size_t timer, std::size_t other) const;
  MatrixExpression jump_parts(std::size_t timer) const;

  std::vector<NamedShape> shapes() const;

  /// In the symbols of shapes(), of the gains, lambda_t, and gamma where there is a disturbance.
  /// Those of the flow have the number of a cell: the cells of the first timer, then those of the
  /// second, and so on.
  std::vector<Condition> conditions() const;

  /// Those that P_c and all P_i are positive definite, and of the flow.
  std::vector<Condition> flow_conditions() const;

 private:
  std::string name_of(const std::string& symbol, std::size_t timer) const;
  Eigen::Index flow_size() const;
  MatrixExpression flow_part(std::size_t timer, std::size_t vertex) const;
  MatrixExpression form_of_flow(const MatrixExpression& P, const MatrixExpression& F,
                                const std::optional<MatrixExpression>& slope,
                                const std::optional<MatrixExpression>& chi) const;
  MatrixExpression rest_of_flow(std::size_t vertex) const;
  MatrixExpression form_of_jump(std::size_t timer, const MatrixExpression& P) const;
  MatrixExpression jump_condition(std::size_t timer, std::size_t node) const;
  void add_jump_conditions(std::vector<Condition>& all) const;

  ErrorSystem system_;
  std::vector<std::vector<double>> nodes_;
  std::vector<double> shortest_;
};

}  // namespace sampled_data_observers

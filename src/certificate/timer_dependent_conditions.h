#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "certificate/condition.h"
#include "certificate/error_system.h"
#include "certificate/timer_grid.h"
#include "linear_algebra/tensor_grid.h"

namespace sampled_data_observers {

/// Products in which a design is linear in place of the gains K of resets; see
/// TimerDependentFunction.
struct GainProducts {
  /// P⁺ K, N x m, at a node of the grid, P⁺ being P after the reset of the timer.
  std::function<MatrixExpression(std::size_t timer, std::size_t node)> P_K;
  /// Z of P_k K = Cᵀ Z, m x m, which is all that is left to choose at a node at which an event may
  /// coincide with another one of its timer; none where that is so of no timer.
  std::function<MatrixExpression(std::size_t timer, std::size_t node)> Z = nullptr;
};

/// A Lyapunov function V(e, τ) = eᵀ P(τ) e of an error, multi-affine in the timers τ between the
/// nodes of a grid, and what must hold of it: doc/timer_dependent.md has the theorem and its proof.
///
/// At the node k, P_k is the symbol P/k, of a plant that switches P/MODE/k: then each mode has a
/// function, on the same grid. Where a timer may be 0 at an event (T1 = 0), the jump
/// condition there is an equality in the directions that are not measured. So that rounding does
/// not decide it, the gain is of a form that makes it one for any numbers, P_k K = Cᵀ Z (ErrorReset
/// has Z), or, of one timer and a gain that is given as K, P_0 is:
///   P_0 = Cᵀ X C + Πᵀ Y Π, Π = I − K (C K)⁻¹ C,
/// with the symbols P_measured for X (m x m) and P_rest for Y (N x N): then K does not show in
/// Π e⁺ = Π e, and C e⁺ = (I − C K) C e.
class TimerDependentFunction {
 public:
  /// @param shortest  of each timer [s]
  /// @param products  in place of the gains, where those are to be found; P_0 is P/0 then
  /// @param falls_at_events  whether V falls by the factor mu at events, the symbol of a number
  /// @pre where several timers have T1 = 0, their gains are of that form; where V falls at events
  ///   there is one timer with T1 > 0
  TimerDependentFunction(ErrorSystem system, TensorGrid grid, std::vector<double> shortest,
                         std::optional<GainProducts> products = std::nullopt,
                         bool falls_at_events = false);

  const ErrorSystem& system() const { return system_; }
  const TensorGrid& grid() const { return grid_; }
  /// Of each timer [s].
  const std::vector<double>& shortest() const { return shortest_; }
  bool falls_at_events() const { return falls_at_events_; }

  /// Whether a reset may take place at a node.
  bool is_foreseen(std::size_t timer, std::size_t node) const;

  /// N x N: P_k.
  MatrixExpression P(std::size_t node) const;
  /// Whether P/k is a symbol of its own.
  bool is_free(std::size_t node) const {
    return products_ || node != 0 || shortest_.front() > 0.0 || system_.resets.front().Z;
  }

  /// P/k, P_measured, P_rest, a noise level nu/NAME of each reset with outputs, and chi/k where the
  /// error has a nonlinearity.
  std::vector<NamedShape> shapes() const;

  /// P_k > 0, the flow at all corners of all cells, and the jumps at all nodes where they may be;
  /// in the symbols of shapes(), of the gains, lambda_t, mu where V falls at events, and gamma
  /// where there is a disturbance.
  std::vector<Condition> conditions() const;

  /// Those but for the jumps.
  std::vector<Condition> flow_conditions() const;
  /// The jumps of a timer that lead to the function of another mode.
  std::vector<Condition> jumps_into(const TimerDependentFunction& next, std::size_t timer) const;

 private:
  std::string name_of_P(std::size_t node) const;
  MatrixExpression derivative(const CellCorner& corner, const MatrixExpression& F) const;
  MatrixExpression flow(const CellCorner& corner, const MatrixExpression& F) const;
  MatrixExpression jump(std::size_t timer, std::size_t node, const MatrixExpression& after) const;
  MatrixExpression jump_condition(std::size_t timer, std::size_t node) const;
  MatrixExpression coinciding_jump() const;
  MatrixExpression coinciding_jump(std::size_t timer, std::size_t node,
                                   const MatrixExpression& Z) const;

  ErrorSystem system_;
  TensorGrid grid_;
  std::vector<double> shortest_;
  std::optional<GainProducts> products_;
  bool falls_at_events_;
};

}  // namespace sampled_data_observers

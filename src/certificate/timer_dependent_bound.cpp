#include "certificate/timer_dependent_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "certificate/bound_flow.h"
#include "certificate/outward.h"
#include "certificate/rounded_matrix.h"
#include "certificate/sublevel_set.h"
#include "certificate/timer_grid.h"
#include "certificate/weighted_norm.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kNothingKnown = std::numeric_limits<double>::infinity();
constexpr double kNanoseconds = 1e9;  // in a second
constexpr std::size_t kNoTimer = std::numeric_limits<std::size_t>::max();
/// P_0 that is computed of other matrices may be off by this share of itself.
constexpr double kLargestShare = 0.1;

double square_of(double value) { return value * value; }

/// δ of P <= (1 + δ) P_k and P_k <= (1 + δ) P, P_k being exact and P its computed value.
double share_of_rounding(const MatrixExpression& P, const NamedMatrices& values) {
  const RoundedMatrix rounded = evaluate_with_rounding(P, values);
  const Eigen::MatrixXd inverse_R = inverse_of(cholesky_root(rounded.value)).cwiseAbs();
  const double share = 2.0 * std::numeric_limits<double>::epsilon() *
                       (inverse_R.transpose() * rounded.error * inverse_R).norm();
  if (share <= kLargestShare) return share;
  throw std::invalid_argument(
      "P/0 is lost in rounding: write states in units in which they are of like size, and design "
      "again");
}

/// √(δKᵀ P⁺ δK) at most in a cell, of what ScheduledGain::evaluate() computes. Its Cholesky factors
/// solve for P⁺ + δP with |δP| <= n (n + 10) ε/2 d dᵀ, d² the diagonal, and what it solves for is
/// off by as much of d |d K|, and by the weights.
double gain_rounding_of(const std::vector<Eigen::MatrixXd>& P, const TensorGrid& grid,
                        const ErrorReset& reset, std::size_t timer,
                        const std::vector<CellCorner>& corners, const NamedMatrices& values,
                        double weight_rounding) {
  const auto n = static_cast<double>(P.front().rows());
  Eigen::VectorXd d = Eigen::VectorXd::Zero(P.front().rows());
  for (const CellCorner& corner : corners) {
    d = d.cwiseMax(P[grid.with_first(corner.node, timer)].diagonal().cwiseSqrt());
  }
  const Eigen::VectorXd inverse_d = d.cwiseInverse();
  double least = 1.0;
  double largest = 0.0;
  for (const CellCorner& corner : corners) {
    const std::size_t first = grid.with_first(corner.node, timer);
    const Eigen::MatrixXd scaled = inverse_d.asDiagonal() * P[first] * inverse_d.asDiagonal();
    least = std::min(least, positive_least_eigenvalue(scaled, "P/" + std::to_string(first)));
    largest = std::max(largest, (d.asDiagonal() * evaluate(reset.K(corner.node), values)).norm());
  }
  const double share = 64.0 * n * n * std::numeric_limits<double>::epsilon() +
                       std::ldexp(n * weight_rounding, static_cast<int>(grid.dimensions()));
  // Of one timer P⁺ is P_0 everywhere, and the gain the plain mean of what is given.
  const bool solves = grid.dimensions() > 1 || reset.Z;
  return share * std::sqrt(n) * largest / (solves ? least : 1.0);
}

}  // namespace

TimerDependentBound::TimerDependentBound(const TimerDependentFunction& function,
                                         std::vector<double> longest, const NamedMatrices& values,
                                         const ErrorAssumptions& assumptions)
    : grid_(function.grid()),
      shortest_(function.shortest()),
      longest_(std::move(longest)),
      weight_rounding_(weight_rounding(grid_)),
      rate_(2.0 * scalar_value(values, "lambda_t")),
      fall_(function.falls_at_events() ? scalar_value(values, "mu") : 1.0),
      noise_(assumptions.noise),
      initial_error_(assumptions.initial_error),
      initial_injection_(assumptions.initial_injection),
      injects_(function.system().size > function.system().states) {
  const ErrorSystem& system = function.system();
  if (assumptions.disturbance > 0.0) {
    if (system.N.cols() == 0) {
      throw std::invalid_argument("it is about plants without disturbance: give design/N");
    }
    push_ = square_of(scalar_value(values, "gamma") * assumptions.disturbance);
  }
  for (std::size_t timer = 0; timer < system.resets.size(); ++timer) {
    const ErrorReset& reset = system.resets[timer];
    if (reset.position >= timer_of_.size()) timer_of_.resize(reset.position + 1, kNoTimer);
    timer_of_[reset.position] = timer;
    nu_.push_back(reset.C.rows() > 0 ? scalar_value(values, "nu/" + reset.name) : 0.0);
  }
  compute_nodes(function, values, assumptions.disturbance);
}

void TimerDependentBound::compute_nodes(const TimerDependentFunction& function,
                                        const NamedMatrices& values, double disturbance) {
  const ErrorSystem& system = function.system();
  const Eigen::Index n = system.states;
  const Eigen::Index rest = system.size - n;
  std::vector<Eigen::MatrixXd> P;
  for (std::size_t k = 0; k < grid_.size(); ++k) P.push_back(evaluate(function.P(k), values));
  const double horizon = *std::max_element(longest_.begin(), longest_.end());
  late_flow_.emplace(function, values, P, disturbance, horizon);
  // What the exact P is at most, in terms of the computed one.
  const double raise_of_first =
      function.is_free(0) ? 1.0 : 1.0 + share_of_rounding(function.P(0), values);
  const auto raise_of = [&](std::size_t k) { return k == 0 ? raise_of_first : 1.0; };
  for (std::size_t k = 0; k < grid_.size(); ++k) {
    Node node;
    node.inverse =
        inverse_above(function.P(k), values, "P/" + std::to_string(k)).topLeftCorner(n, n);
    node.inverse_norm = largest_eigenvalue_above(node.inverse);
    const Eigen::MatrixXd of_state = P[k].topLeftCorner(n, n);
    node.form = FormMaximum(of_state, of_state.cwiseAbs());
    node.raise = raise_of(k);
    node.of_state = raise_of(k) * largest_eigenvalue_above(of_state);
    if (rest > 0) {
      node.of_injection =
          raise_of(k) * largest_eigenvalue_above(P[k].bottomRightCorner(rest, rest));
    }
    for (std::size_t timer = 0; timer < system.resets.size(); ++timer) {
      const std::size_t first = grid_.with_first(k, timer);
      const Eigen::MatrixXd& after = P[first];
      const ErrorReset& reset = system.resets[timer];
      MatrixExpression map = reset.J;
      double of_noise = 0.0;
      if (reset.C.rows() > 0) {
        const Eigen::MatrixXd K = evaluate(reset.K(k), values);
        map = map - MatrixExpression(K) * MatrixExpression(reset.C);
        of_noise = norm_into(after, K);
      }
      node.mu.push_back(raise_of(first) * raise_of(k) *
                        raised(square_of(norm_between(P[k], after, map))));
      node.rho.push_back(raise_of(first) * raised(square_of(of_noise)));
      if (reset.is_constant) continue;
      node.output.push_back(largest_eigenvalue_above(reset.C * node.inverse * reset.C.transpose()));
    }
    nodes_.push_back(std::move(node));
  }
  for (const std::vector<CellCorner>& corners : cells_of(grid_)) {
    Node& lowest = nodes_[corners.front().node];
    for (std::size_t timer = 0; timer < system.resets.size(); ++timer) {
      const ErrorReset& reset = system.resets[timer];
      if (reset.is_constant) continue;
      lowest.gain_rounding.push_back(
          gain_rounding_of(P, grid_, reset, timer, corners, values, weight_rounding_));
    }
  }
}

double TimerDependentBound::time_of(std::size_t timer, const double* state) const {
  return state[kTimers + static_cast<Eigen::Index>(timer)] / kNanoseconds;
}

TensorGrid::Interpolation TimerDependentBound::interpolation(const double* state,
                                                             double later) const {
  std::array<double, TensorGrid::kMaxDimensions> times = {};
  for (std::size_t timer = 0; timer < grid_.dimensions(); ++timer) {
    times[timer] = time_of(timer, state) + later;
  }
  return grid_.locate(times.data());
}

void TimerDependentBound::initialize(double* state) const {
  std::fill(state, state + state_size(), 0.0);
  begin(initial_error_, state);
}

void TimerDependentBound::begin(double error, double* state) const {
  const TensorGrid::Interpolation here = interpolation(state, 0.0);
  double of_state = 0.0;
  double of_injection = 0.0;
  for (std::size_t i = 0; i < here.size; ++i) {
    const Node& node = nodes_[here.vertices[i]];
    of_state += (here.weights[i] + weight_rounding_) * node.of_state;
    of_injection += (here.weights[i] + weight_rounding_) * node.of_injection;
  }
  state[kW] = square_of(std::sqrt(of_state) * error + std::sqrt(of_injection) * initial_injection_);
}

/// The largest of eᵀ P(τ) e is at most the mean of those at the corners.
void TimerDependentBound::narrow(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const {
  if (state[kW] == kNothingKnown) return;
  const TensorGrid::Interpolation here = interpolation(state, 0.0);
  double of_state = 0.0;
  double of_injection = 0.0;
  for (std::size_t i = 0; i < here.size; ++i) {
    const Node& node = nodes_[here.vertices[i]];
    const double weight = here.weights[i] + weight_rounding_;
    of_state += weight * node.raise * node.form.over(Q);
    of_injection += weight * node.of_injection;
  }
  const double root = std::sqrt(of_state) + std::sqrt(of_injection) * initial_injection_;
  state[kW] = std::min(state[kW], raised(square_of(root)));
}

void TimerDependentBound::begin_at_sample(std::size_t sensor, double error, double* state) const {
  state[kTimers + static_cast<Eigen::Index>(timer_of_[sensor])] = 0.0;
  begin(error, state);
}

void TimerDependentBound::flow(double duration, double* state) const {
  double& W = state[kW];
  const double start = W;
  double left = duration;
  double passed = 0.0;
  bool is_late = false;
  double late_from = 0.0;
  double W_there = 0.0;
  while (left > 0.0 && W < kNothingKnown) {
    std::size_t late = 0;
    double piece = left;
    for (std::size_t timer = 0; timer < grid_.dimensions(); ++timer) {
      const double before_late = longest_[timer] - (time_of(timer, state) + passed);
      if (before_late <= 0.0) {
        late |= std::size_t{1} << timer;
      } else {
        piece = std::min(piece, before_late);
      }
    }
    if (late != 0 && !is_late) {
      is_late = true;
      late_from = passed;
      W_there = W;
    }
    W = late == 0 ? flowed_linearly(W, -rate_, push_, piece)
                  : square_of(late_flow_->flowed(late, std::sqrt(W), piece));
    passed = piece == left ? duration : passed + piece;
    left -= piece;
  }
  if (is_late) {
    const auto by_Q = [&](double from, double W_from) {
      return square_of(late_flow_->flowed_in_Q(interpolation(state, from), std::sqrt(W_from),
                                               duration - from, interpolation(state, duration),
                                               weight_rounding_));
    };
    W = std::min({W, by_Q(0.0, start), by_Q(late_from, W_there)});
  }
  advance_timers(duration, state);
}

void TimerDependentBound::advance_timers(double duration, double* state) const {
  const double nanoseconds = std::round(duration * kNanoseconds);
  for (std::size_t timer = 0; timer < grid_.dimensions(); ++timer) {
    state[kTimers + static_cast<Eigen::Index>(timer)] += nanoseconds;
  }
}

double TimerDependentBound::largest_here(const std::vector<double>& of_nodes,
                                         const double* state) const {
  const TensorGrid::Interpolation here = interpolation(state, 0.0);
  double largest = 0.0;
  for (std::size_t i = 0; i < here.size; ++i) {
    largest = std::max(largest, of_nodes[here.vertices[i]]);
  }
  return largest;
}

double TimerDependentBound::foreseen(std::size_t timer, double W) const {
  return fall_ * W + nu_[timer] * square_of(noise_);
}

void TimerDependentBound::reset(std::size_t timer, double* state) const {
  const TensorGrid::Interpolation here = interpolation(state, 0.0);
  double mu = 0.0;
  double rho = 0.0;
  for (std::size_t i = 0; i < here.size; ++i) {
    mu = std::max(mu, nodes_[here.vertices[i]].mu[timer]);
    rho = std::max(rho, nodes_[here.vertices[i]].rho[timer]);
  }
  double after = square_of(std::sqrt(mu * state[kW]) + std::sqrt(rho) * noise_);
  if (time_of(timer, state) >= shortest_[timer]) {
    after = std::min(after, foreseen(timer, state[kW]));
  }
  const Node& lowest = nodes_[here.vertices.front()];
  if (!lowest.gain_rounding.empty()) {
    double output = 0.0;
    for (std::size_t i = 0; i < here.size; ++i) {
      output += (here.weights[i] + weight_rounding_) * nodes_[here.vertices[i]].output[timer];
    }
    const double innovation = std::sqrt(raised(state[kW] * output)) + noise_;
    after = square_of(std::sqrt(after) + lowest.gain_rounding[timer] * innovation);
  }
  state[kW] = after;
  state[kTimers + static_cast<Eigen::Index>(timer)] = 0.0;
}

void TimerDependentBound::sample(std::size_t sensor, double* state, double*) const {
  if (state[kW] == kNothingKnown) return;
  reset(timer_of_[sensor], state);
}

void TimerDependentBound::jump(const JumpMotion&, double* state) const {
  state[kW] = kNothingKnown;
}

double TimerDependentBound::bound(const double* state) const {
  if (state[kW] == kNothingKnown) return kNothingKnown;
  const TensorGrid::Interpolation here = interpolation(state, 0.0);
  double norm = 0.0;
  for (std::size_t i = 0; i < here.size; ++i) {
    norm += (here.weights[i] + weight_rounding_) * nodes_[here.vertices[i]].inverse_norm;
  }
  return std::sqrt(raised(state[kW] * norm));
}

void TimerDependentBound::state_bounds(const double* state, double*,
                                       Eigen::Ref<Eigen::VectorXd> bounds) const {
  if (state[kW] == kNothingKnown) {
    bounds.setConstant(kNothingKnown);
    return;
  }
  const TensorGrid::Interpolation here = interpolation(state, 0.0);
  for (Eigen::Index j = 0; j < bounds.size(); ++j) {
    double entry = 0.0;
    for (std::size_t i = 0; i < here.size; ++i) {
      entry += (here.weights[i] + weight_rounding_) * nodes_[here.vertices[i]].inverse(j, j);
    }
    bounds(j) = std::sqrt(raised(state[kW] * entry));
  }
}

void TimerDependentBound::ellipsoid(const double* state, double*,
                                    Eigen::Ref<Eigen::MatrixXd> Q) const {
  if (state[kW] == kNothingKnown) {
    Q.setConstant(kNothingKnown);
    return;
  }
  const TensorGrid::Interpolation here = interpolation(state, 0.0);
  Q.setZero();
  for (std::size_t i = 0; i < here.size; ++i) {
    const Node& node = nodes_[here.vertices[i]];
    Q += (here.weights[i] + weight_rounding_) * node.inverse;
  }
  // With room for the rounding of the sum.
  Q.diagonal() += Q.diagonal() * 1e-9;
  Q *= state[kW];
}

}  // namespace sampled_data_observers

#include "certificate/timer_dependent_sum_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "certificate/bound_flow.h"
#include "certificate/flow_growth.h"
#include "certificate/form_quotient.h"
#include "certificate/outward.h"
#include "certificate/sublevel_set.h"
#include "certificate/timer_grid.h"

namespace sampled_data_observers {
namespace {

constexpr double kLostTrack = std::numeric_limits<double>::infinity();
constexpr double kTicks = 1e9;  // in a second
constexpr std::size_t kOfNoTimer = std::numeric_limits<std::size_t>::max();
/// The flow may grow by so many times more in the second of the norms that are made for it.
constexpr double kQuicker = 20.0;

double square_root_sum(double a, double b) { return (a + b) * (a + b); }

/// Rows and columns [first, first + size) of a symmetric expression.
MatrixExpression block_of(const MatrixExpression& P, Eigen::Index first, Eigen::Index size) {
  Eigen::MatrixXd picks = Eigen::MatrixXd::Zero(P.rows(), size);
  picks.middleRows(first, size).setIdentity();
  return transpose(MatrixExpression(picks)) * P * MatrixExpression(picks);
}

/// Not less than the largest eigenvalue of a symmetric matrix, or than 0.
double norm_above(const MatrixExpression& P, const NamedMatrices& values) {
  return P.rows() == 0 ? 0.0 : form_quotient_above(P, identity(P.rows()), values);
}

/// φ with P_i(τ_i) >= φ P_i(T2_i) at each node, and so between them.
double share_of_last(const TimerDependentSum& sum, std::size_t timer, const NamedMatrices& values) {
  const std::size_t last = sum.nodes(timer).size() - 1;
  double largest = 1.0;
  for (std::size_t node = 0; node < last; ++node) {
    largest =
        std::max(largest, form_quotient_above(sum.P(timer, last), sum.P(timer, node), values));
  }
  return 1.0 / raised(largest);
}

/// Not more than P(τ) where the timer is at a node.
MatrixExpression least_at(const TimerDependentSum& sum, std::size_t timer, std::size_t node,
                          const std::vector<double>& shares) {
  MatrixExpression P = sum.P_constant() + sum.P(timer, node);
  for (std::size_t other = 0; other < sum.timers(); ++other) {
    if (other == timer) continue;
    P = P + shares[other] * sum.P(other, sum.nodes(other).size() - 1);
  }
  return P;
}

}  // namespace

TimerDependentSumBound::TimerDependentSumBound(const TimerDependentSum& sum,
                                               std::vector<double> longest,
                                               const NamedMatrices& values,
                                               const ErrorAssumptions& assumptions)
    : rate_(2.0 * scalar_value(values, "lambda_t")),
      noise_(assumptions.noise),
      initial_error_(assumptions.initial_error),
      initial_injection_(assumptions.initial_injection),
      injects_(sum.system().size > sum.system().states) {
  const ErrorSystem& system = sum.system();
  if (assumptions.disturbance > 0.0) {
    if (system.N.cols() == 0) {
      throw std::invalid_argument("it is about plants without disturbance: give design/N");
    }
    const double root = scalar_value(values, "gamma") * assumptions.disturbance;
    push_ = root * root;
  }
  std::vector<Eigen::MatrixXd> F;
  for (const MatrixExpression& flow : system.F) F.push_back(evaluate(flow, values));
  MatrixExpression at_0 = sum.P_constant();
  std::vector<double> shares;
  for (std::size_t timer = 0; timer < sum.timers(); ++timer) {
    const std::size_t position = system.resets[timer].position;
    if (position >= timer_of_.size()) timer_of_.resize(position + 1, kOfNoTimer);
    timer_of_[position] = timer;
    timers_.emplace_back();
    timers_.back().times = sum.nodes(timer);
    timers_.back().longest = longest[timer];
    at_0 = at_0 + sum.P(timer, 0);
    shares.push_back(share_of_last(sum, timer, values));
  }
  const Eigen::Index n = system.states;
  const Eigen::Index rest = system.size - n;
  of_state_ = norm_above(block_of(sum.P_constant(), 0, n), values);
  of_injection_ = norm_above(block_of(sum.P_constant(), n, rest), values);
  of_state_at_0_ = norm_above(block_of(at_0, 0, n), values);
  of_injection_at_0_ = norm_above(block_of(at_0, n, rest), values);

  const Eigen::MatrixXd first = evaluate(at_0, values);
  std::vector<Eigen::MatrixXd> norms = {(first + first.transpose()) / 2.0};
  const double horizon = *std::max_element(longest.begin(), longest.end());
  for (const double time : {horizon, horizon / kQuicker}) {
    const Eigen::MatrixXd W = flow_growth(F.front(), time).W;
    const Eigen::MatrixXd Q = W.transpose() * W;
    norms.emplace_back((Q + Q.transpose()) / 2.0);
  }
  for (const Eigen::MatrixXd& Q : norms) {
    norms_.push_back({LateFlow::growth_in(system, F, Q, assumptions.disturbance),
                      form_quotient_above(sum.P_constant(), Q, values)});
  }
  for (std::size_t timer = 0; timer < sum.timers(); ++timer) {
    compute_timer(sum, timer, values, shares, norms);
  }
}

void TimerDependentSumBound::compute_timer(const TimerDependentSum& sum, std::size_t timer,
                                           const NamedMatrices& values,
                                           const std::vector<double>& shares,
                                           const std::vector<Eigen::MatrixXd>& norms) {
  Timer& own = timers_[timer];
  const ErrorSystem& system = sum.system();
  const ErrorReset& reset = system.resets[timer];
  const Eigen::Index n = system.states;
  const Eigen::Index N = system.size;
  own.shortest = sum.shortest(timer);
  own.nu = scalar_value(values, "nu/" + reset.name);
  own.weight_rounding = weight_rounding(TensorGrid({own.times}));
  const MatrixExpression K = reset.K(0);
  const MatrixExpression C = reset.C;
  const MatrixExpression most = sum.P_after(timer);
  own.rho = norm_above(transpose(K) * most * K, values);
  // V⁺ − V without noise, but for P_i before the sample.
  const MatrixExpression change = sum.P(timer, 0) -
                                  He((sum.P_constant() + sum.P(timer, 0)) * K * C) +
                                  MatrixExpression(-1.0) * block_of(sum.jump_parts(timer), 0, N) +
                                  transpose(K * C) * most * (K * C);
  for (std::size_t k = 0; k < sum.nodes(timer).size(); ++k) {
    Node node;
    const MatrixExpression P = sum.P(timer, k);
    const MatrixExpression least = least_at(sum, timer, k, shares);
    node.inverse = inverse_above(least, values, P.node().name).topLeftCorner(n, n);
    node.inverse_norm = largest_eigenvalue_above(node.inverse);
    node.of_state = norm_above(block_of(P, 0, n), values);
    node.of_injection = norm_above(block_of(P, n, N - n), values);
    node.mu = raised(1.0 + form_quotient_above(change - P, least, values));
    for (const Eigen::MatrixXd& Q : norms) {
      node.into.push_back(form_quotient_above(Q, least, values));
      node.out.push_back(form_quotient_above(P, Q, values));
    }
    own.nodes.push_back(std::move(node));
  }
  // The slope in the last cell, where P_i is the last one.
  const std::size_t last = own.nodes.size() - 1;
  const double length = sum.nodes(timer)[last] - sum.nodes(timer)[last - 1];
  own.kappa = raised(form_quotient_above(sum.P(timer, last - 1) - sum.P(timer, last),
                                         least_at(sum, timer, last, shares), values) /
                     length);
}

double TimerDependentSumBound::time_of(std::size_t timer, const double* state) const {
  return state[kTimers + static_cast<Eigen::Index>(timer)] / kTicks;
}

TimerDependentSumBound::Place TimerDependentSumBound::place(std::size_t timer, const double* state,
                                                            double later) const {
  const Timer& own = timers_[timer];
  const double time = std::min(time_of(timer, state) + later, own.longest);
  const auto above = std::upper_bound(own.times.begin() + 1, own.times.end() - 1, time);
  const auto high = static_cast<std::size_t>(above - own.times.begin());
  const double share = (time - own.times[high - 1]) / (own.times[high] - own.times[high - 1]);
  return {&own.nodes[high - 1], &own.nodes[high], 1.0 - share + own.weight_rounding,
          share + own.weight_rounding};
}

template <typename Of>
double TimerDependentSumBound::mean(std::size_t timer, const double* state, double later,
                                    Of of) const {
  const Place at = place(timer, state, later);
  return at.of_low * of(*at.low) + at.of_high * of(*at.high);
}

/// The least of what the timers say, each by itself.
template <typename Of>
double TimerDependentSumBound::least_mean(const double* state, double later, Of of) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t timer = 0; timer < timers_.size(); ++timer) {
    least = std::min(least, mean(timer, state, later, of));
  }
  return least;
}

void TimerDependentSumBound::initialize(double* state) const {
  std::fill(state, state + state_size(), 0.0);
  begin(initial_error_, state);
}

void TimerDependentSumBound::begin(double error, double* state) const {
  double of_state = of_state_;
  double of_injection = of_injection_;
  bool is_at_0 = true;
  for (std::size_t timer = 0; timer < timers_.size(); ++timer) {
    is_at_0 &= time_of(timer, state) == 0.0;
    of_state += mean(timer, state, 0.0, [](const Node& node) { return node.of_state; });
    of_injection += mean(timer, state, 0.0, [](const Node& node) { return node.of_injection; });
  }
  if (is_at_0) {
    of_state = of_state_at_0_;
    of_injection = of_injection_at_0_;
  }
  state[kW] = raised(
      square_root_sum(std::sqrt(of_state) * error, std::sqrt(of_injection) * initial_injection_));
}

void TimerDependentSumBound::begin_at_sample(std::size_t sensor, double error,
                                             double* state) const {
  state[kTimers + static_cast<Eigen::Index>(timer_of_[sensor])] = 0.0;
  begin(error, state);
}

/// V after `duration` [s] from `from` [s] on by the least |e|_Q, whichever timers are late.
double TimerDependentSumBound::flowed_in_norms(double W, double from, double duration,
                                               const double* state) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t q = 0; q < norms_.size(); ++q) {
    const double into = least_mean(state, from, [q](const Node& node) { return node.into[q]; });
    double out = norms_[q].out_constant;
    for (std::size_t timer = 0; timer < timers_.size(); ++timer) {
      out += mean(timer, state, from + duration, [q](const Node& node) { return node.out[q]; });
    }
    const LateFlow::Growth& growth = norms_[q].growth;
    const double root = flowed_linearly(std::sqrt(into * W), growth.rate, growth.push, duration);
    least = std::min(least, raised(out * root * root));
  }
  return least;
}

void TimerDependentSumBound::flow(double duration, double* state) const {
  double& W = state[kW];
  const double start = W;
  double left = duration;
  double passed = 0.0;
  bool is_late = false;
  double late_from = 0.0;
  double W_there = 0.0;
  while (left > 0.0 && W < kLostTrack) {
    double growth = -rate_;
    double piece = left;
    bool is_late_now = false;
    for (std::size_t timer = 0; timer < timers_.size(); ++timer) {
      const double before_late = timers_[timer].longest - (time_of(timer, state) + passed);
      if (before_late <= 0.0) {
        growth += timers_[timer].kappa;
        is_late_now = true;
      } else {
        piece = std::min(piece, before_late);
      }
    }
    if (is_late_now && !is_late) {
      is_late = true;
      late_from = passed;
      W_there = W;
    }
    W = flowed_linearly(W, growth, push_, piece);
    passed = piece == left ? duration : passed + piece;
    left -= piece;
  }
  if (is_late) {
    W = std::min({W, flowed_in_norms(start, 0.0, duration, state),
                  flowed_in_norms(W_there, late_from, duration - late_from, state)});
  }
  const double ticks = std::round(duration * kTicks);
  for (std::size_t timer = 0; timer < timers_.size(); ++timer) {
    state[kTimers + static_cast<Eigen::Index>(timer)] += ticks;
  }
}

void TimerDependentSumBound::sample(std::size_t sensor, double* state, double*) const {
  if (state[kW] == kLostTrack) return;
  const std::size_t timer = timer_of_[sensor];
  const Timer& own = timers_[timer];
  const Place at = place(timer, state, 0.0);
  const double mu = std::max(at.low->mu, at.high->mu);
  double after = square_root_sum(std::sqrt(mu * state[kW]), std::sqrt(own.rho) * noise_);
  if (time_of(timer, state) >= own.shortest)
    after = std::min(after, state[kW] + own.nu * noise_ * noise_);
  state[kW] = raised(after);
  state[kTimers + static_cast<Eigen::Index>(timer)] = 0.0;
}

void TimerDependentSumBound::jump(const JumpMotion&, double* state) const {
  state[kW] = kLostTrack;
}

double TimerDependentSumBound::bound(const double* state) const {
  if (state[kW] == kLostTrack) return kLostTrack;
  const double norm = least_mean(state, 0.0, [](const Node& node) { return node.inverse_norm; });
  double trace = 0.0;
  for (Eigen::Index j = 0; j < timers_.front().nodes.front().inverse.rows(); ++j) {
    trace += least_mean(state, 0.0, [j](const Node& node) { return node.inverse(j, j); });
  }
  return std::sqrt(raised(state[kW] * std::min(norm, trace)));
}

void TimerDependentSumBound::state_bounds(const double* state, double*,
                                          Eigen::Ref<Eigen::VectorXd> bounds) const {
  if (state[kW] == kLostTrack) {
    bounds.setConstant(kLostTrack);
    return;
  }
  for (Eigen::Index j = 0; j < bounds.size(); ++j) {
    const double entry =
        least_mean(state, 0.0, [j](const Node& node) { return node.inverse(j, j); });
    bounds(j) = std::sqrt(raised(state[kW] * entry));
  }
}

/// That of the timer by which it has the least trace.
void TimerDependentSumBound::ellipsoid(const double* state, double*,
                                       Eigen::Ref<Eigen::MatrixXd> Q) const {
  if (state[kW] == kLostTrack) {
    Q.setConstant(kLostTrack);
    return;
  }
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t timer = 0; timer < timers_.size(); ++timer) {
    const double trace =
        mean(timer, state, 0.0, [](const Node& node) { return node.inverse.trace(); });
    if (trace < least) {
      best = timer;
      least = trace;
    }
  }
  const Place at = place(best, state, 0.0);
  Q = at.of_low * at.low->inverse + at.of_high * at.high->inverse;
  // With room for the rounding of the sum.
  Q.diagonal() += Q.diagonal() * 1e-9;
  Q *= state[kW];
}

}  // namespace sampled_data_observers

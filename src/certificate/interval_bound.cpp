#include "certificate/interval_bound.h"

#include <algorithm>
#include <limits>

namespace sampled_data_observers {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void IntervalBound::begin(double error, double* state) const {
  state[kTau] = 0.0;
  state[kHasEvent] = 0.0;
  begin_numbers(error, numbers(state));
}

void IntervalBound::narrow(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const {
  if (!is_lost(state)) narrow_numbers(Q, numbers(state));
}

void IntervalBound::narrow_numbers(const Eigen::Ref<const Eigen::MatrixXd>& Q,
                                   double* numbers) const {
  static_cast<void>(Q);
  static_cast<void>(numbers);
}

void IntervalBound::flow(double duration, double* state) const {
  if (is_lost(state) || duration == 0.0) return;
  flow_numbers(duration, interval(state), numbers(state));
  state[kTau] += duration;
}

double IntervalBound::bound(const double* state) const {
  return is_lost(state) ? kInfinity : error(interval(state), numbers(state));
}

void IntervalBound::state_bounds(const double* state, double* workspace,
                                 Eigen::Ref<Eigen::VectorXd> bounds) const {
  if (is_lost(state)) {
    bounds.setConstant(kInfinity);
  } else {
    errors(interval(state), numbers(state), workspace, bounds);
  }
}

void IntervalBound::ellipsoid(const double* state, double* workspace,
                              Eigen::Ref<Eigen::MatrixXd> Q) const {
  if (is_lost(state)) {
    ErrorBound::ellipsoid(state, workspace, Q);
  } else {
    error_ellipsoid(interval(state), numbers(state), workspace, Q);
  }
}

void IntervalBound::errors(const Interval& at, const double* numbers, double* workspace,
                           Eigen::Ref<Eigen::VectorXd> bounds) const {
  static_cast<void>(workspace);
  bounds.setConstant(error(at, numbers));
}

void IntervalBound::error_ellipsoid(const Interval& at, const double* numbers, double* workspace,
                                    Eigen::Ref<Eigen::MatrixXd> Q) const {
  static_cast<void>(workspace);
  set_to_ball(error(at, numbers), Q);
}

void IntervalBound::flow_numbers(double duration, const Interval& from, double* numbers) const {
  static_cast<void>(duration);
  static_cast<void>(from);
  static_cast<void>(numbers);
}

double IntervalBound::foreseen_part(double duration, double tau) const {
  return std::min(duration, std::max(0.0, T2_ - tau));
}

IntervalBound::Interval IntervalBound::interval(const double* state) {
  return {state[kTau], state[kHasEvent] == 0.0};
}

void IntervalBound::begin_interval(double* state) {
  state[kTau] = 0.0;
  state[kHasEvent] = 1.0;
}

bool IntervalBound::is_lost(const double* state) { return numbers(state)[0] == kInfinity; }

void IntervalBound::lose(double* state) { numbers(state)[0] = kInfinity; }

void SampledErrorBound::sample(std::size_t sensor, double* state, double* workspace) const {
  static_cast<void>(sensor);  // there is one
  if (is_lost(state)) return;
  sample_numbers(interval(state), numbers(state), workspace);
  begin_interval(state);
}

void SampledErrorBound::jump(const JumpMotion& motion, double* state) const {
  static_cast<void>(motion);
  lose(state);
}

}  // namespace sampled_data_observers

#include "certificate/exponential_norm.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kMinSteps = 64.0;
constexpr double kMaxSteps = 1024.0;
/// ‖A‖ times a step, where the number of steps allows it: the excess is about 3e-4 of the norm
/// then.
constexpr double kFineStep = 0.05;
/// Of rounding.
constexpr double kFlowRounding = 1e-9;
/// Times ‖A‖ T and n: of the digits that the matrix exponential of a stiff A loses.
constexpr double kStiffRounding = 1e-15;

double or_infinite(double value) {
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

}  // namespace

ExponentialNorm::ExponentialNorm(const Eigen::MatrixXd& Y, const Eigen::MatrixXd& A,
                                 const Eigen::MatrixXd& X, double T, const FlowGrowth& growth)
    : T_(T), rate_(growth.rate) {
  // In the coordinates W x, in which no unit is far larger than another.
  const Eigen::MatrixXd flow = growth.W * A * growth.inverse_W;
  const Eigen::MatrixXd squared = flow * flow;
  const Eigen::MatrixXd from_weighed = Y * growth.inverse_W;
  const Eigen::MatrixXd start = growth.W * X;
  const double norm_Y = norm2(from_weighed);
  const double norm_Y_squared = (from_weighed * squared).norm();
  const double norm_flow = norm2(flow);
  const double stiff = kStiffRounding * static_cast<double>(A.rows());
  const double rounding = kFlowRounding + stiff * norm_flow * T;
  const double steps = std::clamp(std::ceil(norm_flow * T / kFineStep), kMinSteps, kMaxSteps);
  step_ = T / steps;
  const auto count = static_cast<std::size_t>(steps);
  const double grown = std::exp(std::max(0.0, rate_) * step_);
  for (std::size_t i = 0; i <= count; ++i) {
    const Eigen::MatrixXd flown = exponential_of(flow * (step_ * static_cast<double>(i))) * start;
    const double size = norm2(flown) * (1.0 + rounding);
    const double at_start = or_infinite(norm_Y * size);
    start_.push_back(at_start);
    norms_.push_back(or_infinite(norm2(from_weighed * flown) + rounding * at_start));
    const double second_derivative =
        grown * (std::min(norm_Y * (squared * flown).norm(), norm_Y_squared * size) +
                 stiff * norm_flow * norm_flow * at_start);
    if (i < count) excess_.push_back(or_infinite(step_ * step_ / 8.0 * second_derivative));
  }
}

double ExponentialNorm::at(double tau) const {
  if (tau == T_) return norms_.back();
  if (!(tau < T_)) return or_infinite(start_.back() * std::exp(rate_ * (tau - T_)));
  const double position = std::max(0.0, tau / step_);
  const std::size_t i = std::min(static_cast<std::size_t>(position), excess_.size() - 1);
  const double fraction = std::min(1.0, position - static_cast<double>(i));
  const double between = (1.0 - fraction) * norms_[i] + fraction * norms_[i + 1] + excess_[i];
  return or_infinite(std::min(between, start_[i] * std::exp(rate_ * fraction * step_)));
}

}  // namespace sampled_data_observers

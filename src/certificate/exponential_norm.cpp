#include "sampled_data_observers/certificate/exponential_norm.h"

#include <algorithm>
#include <cmath>

#include "sampled_data_observers/certificate/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kMinSteps = 64.0;
constexpr double kMaxSteps = 4096.0;
/// ‖A‖ times a step, where the number of steps allows it: the excess is about 1e-4 of the norm
/// then.
constexpr double kFineStep = 0.03;

}  // namespace

ExponentialNorm::ExponentialNorm(const Eigen::MatrixXd& Y, const Eigen::MatrixXd& A,
                                 const Eigen::MatrixXd& X, double T) {
  const double steps = std::clamp(std::ceil(norm2(A) * T / kFineStep), kMinSteps, kMaxSteps);
  step_ = T / steps;
  const auto count = static_cast<std::size_t>(steps);
  // ‖e^{As}‖ <= e^{μs} with the logarithmic norm μ of A.
  const double growth = std::exp(std::max(0.0, max_eigenvalue((A + A.transpose()) / 2.0)) * step_);
  const Eigen::MatrixXd A2 = A * A;
  const double norm_Y = norm2(Y);
  const double norm_Y_A2 = norm2(Y * A2);
  for (std::size_t i = 0; i <= count; ++i) {
    const Eigen::MatrixXd flown = exponential_of(A * (step_ * static_cast<double>(i))) * X;
    norms_.push_back(norm2(Y * flown));
    const double second_derivative =
        growth * std::min(norm_Y * norm2(A2 * flown), norm_Y_A2 * norm2(flown));
    if (i < count) excess_.push_back(step_ * step_ / 8.0 * second_derivative);
  }
}

double ExponentialNorm::at(double tau) const {
  const double position = std::clamp(tau / step_, 0.0, static_cast<double>(excess_.size()));
  const std::size_t i = std::min(static_cast<std::size_t>(position), excess_.size() - 1);
  const double fraction = position - static_cast<double>(i);
  return (1.0 - fraction) * norms_[i] + fraction * norms_[i + 1] + excess_[i];
}

}  // namespace sampled_data_observers

#include "design/mode_coordinates.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "plant/differentiation.h"

namespace sampled_data_observers {
namespace {

constexpr std::array<int, 16> kPrimes = {2,  3,  5,  7,  11, 13, 17, 19,
                                         23, 29, 31, 37, 41, 43, 47, 53};

/// The digits of a whole number in a base, mirrored at the point: in (0, 1).
double radical_inverse(std::size_t number, int base) {
  double result = 0.0;
  double digit = 1.0 / base;
  for (; number > 0; number /= static_cast<std::size_t>(base)) {
    result += digit * static_cast<double>(number % static_cast<std::size_t>(base));
    digit /= base;
  }
  return result;
}

}  // namespace

ModeCoordinates::ModeCoordinates(const TransformedHighGainObserver& law, std::size_t mode)
    : law_(law),
      mode_(mode),
      maps_(law.maps().at(mode)),
      u_(Eigen::VectorXd::Zero(law.plant().inputs())) {}

Eigen::VectorXd ModeCoordinates::T(const Eigen::VectorXd& x) const {
  Eigen::VectorXd z(d());
  maps_.T->evaluate(x.data(), u_.data(), z.data());
  return z;
}

Eigen::VectorXd ModeCoordinates::state_of(const Eigen::VectorXd& z) const {
  Eigen::VectorXd x(n());
  maps_.Theta->evaluate(z.data(), u_.data(), x.data());
  law_.saturation().apply(x.data());
  return x;
}

double ModeCoordinates::phi(const Eigen::VectorXd& x) const {
  Eigen::VectorXd argument(d() + n());
  argument << T(x), x;
  double value = 0.0;
  maps_.Phi->evaluate(argument.data(), u_.data(), &value);
  return value;
}

Eigen::VectorXd ModeCoordinates::jumped(const Eigen::VectorXd& z) const {
  const Eigen::VectorXd before = state_of(z);
  Eigen::VectorXd x(n());
  law_.plant().modes()[mode_].jump->evaluate(before.data(), u_.data(), x.data());
  law_.saturation().apply(x.data());
  return T(x);
}

Eigen::MatrixXd ModeCoordinates::jump_gradient(const Eigen::VectorXd& z,
                                               const Eigen::VectorXd& scales) const {
  Eigen::MatrixXd result(d(), z.size());
  Eigen::VectorXd point = z;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double step = std::ldexp(std::max(std::abs(z(i)), scales(i)), -17);
    point(i) = z(i) + step;
    const Eigen::VectorXd above = jumped(point);
    point(i) = z(i) - step;
    result.col(i) = (above - jumped(point)) / (2.0 * step);
    point(i) = z(i);
  }
  return result;
}

Eigen::VectorXd ModeCoordinates::gradient(const Eigen::VectorXd& z,
                                          const Eigen::VectorXd& scales) const {
  Eigen::VectorXd result(z.size());
  Eigen::VectorXd point = z;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double step = std::ldexp(std::max(std::abs(z(i)), scales(i)), -17);
    point(i) = z(i) + step;
    const double above = phi_of(point);
    point(i) = z(i) - step;
    result(i) = (above - phi_of(point)) / (2.0 * step);
    point(i) = z(i);
  }
  return result;
}

Eigen::VectorXd ModeCoordinates::derivative_errors(const Eigen::VectorXd& x) const {
  const PlantMode& plant = law_.plant().modes()[mode_];
  Eigen::VectorXd f(n());
  plant.flow->evaluate(x.data(), u_.data(), f.data());
  Eigen::MatrixXd J(d(), n());
  Eigen::VectorXd workspace(n() + 2 * d());
  differentiate(*maps_.T, x.data(), u_.data(), law_.saturation().scales(), J.data(),
                workspace.data());
  double h = 0.0;
  plant.outputs.front()->evaluate(x.data(), u_.data(), &h);
  Eigen::VectorXd errors(d() + 1);
  errors << T(x), phi(x);
  errors(0) -= h;
  errors.tail(d()) -= J * f;
  return errors;
}

std::vector<Eigen::VectorXd> points_of_box(const HighGainObserver& law, std::size_t count) {
  const auto n = static_cast<std::size_t>(law.plant().states());
  if (n > kPrimes.size()) {
    throw std::invalid_argument("more than " + std::to_string(kPrimes.size()) + " states");
  }
  std::vector<Eigen::RowVector2d> bounds;
  for (std::size_t i = 0; i < n; ++i) {
    const auto of_state = law.saturation().bounds(static_cast<Eigen::Index>(i));
    if (!of_state) {
      throw std::invalid_argument(
          "gains/saturations: expected bounds of every state, found none of " +
          law.plant().state_names()[i]);
    }
    bounds.push_back(*of_state);
  }
  std::size_t corners = std::size_t{1} << n;
  if (corners > count / 10) corners = 0;
  std::vector<Eigen::VectorXd> points;
  for (std::size_t k = 0; k < count; ++k) {
    Eigen::VectorXd& x = points.emplace_back(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double share = k < corners ? static_cast<double>((k >> i) & 1U)
                                       : radical_inverse(k - corners + 1, kPrimes[i]);
      x(static_cast<Eigen::Index>(i)) = bounds[i](0) + share * (bounds[i](1) - bounds[i](0));
    }
  }
  return points;
}

}  // namespace sampled_data_observers

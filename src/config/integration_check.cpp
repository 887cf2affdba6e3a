#include "config/integration_check.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "config/number_text.h"
#include "linear_algebra/matrix_functions.h"
#include "plant/lipschitz_map.h"
#include "plant/polytopic_map.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Relative step of central differences.
constexpr double kDifference = 1e-6;
/// Of the stability region of the Runge–Kutta method, on every ray into the left half plane.
constexpr double kStableEverywhere = 2.5;

double difference_step(double value) { return kDifference * std::max(1.0, std::abs(value)); }

/// The Jacobian of the flow at a state of the law, in its flowing part.
Matrix flow_jacobian(const PlantObserver& law, Vector state) {
  const Eigen::Index size = law.flow_size();
  Vector workspace(law.workspace_size());
  Vector above(size);
  Vector below(size);
  Matrix jacobian(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    const double value = state(j);
    const double step = difference_step(value);
    state(j) = value + step;
    law.flow_derivative(state.data(), above.data(), workspace.data());
    state(j) = value - step;
    law.flow_derivative(state.data(), below.data(), workspace.data());
    state(j) = value;
    jacobian.col(j) = (above - below) / (2.0 * step);
  }
  return jacobian;
}

/// The initial state, and the same with continuous outputs known as they would be there.
std::vector<Vector> starts(const PlantObserver& law, const Plant& plant) {
  Vector state(law.state_size());
  law.initialize(state.data());
  std::vector<Vector> all = {state};
  Vector workspace(law.workspace_size());
  const Vector u = Vector::Zero(plant.inputs());
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (sensor.timing != SensorTiming::kContinuous) continue;
    Vector y(sensor.outputs());
    plant.modes().front().outputs[i]->evaluate(state.data(), u.data(), y.data());
    const Event event{1, EventKind::kOutput, static_cast<int>(i), y.data(), y.size(), 0};
    law.reset(event, state.data(), workspace.data());
  }
  if (plant.outputs(SensorTiming::kContinuous) > 0) all.push_back(state);
  return all;
}

/// d with D⁻¹ |a| D, D = diag(d), of rows and columns of like size: Osborne's iteration. What acts
/// one way only, such as a position on what follows it, may become small but not vanish.
Vector balancing_scales(const Matrix& a) {
  Vector d = Vector::Ones(a.rows());
  const double least =
      std::max(1e-2 * a.diagonal().cwiseAbs().maxCoeff(), 1e-9 * a.cwiseAbs().maxCoeff());
  if (least == 0.0) return d;
  for (int sweep = 0; sweep < 50; ++sweep) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      double row = least;
      double column = least;
      for (Eigen::Index j = 0; j < a.rows(); ++j) {
        if (j == i) continue;
        row += std::abs(a(i, j)) * d(j) / d(i);
        column += std::abs(a(j, i)) * d(i) / d(j);
      }
      d(i) *= std::sqrt(row / column);
    }
  }
  return d;
}

Matrix scaled(const Matrix& a, const Vector& d) {
  return d.cwiseInverse().asDiagonal() * a * d.asDiagonal();
}

/// The largest rate of a Lipschitz plant's flow under the law, at any state.
double lipschitz_rate(const Matrix& jacobian, const Vector& x, const LipschitzDescription& map) {
  const Eigen::Index n = map.A.rows();
  const Vector argument = map.S * x;
  Matrix slope(map.psi->size(), argument.size());
  Vector above(map.psi->size());
  Vector below(map.psi->size());
  for (Eigen::Index j = 0; j < argument.size(); ++j) {
    Vector at = argument;
    const double step = difference_step(argument(j));
    at(j) = argument(j) + step;
    map.psi->evaluate(at.data(), nullptr, above.data());
    at(j) = argument(j) - step;
    map.psi->evaluate(at.data(), nullptr, below.data());
    slope.col(j) = (above - below) / (2.0 * step);
  }
  Matrix linear = jacobian;
  linear.topLeftCorner(n, n) -= map.G * slope * map.S;
  const double constant = *map.lipschitz_constant;
  Matrix pattern = linear.cwiseAbs();
  pattern.topLeftCorner(n, n) += constant * (map.G.cwiseAbs() * map.S.cwiseAbs());
  const Vector d = balancing_scales(pattern);
  const Matrix G = d.head(n).cwiseInverse().asDiagonal() * map.G;
  const Matrix S = map.S * d.head(n).asDiagonal();
  return norm2(scaled(linear, d)) + constant * norm2(G) * norm2(S);
}

/// The largest modulus of an eigenvalue that decays, and that steps of `step` seconds let grow; 0:
/// there is none.
double unstable_rate(const Matrix& jacobian, double step) {
  double largest = 0.0;
  const Eigen::VectorXcd eigenvalues = eigenvalues_of(jacobian);
  for (Eigen::Index i = 0; i < eigenvalues.size(); ++i) {
    const std::complex<double> z = step * eigenvalues(i);
    const std::complex<double> factor =
        1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)));
    const bool decays = z.real() <= 1e-6 * std::abs(z);
    if (decays && std::abs(factor) > 1.0 + 1e-6 && std::abs(z) > 1.0) {
      largest = std::max(largest, std::abs(eigenvalues(i)));
    }
  }
  return largest;
}

/// Two digits, rounded down: a step that a person would write.
double rounded_down(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / unit) * unit;
}

/// The largest that the stated vertices of the plant's Jacobian allow anywhere.
double polytopic_rate(Matrix jacobian, const PolytopicDescription& flow) {
  double rate = 0.0;
  for (const Matrix& vertex : flow.vertices) {
    jacobian.topLeftCorner(vertex.rows(), vertex.cols()) = vertex;
    rate = std::max(rate, norm2(scaled(jacobian, balancing_scales(jacobian))));
  }
  if (flow.G.cols() == 0) return rate;
  return rate + flow.lipschitz_constant * norm2(flow.G) * norm2(flow.S);
}

}  // namespace

std::optional<ConfigError> objection_to_step(ConfigSection& root, const Plant& plant,
                                             const ObserverLaw& law, bool is_certified) {
  const auto* observer = dynamic_cast<const PlantObserver*>(&law);
  if (observer == nullptr || observer->flow_step() == 0) return std::nullopt;
  const double step = to_seconds(observer->flow_step());
  const auto* map = dynamic_cast<const LipschitzMap*>(plant.modes().front().flow.get());
  const bool is_bounded = map != nullptr && map->description().lipschitz_constant.has_value();
  const auto* polytopic = dynamic_cast<const PolytopicMap*>(plant.modes().front().flow.get());
  double rate = 0.0;
  for (const Vector& state : starts(*observer, plant)) {
    const Matrix jacobian = flow_jacobian(*observer, state);
    if (!jacobian.allFinite()) continue;
    if (!is_certified) {
      rate = std::max(rate, unstable_rate(jacobian, step));
    } else if (is_bounded) {
      rate =
          std::max(rate, lipschitz_rate(jacobian, state.head(plant.states()), map->description()));
    } else {
      rate = std::max(rate, norm2(scaled(jacobian, balancing_scales(jacobian))));
      if (polytopic != nullptr) {
        rate = std::max(rate, polytopic_rate(jacobian, polytopic->description()));
      }
    }
  }
  const double longest = (is_certified ? kLongestCertifiedStep : kStableEverywhere) / rate;
  if (!(step > longest)) return std::nullopt;
  const std::string why =
      is_certified
          ? ": the certificate is about the flow itself, and Runge-Kutta steps follow it "
            "where the step times its largest rate, " +
                number_text(rate, 3) + " 1/s, is at most " + number_text(kLongestCertifiedStep, 3) +
                "; or set allow_uncertified: true to run without guarantee"
          : ": Runge-Kutta steps let a mode of the rate " + number_text(rate, 3) +
                " 1/s grow, which decays";
  return root.section("plant").error(
      "integration/step", "at most " + number_text(rounded_down(longest), 2) + " s" + why,
      number_text(step, 6) + " s");
}

}  // namespace sampled_data_observers

#include "replay/comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

double difference(const Quantity& quantity, double a, double b) {
  return quantity.angular ? wrap_angle(a - b) : a - b;
}

double norm_of(const std::vector<Quantity>& quantities, Eigen::Index states) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(quantities.size()), states);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = quantities[i].row;
  }
  return norm2(rows);
}

std::optional<double> root_mean(double squares, std::size_t size) {
  if (size == 0) return std::nullopt;
  return std::sqrt(squares / static_cast<double>(size));
}

/// Which state an output of a map is, where it is one as it is: a formula may be no more than its
/// name. Told by points without relation to each other, of either sign.
std::optional<Eigen::VectorXd> copied_state(const Plant& plant, const VectorMap& map,
                                            Eigen::Index outputs, Eigen::Index output) {
  Eigen::VectorXd row = Eigen::VectorXd::Ones(plant.states());
  for (const double sign : {1.0, -1.0, 0.1}) {
    Eigen::VectorXd x(plant.states());
    Eigen::VectorXd u(plant.inputs());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x(i) = sign * std::sqrt(2.0 + static_cast<double>(i));
    for (Eigen::Index i = 0; i < u.size(); ++i)
      u(i) = sign * std::cbrt(2.0 + static_cast<double>(i));
    Eigen::VectorXd y(outputs);
    map.evaluate(x.data(), u.data(), y.data());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (y(output) != x(i)) row(i) = 0.0;
    }
  }
  if (row.sum() != 1.0) return std::nullopt;
  return row;
}

/// What a sensor measures in every mode, row · x + constant, without a name.
std::optional<Quantity> measured(const Plant& plant, std::size_t sensor, Eigen::Index output) {
  std::optional<Quantity> quantity;
  for (const PlantMode& mode : plant.modes()) {
    const AffineMap* map = mode.outputs[sensor]->affine();
    std::optional<Eigen::VectorXd> row;
    double constant = 0.0;
    if (map == nullptr) {
      row = copied_state(plant, *mode.outputs[sensor], plant.sensors()[sensor].outputs(), output);
    } else if (map->N().isZero(0.0)) {
      row = map->M().row(output).transpose();
      constant = map->c()(output);
    }
    if (!row || (quantity && (quantity->row != *row || quantity->constant != constant))) {
      return std::nullopt;
    }
    const bool angular = plant.sensors()[sensor].angular[static_cast<std::size_t>(output)];
    quantity = Quantity{"", *row, angular, constant};
  }
  return quantity;
}

}  // namespace

bool measures(const Plant& plant, std::size_t sensor, Eigen::Index output,
              const Quantity& quantity) {
  const std::optional<Quantity> found = measured(plant, sensor, output);
  return found && found->row == quantity.row && found->constant == quantity.constant;
}

std::optional<Quantity> state_quantity(const Plant& plant, const std::string& name) {
  const std::vector<std::string>& names = plant.state_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  Quantity quantity{name, Eigen::VectorXd::Zero(plant.states())};
  quantity.row(found - names.begin()) = 1.0;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    for (Eigen::Index output = 0; output < sensor.outputs(); ++output) {
      if (measures(plant, i, output, quantity)) {
        quantity.angular = quantity.angular || sensor.angular[static_cast<std::size_t>(output)];
      }
    }
  }
  return quantity;
}

std::optional<Quantity> output_quantity(const Plant& plant, std::size_t sensor,
                                        Eigen::Index output) {
  std::optional<Quantity> found = measured(plant, sensor, output);
  if (!found) return std::nullopt;
  for (const std::string& state : plant.state_names()) {
    std::optional<Quantity> quantity = state_quantity(plant, state);
    if (measures(plant, sensor, output, *quantity)) return quantity;
  }
  found->name = plant.sensors()[sensor].name + "[" + std::to_string(output) + "]";
  return found;
}

double Quantity::value(const double* x) const {
  return row.dot(Eigen::Map<const Eigen::VectorXd>(x, row.size())) + constant;
}

double error_of(const Quantity& quantity, const double* x, double truth) {
  return difference(quantity, quantity.value(x), truth);
}

double bound_on(const Quantity& quantity, const Eigen::VectorXd& state_bounds) {
  double bound = 0.0;
  for (Eigen::Index i = 0; i < quantity.row.size(); ++i) {
    if (quantity.row(i) != 0.0) bound += std::abs(quantity.row(i)) * state_bounds(i);
  }
  return bound;
}

Comparison::Comparison(std::vector<Quantity> quantities, std::shared_ptr<const Plant> plant)
    : quantities_(std::move(quantities)),
      plant_(std::move(plant)),
      held_(quantities_.size()),
      squares_(quantities_.size(), 0.0),
      hold_squares_(quantities_.size(), 0.0),
      weight_(norm_of(quantities_, plant_->states())),
      bound_checks_(quantities_.size()) {
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    for (std::size_t sensor = 0; sensor < plant_->sensors().size(); ++sensor) {
      if (plant_->sensors()[sensor].timing == SensorTiming::kAtJumps) continue;
      for (Eigen::Index output = 0; output < plant_->sensors()[sensor].outputs(); ++output) {
        if (measures(*plant_, sensor, output, quantities_[i])) held_[i].is_measured = true;
      }
    }
  }
}

void Comparison::add_sample(std::size_t sensor, Stamp stamp, const double* values) {
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    Held& held = held_[i];
    for (Eigen::Index output = 0; output < plant_->sensors()[sensor].outputs(); ++output) {
      if (!measures(*plant_, sensor, output, quantities_[i])) continue;
      if (held.value && stamp < held.stamp) continue;
      held.value = values[output];
      held.stamp = stamp;
    }
  }
}

void Comparison::check(double error, double allowed, BoundCheck& check) {
  ++check.stamps;
  if (error > allowed) ++check.exceeded;
  if (allowed > 0.0) check.share = std::max(check.share.value_or(0.0), error / allowed);
}

Comparison::Errors Comparison::errors(const std::vector<double>& truth, const double* x,
                                      const Bounds& bounds) const {
  Errors errors;
  double squares = 0.0;
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    const Quantity& quantity = quantities_[i];
    errors.values.push_back(error_of(quantity, x, truth[i]));
    squares += std::pow(errors.values[i], 2);
    errors.bounds.push_back(bounds.states.size() == 0 ? std::numeric_limits<double>::infinity()
                                                      : bound_on(quantity, bounds.states));
    errors.of_hold.push_back(held_[i].value ? difference(quantity, *held_[i].value, truth[i])
                                            : std::numeric_limits<double>::quiet_NaN());
  }
  errors.norm = std::sqrt(squares);
  errors.norm_bound = weight_ * bounds.norm;
  return errors;
}

bool Comparison::add_truth(const std::vector<double>& truth, const double* x,
                           const Bounds& bounds) {
  for (const Held& held : held_) {
    if (held.is_measured && !held.value) return false;
  }
  const Errors errors = this->errors(truth, x, bounds);
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    if (std::isfinite(errors.bounds[i])) {
      check(std::abs(errors.values[i]), errors.bounds[i], bound_checks_[i]);
    }
    squares_[i] += std::pow(errors.values[i], 2);
    if (held_[i].is_measured) hold_squares_[i] += std::pow(errors.of_hold[i], 2);
  }
  ++size_;
  if (std::isfinite(bounds.norm)) check(errors.norm, errors.norm_bound, bound_check_);
  return true;
}

std::vector<std::optional<double>> Comparison::rmse() const {
  std::vector<std::optional<double>> result;
  for (const double squares : squares_) result.push_back(root_mean(squares, size_));
  return result;
}

std::vector<std::optional<double>> Comparison::hold_rmse() const {
  std::vector<std::optional<double>> result;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    result.push_back(held_[i].is_measured ? root_mean(hold_squares_[i], size_) : std::nullopt);
  }
  return result;
}

std::optional<double> Comparison::norm(const std::vector<std::optional<double>>& values) {
  double squares = 0.0;
  for (const std::optional<double>& value : values) {
    if (!value) return std::nullopt;
    squares += *value * *value;
  }
  return values.empty() ? std::nullopt : std::optional<double>(std::sqrt(squares));
}

}  // namespace sampled_data_observers

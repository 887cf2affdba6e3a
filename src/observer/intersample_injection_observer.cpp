#include "observer/intersample_injection_observer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"
#include "sampled_data_observers/observer/gain_check.h"

namespace sampled_data_observers {
namespace {

Eigen::Index all_outputs(const Plant& plant) { return plant.outputs(SensorTiming::kSampled); }

}  // namespace

Eigen::MatrixXd predictor_H(const Plant& plant, std::size_t sensor, const Eigen::MatrixXd& L) {
  return -plant.modes().front().outputs[sensor]->affine()->M() * L;
}

IntersampleInjectionObserver::IntersampleInjectionObserver(const ObserverContext& context,
                                                           std::vector<IntersampleGains> gains)
    : PlantObserver(context, {all_outputs(*context.plant), 0, 0, 0}, {SensorTiming::kSampled}),
      gains_(std::move(gains)) {
  std::vector<Eigen::MatrixXd> L;
  for (const IntersampleGains& gain : gains_) L.push_back(gain.L);
  check_gains("L", L, plant(), SensorTiming::kSampled);
  Eigen::Index begin = n();
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    const Sensor& sensor = plant().sensors()[i];
    if (gains_[i].H.rows() != sensor.outputs() || gains_[i].H.cols() != sensor.outputs()) {
      throw std::invalid_argument("H of sensor '" + sensor.name +
                                  "': one row and one column per output");
    }
    if (gains_[i].initial_theta.size() != sensor.outputs()) {
      throw std::invalid_argument("theta0 of sensor '" + sensor.name + "': one entry per output");
    }
    theta_.push_back(begin);
    begin += sensor.outputs();
  }
  build_flow();
}

LawGains IntersampleInjectionObserver::gains() const {
  LawGains all;
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    const std::string of_sensor = "/" + plant().sensors()[i].name;
    all.add("L" + of_sensor, gains_[i].L).add("H" + of_sensor, gains_[i].H);
    all.initial_injection = std::hypot(all.initial_injection, gains_[i].initial_theta.norm());
  }
  return all;
}

void IntersampleInjectionObserver::initialize(double* state) const {
  PlantObserver::initialize(state);
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    const Eigen::VectorXd& theta = gains_[i].initial_theta;
    std::copy_n(theta.data(), theta.size(), state + theta_[i]);
  }
}

void IntersampleInjectionObserver::derivative(const Held& held, const double* s, double* ds,
                                              double* workspace) const {
  PlantObserver::derivative(held, s, ds, workspace);
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    add_product(gains_[i].L, s + theta_[i], ds);
    add_product(gains_[i].H, s + theta_[i], ds + theta_[i]);
  }
}

void IntersampleInjectionObserver::sample(std::size_t sensor, const double* y, const Held& held,
                                          double* state, double* workspace) const {
  static_cast<void>(workspace);
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, state + theta_[sensor]);
}

}  // namespace sampled_data_observers

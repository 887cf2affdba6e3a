#include "observer/intersample_injection_observer.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"
#include "sampled_data_observers/observer/gain_check.h"

namespace sampled_data_observers {

Eigen::MatrixXd predictor_H(const Plant& plant, std::size_t sensor, const Eigen::MatrixXd& L) {
  return -plant.modes().front().outputs[sensor]->affine()->M() * L;
}

IntersampleInjectionObserver::IntersampleInjectionObserver(const ObserverContext& context,
                                                           std::vector<IntersampleGains> gains)
    : PlantObserver(context, {SensorTiming::kSampled},
                    context.plant->outputs(SensorTiming::kSampled)),
      gains_(std::move(gains)) {
  std::vector<Eigen::MatrixXd> L;
  for (const IntersampleGains& gain : gains_) L.push_back(gain.L);
  check_gains("L", L, plant(), SensorTiming::kSampled);
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    const Sensor& sensor = plant().sensors()[i];
    if (gains_[i].H.rows() != sensor.outputs() || gains_[i].H.cols() != sensor.outputs()) {
      throw std::invalid_argument("H of sensor '" + sensor.name +
                                  "': one row and one column per output");
    }
    if (gains_[i].initial_theta.size() != sensor.outputs()) {
      throw std::invalid_argument("theta0 of sensor '" + sensor.name + "': one entry per output");
    }
    theta_.push_back(flowing(sensor.outputs()));
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
    theta_[i].set(gains_[i].initial_theta.data(), state);
  }
}

void IntersampleInjectionObserver::derivative(const Held& held, const double* s, double* ds,
                                              double* workspace) const {
  PlantObserver::derivative(held, s, ds, workspace);
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    const double* theta = theta_[i].of(s);
    add_product(gains_[i].L, theta, ds);
    add_product(gains_[i].H, theta, theta_[i].of(ds));
  }
}

void IntersampleInjectionObserver::sample(std::size_t sensor, const double* y, const Held& held,
                                          double* state, double*) const {
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, theta_[sensor].of(state));
}

}  // namespace sampled_data_observers

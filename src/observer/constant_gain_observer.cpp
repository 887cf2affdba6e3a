#include "sampled_data_observers/observer/constant_gain_observer.h"

#include <stdexcept>
#include <utility>

#include "sampled_data_observers/plant/ordered_product.h"

namespace sampled_data_observers {

ConstantGainObserver::ConstantGainObserver(std::shared_ptr<const LinearPlant> plant,
                                           std::vector<Eigen::MatrixXd> L,
                                           Eigen::VectorXd initial_estimate,
                                           Eigen::VectorXd initial_input)
    : LinearPlantObserver(std::move(plant), std::move(initial_estimate), std::move(initial_input)),
      L_(std::move(L)) {
  const std::vector<Sensor>& sensors = this->plant().sensors();
  if (L_.size() != sensors.size()) throw std::invalid_argument("L: one gain per sensor");
  for (std::size_t i = 0; i < L_.size(); ++i) {
    if (L_[i].rows() != this->plant().states() || L_[i].cols() != sensors[i].C.rows()) {
      throw std::invalid_argument("L of sensor '" + sensors[i].name +
                                  "': one row per state, one column per output");
    }
  }
}

void ConstantGainObserver::sample(std::size_t sensor, const double* y, double* state,
                                  double* workspace) const {
  double* innovation = workspace;
  compute_innovation(plant().sensors()[sensor], y, state, innovation);
  add_product(L_[sensor], innovation, state);
}

}  // namespace sampled_data_observers

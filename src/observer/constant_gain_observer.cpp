#include "observer/constant_gain_observer.h"

#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"
#include "sampled_data_observers/observer/gain_check.h"

namespace sampled_data_observers {

ConstantGainObserver::ConstantGainObserver(ObserverContext context, std::vector<Eigen::MatrixXd> L)
    : PlantObserver(std::move(context), {SensorTiming::kSampled}), L_(std::move(L)) {
  check_gains("L", L_, plant(), SensorTiming::kSampled);
  build_flow();
}

void ConstantGainObserver::sample(std::size_t sensor, const double* y, const Held& held,
                                  double* state, double* workspace) const {
  double* innovation = innovation_.of(workspace);
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, innovation);
  add_product(L_[sensor], innovation, state);
}

}  // namespace sampled_data_observers

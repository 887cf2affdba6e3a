#include "observer/scheduled_gain_observer.h"

#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {

ScheduledGainObserver::ScheduledGainObserver(ObserverContext context, ScheduledGains gains)
    : PlantObserver(std::move(context), {SensorTiming::kSampled}),
      gain_(std::move(gains), plant()) {
  for (std::size_t i = 0; i < plant().sensors().size(); ++i) since_sample_.push_back(timer());
  build_flow();
}

LawGains ScheduledGainObserver::gains() const {
  LawGains result;
  gain_.list(plant(), &result);
  return result;
}

void ScheduledGainObserver::sample(std::size_t sensor, const double* y, const Held& held,
                                   double* state, double* workspace) const {
  double* tau = tau_.of(workspace);
  double* K = K_.of(workspace);
  double* innovation = innovation_.of(workspace);
  for (std::size_t i = 0; i < since_sample_.size(); ++i) {
    // Divided by 1e9 a node of whole nanoseconds is the number that its decimals are read as.
    tau[i] = since_sample_[i].of(state) / 1e9;
  }
  gain_.evaluate(sensor, tau, K, of_gain_.of(workspace));
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, innovation);
  add_product(K, n(), plant().sensors()[sensor].outputs(), innovation, state);
  since_sample_[sensor].restart(state);
}

}  // namespace sampled_data_observers

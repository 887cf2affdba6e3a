#include "extending/dead_zone_observer.h"

#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"
#include "sampled_data_observers/observer/gain_check.h"

namespace my_observers {

using namespace sampled_data_observers;

DeadZoneObserver::DeadZoneObserver(ObserverContext context, std::vector<Eigen::MatrixXd> L,
                                   double width)
    : PlantObserver(std::move(context), {SensorTiming::kSampled}), L_(std::move(L)), width_(width) {
  check_gains("L", L_, plant(), SensorTiming::kSampled);
  build_flow();
}

LawGains DeadZoneObserver::gains() const {
  return LawGains().add("L", L_, plant(), SensorTiming::kSampled).add("width", width_);
}

void DeadZoneObserver::sample(std::size_t sensor, const double* y, const Held& held, double* state,
                              double* workspace) const {
  double* innovation = innovation_.of(workspace);
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, innovation);
  for (Eigen::Index i = 0; i < plant().sensors()[sensor].outputs(); ++i) {
    if (innovation[i] > width_) {
      innovation[i] -= width_;
    } else {
      innovation[i] = innovation[i] < -width_ ? innovation[i] + width_ : 0.0;
    }
  }
  add_product(L_[sensor], innovation, state);
}

}  // namespace my_observers

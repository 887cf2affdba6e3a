#include "config/gains/builders.h"
#include "observer/constant_gain_observer.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {

std::shared_ptr<const ObserverLaw> build_constant_gain(ConfigSection& gains,
                                                       const LawContext& context) {
  return std::make_shared<const ConstantGainObserver>(
      context.observer, read_gain_per_sensor(gains, "L", context.plant(), SensorTiming::kSampled,
                                             context.plant().states()));
}

}  // namespace sampled_data_observers

#include "config/gains/builders.h"
#include "observer/sample_and_hold_observer.h"
#include "sampled_data_observers/config/gains_config.h"

namespace sampled_data_observers {

std::shared_ptr<const ObserverLaw> build_sample_and_hold(ConfigSection& gains,
                                                         const LawContext& context) {
  return std::make_shared<const SampleAndHoldObserver>(
      context.observer, read_gain_per_sensor(gains, "L", context.plant(), SensorTiming::kSampled,
                                             context.plant().states()));
}

}  // namespace sampled_data_observers

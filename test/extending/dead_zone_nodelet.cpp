// What makes the law of dead_zone_observer.h an observer type: the parser of its gains, one line
// that registers it, and the nodelet.
#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "extending/dead_zone_observer.h"
#include "sampled_data_observers/config/gains_config.h"
#include "sampled_data_observers/config/law_registry.h"
#include "sampled_data_observers/ros/observer_nodelet.h"

namespace my_observers {

using namespace sampled_data_observers;

std::shared_ptr<const ObserverLaw> build_dead_zone(ConfigSection& gains,
                                                   const LawContext& context) {
  const Plant& plant = context.plant();
  return std::make_shared<const DeadZoneObserver>(
      context.observer,
      read_gain_per_sensor(gains, "L", plant, SensorTiming::kSampled, plant.states()),
      gains.number_in("width", 0.0, 1e9, std::nullopt));
}

const bool kRegistered = register_observer_type("DeadZoneObserver", build_dead_zone);

class DeadZoneObserverNodelet : public ObserverNodelet {
 public:
  DeadZoneObserverNodelet() : ObserverNodelet("DeadZoneObserver") {}
};

}  // namespace my_observers

PLUGINLIB_EXPORT_CLASS(my_observers::DeadZoneObserverNodelet, nodelet::Nodelet)

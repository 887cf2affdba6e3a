#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "ros/jump_detector_nodelet.h"
#include "ros/plant_simulator.h"
#include "sampled_data_observers/ros/observer_nodelet.h"

// One nodelet per observer type, and one of any. They differ in their names only: the configuration
// makes the law.
#define SDO_OBSERVER_NODELET(TYPE)               \
  namespace sampled_data_observers {             \
  class TYPE##Nodelet : public ObserverNodelet { \
   public:                                       \
    TYPE##Nodelet() : ObserverNodelet(#TYPE) {}  \
  };                                             \
  }                                              \
  PLUGINLIB_EXPORT_CLASS(sampled_data_observers::TYPE##Nodelet, nodelet::Nodelet)

namespace sampled_data_observers {
class AnyObserverNodelet : public ObserverNodelet {
 public:
  AnyObserverNodelet() : ObserverNodelet("") {}
};
}  // namespace sampled_data_observers
PLUGINLIB_EXPORT_CLASS(sampled_data_observers::AnyObserverNodelet, nodelet::Nodelet)

SDO_OBSERVER_NODELET(ConstantGainObserver)
SDO_OBSERVER_NODELET(HighGainObserver)
SDO_OBSERVER_NODELET(HybridKalmanFilter)
SDO_OBSERVER_NODELET(IntersampleInjectionObserver)
SDO_OBSERVER_NODELET(SampleAndHoldObserver)
SDO_OBSERVER_NODELET(SwitchedObserver)
SDO_OBSERVER_NODELET(SynchronizedObserver)
SDO_OBSERVER_NODELET(TimeVaryingGainObserver)

PLUGINLIB_EXPORT_CLASS(sampled_data_observers::JumpDetectorNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(sampled_data_observers::PlantSimulatorNodelet, nodelet::Nodelet)

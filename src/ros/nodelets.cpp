#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "sampled_data_observers/ros/observer_nodelet.h"

namespace sampled_data_observers {

class ConstantGainObserverNodelet : public ObserverNodelet {
 public:
  ConstantGainObserverNodelet() : ObserverNodelet("ConstantGainObserver") {}
};

}  // namespace sampled_data_observers

PLUGINLIB_EXPORT_CLASS(sampled_data_observers::ConstantGainObserverNodelet, nodelet::Nodelet)

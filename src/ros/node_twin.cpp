#include "ros/node_twin.h"

#include <nodelet/loader.h>
#include <ros/ros.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "real_time/short_slices.h"

namespace sampled_data_observers {

int run_node_twin(const char* type, const char* node_name, int argc, char** argv) {
  ask_for_short_slices();  // before roscpp starts its threads
  ros::init(argc, argv, node_name);
  try {
    nodelet::Loader loader(false);
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (!loader.load(ros::this_node::getName(), std::string("sampled_data_observers/") + type,
                     ros::names::getRemappings(), arguments)) {
      return 1;
    }
    ros::spin();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", node_name, error.what());
    return 1;
  }
  return 0;
}

}  // namespace sampled_data_observers

#include "replay/replay_config.h"

#include <rosbag/view.h>

#include "messages/plant_plugins.h"
#include "replay/bag_source.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/messages/static_places.h"

namespace sampled_data_observers {

ObserverConfig read_replay_config(const std::vector<std::string>& files,
                                  const std::vector<std::string>& bags) {
  std::vector<ConfigNode> trees;
  for (const std::string& file : files) trees.push_back(read_yaml_file(file));
  StaticPlaces places(merge(trees));
  if (!places.are_known()) {
    const BagSet recorded(bags);
    rosbag::View view;
    recorded.look_through(view, {recorded.name_of("/tf_static")});
    for (const rosbag::MessageInstance& instance : view) {
      if (places.are_known()) break;
      places.take(*instantiate<tf2_msgs::TFMessage>(instance));
    }
  }
  return read_observer_config(places.tree(), load_plant_plugin);
}

}  // namespace sampled_data_observers

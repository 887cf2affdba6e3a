#include "messages/plant_plugins.h"

#include <pluginlib/class_loader.hpp>
#include <stdexcept>

namespace sampled_data_observers {

std::shared_ptr<const PlantPlugin> load_plant_plugin(const std::string& type) {
  using Loader = pluginlib::ClassLoader<PlantPlugin>;
  // The library must stay loaded as long as maps of its plants are in use: to the end.
  static Loader& loader =
      *new Loader("sampled_data_observers", "sampled_data_observers::PlantPlugin");
  if (loader.isClassAvailable(type)) {
    try {
      return std::shared_ptr<const PlantPlugin>(loader.createUnmanagedInstance(type));
    } catch (const pluginlib::PluginlibException& fault) {
      throw std::runtime_error(fault.what());
    }
  }
  std::string known;
  for (const std::string& name : loader.getDeclaredClasses()) known += " " + name;
  throw std::runtime_error("no such plug-in; there are:" + (known.empty() ? " none" : known));
}

}  // namespace sampled_data_observers

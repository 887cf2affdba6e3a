#include "sampled_data_observers/ros/observer_nodelet.h"

#include <utility>

#include "sampled_data_observers/ros/parameter_tree.h"
#include "sampled_data_observers/ros/plant_plugins.h"

namespace sampled_data_observers {

void ObserverNodelet::onInit() {
  try {
    const ConfigNode tree = read_parameter_tree(getPrivateNodeHandle());
    const ObserverConfig config = read_observer_config(tree, load_plant_plugin);
    if (config.type != type_) {
      throw ConfigError("parameters of " + getPrivateNodeHandle().getNamespace(), "observer",
                        type_ +
                            ", the type of this nodelet (observer.launch and example.launch take "
                            "another one by type:=)",
                        config.type);
    }
    start(tree, config);
  } catch (const std::exception& error) {
    NODELET_FATAL("not started: %s", error.what());
    // Now, while the callback queue still lives: roscpp crashes if that happens in the destructor.
    stop();
    throw;
  }
}

void ObserverNodelet::stop() {
  clock_watch_.reset();
  master_watch_.reset();
  diagnostics_.reset();
  services_.reset();
  gains_.reset();
  subscriptions_.reset();
  publication_.reset();
  runtime_.reset();
}

void ObserverNodelet::start(const ConfigNode& tree, const ObserverConfig& config) {
  // Callbacks run as soon as there is something to call: all is made before anything starts.
  const ros::NodeHandle& handle = getNodeHandle();
  runtime_ = std::make_unique<SharedRuntime>(config, getName(), handle.resolveName("reset"));
  std::unique_ptr<EstimateOutputs> outputs;
  if (config.outputs) {
    outputs = std::make_unique<EstimateOutputs>(handle, *config.outputs, config.period);
  }
  publication_ = std::make_unique<EstimatePublication>(handle, *runtime_, std::move(outputs));
  subscriptions_ =
      std::make_unique<EventSubscriptions>(handle, config, *runtime_, *publication_, getName());
  gains_ = std::make_unique<GainReloader>(tree, config, *runtime_);
  // Their queue has threads of its own, so that events go on while a service works.
  services_ = std::make_unique<ObserverServices>(getMTNodeHandle(), *runtime_, *gains_, getName());
  clock_watch_ = std::make_unique<ClockWatch>(getMTNodeHandle(), getName());
  diagnostics_ =
      std::make_unique<DiagnosticsReporter>(getMTNodeHandle(), getMTPrivateNodeHandle(), getName(),
                                            diagnosis_subject(config), runtime_->statistics());
  std::vector<ExpectedType> topics;
  for (const EventChannel& channel : event_channels(config)) {
    topics.push_back({handle.resolveName(channel.source.topic), channel.source.type});
  }
  master_watch_ = std::make_unique<MasterWatch>(
      getMTNodeHandle(), services_->names(), std::move(topics),
      [this](std::size_t channel, const std::string& type) {
        diagnostics_->note_published_type(channel, type);
      },
      getName());
  publication_->start(config, getName());
  subscriptions_->start();
  NODELET_INFO("%s: %zu states, estimates at %.6g Hz on %s", type_.c_str(),
               config.law->estimate_names().size(), 1.0 / to_seconds(config.period),
               publication_->topic().c_str());
  if (!config.guarantee.empty()) NODELET_INFO("certified by %s", config.guarantee.c_str());
  if (!config.warning.empty()) NODELET_WARN("%s", config.warning.c_str());
  for (const std::string& warning : config.warnings) NODELET_WARN("%s", warning.c_str());
}

}  // namespace sampled_data_observers

#include "sampled_data_observers/ros/observer_nodelet.h"

#include <utility>

#include "messages/plant_plugins.h"
#include "ros/parameter_tree.h"
#include "ros/places_of_tf.h"
#include "sampled_data_observers/config/event_channels.h"

namespace sampled_data_observers {
namespace {

constexpr std::uint32_t kEventThreads = 1;  // one event after another
/// So that a master that does not answer holds up neither diagnostics nor services.
constexpr std::uint32_t kControlThreads = 2;
/// Of services that may take long: callers are told that they are busy meanwhile.
constexpr std::uint32_t kQueryThreads = 2;

/// By an observer, in full.
std::vector<std::string> published_topics(const ros::NodeHandle& handle,
                                          const ObserverConfig& config) {
  std::vector<std::string> topics = {"estimate", "events"};
  if (config.law->has_bound()) topics.emplace_back("error_ellipsoid");
  if (config.outputs) {
    for (const auto& topic :
         {config.outputs->odometry, config.outputs->pose, config.outputs->twist}) {
      if (topic) topics.push_back(*topic);
    }
  }
  for (std::string& topic : topics) topic = handle.resolveName(topic);
  return topics;
}

}  // namespace

ObserverNodelet::ObserverNodelet(std::string type)
    : type_(std::move(type)),
      event_threads_(kEventThreads),
      control_threads_(kControlThreads),
      query_threads_(kQueryThreads) {}

ObserverNodelet::~ObserverNodelet() { stop(); }

void ObserverNodelet::onInit() {
  const NodeLog log(getName());
  try {
    const ConfigNode tree = with_places_of_tf(read_parameter_tree(getPrivateNodeHandle()), log);
    const ObserverConfig config = read_observer_config(tree, load_plant_plugin);
    if (!type_.empty() && config.type != type_) {
      throw ConfigError("parameters of " + getPrivateNodeHandle().getNamespace(), "observer",
                        type_ + ", the type of this nodelet (the nodelet Observer is of any)",
                        config.type);
    }
    start(tree, config, log);
  } catch (const std::exception& error) {
    log.fatal("not started: %s", error.what());
    throw;
  }
}

void ObserverNodelet::stop() {
  if (services_) services_->stop();
  query_threads_.stop();
  control_threads_.stop();
  event_threads_.stop();
  clock_watch_.reset();
  refused_publishers_.reset();
  master_watch_.reset();
  diagnostics_.reset();
  services_.reset();
  gains_.reset();
  subscriptions_.reset();
  publication_.reset();
  runtime_.reset();
}

void ObserverNodelet::start(const ConfigNode& tree, const ObserverConfig& config,
                            const NodeLog& log) {
  const ros::NodeHandle handle = event_threads_.handle(getNodeHandle());
  // Others, so that events go on while a service works.
  const ros::NodeHandle control = control_threads_.handle(getNodeHandle());
  runtime_ = std::make_unique<SharedRuntime>(config, log, handle.resolveName("reset"));
  std::unique_ptr<EstimateOutputs> outputs;
  if (config.outputs) {
    outputs = std::make_unique<EstimateOutputs>(handle, *config.outputs,
                                                config.law->estimate_size(), config.period, log);
  }
  publication_ = std::make_unique<EstimatePublication>(handle, *runtime_, std::move(outputs));
  subscriptions_ =
      std::make_unique<EventSubscriptions>(handle, config, *runtime_, *publication_, log);
  // Nobody calls before all is there.
  gains_ = std::make_unique<GainReloader>(
      tree, config, *runtime_,
      [this](const ObserverConfig& next) { diagnostics_->note_other_gains(next); });
  services_ = std::make_unique<ObserverServices>(control, query_threads_.handle(getNodeHandle()),
                                                 *runtime_, *gains_, log);
  clock_watch_ = std::make_unique<ClockWatch>(control, log);
  diagnostics_ = std::make_unique<DiagnosticsReporter>(
      control, control_threads_.handle(getPrivateNodeHandle()), log, diagnosis_subject(config),
      runtime_->statistics());
  std::vector<ExpectedType> topics;
  for (const EventChannel& channel : event_channels(config)) {
    topics.push_back({handle.resolveName(channel.source.topic), channel.source.type});
  }
  master_watch_ = std::make_unique<MasterWatch>(
      control, services_->names(), std::move(topics), published_topics(handle, config),
      [this](std::size_t channel, const std::string& type) {
        diagnostics_->note_published_type(channel, type);
      },
      log);
  refused_publishers_ = std::make_unique<RefusedPublishers>(
      subscriptions_->expected(),
      [this](std::size_t channel, const RefusedPublishers::Text& sender) {
        subscriptions_->refuse(channel, sender);
      });
  master_watch_->also([this] { refused_publishers_->check(); });
  publication_->start(config, log);
  subscriptions_->start([this](const std::string& datum) { diagnostics_->note_datum(datum); });
  event_threads_.start();
  control_threads_.start();
  query_threads_.start();
  log.info("%s: %zu states, estimates at %.6g Hz on %s", config.type.c_str(),
           config.law->estimate_names().size(), 1.0 / to_seconds(config.period),
           publication_->topic().c_str());
  if (!config.guarantee.empty()) log.info("certified by %s", config.guarantee.c_str());
  if (!config.warning.empty()) log.warn("%s", config.warning.c_str());
  for (const std::string& warning : config.warnings) log.warn("%s", warning.c_str());
}

}  // namespace sampled_data_observers

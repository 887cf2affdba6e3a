#include "sampled_data_observers/ros/gain_reloader.h"

#include <filesystem>
#include <stdexcept>
#include <thread>
#include <utility>

#include "config/confined_path.h"
#include "config/gain_replacement.h"
#include "messages/plant_plugins.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

/// Between two calls: so many laws are kept (Estimator::kEarlierLaws) that samples which are late
/// by less are used however often somebody calls.
constexpr std::chrono::milliseconds kPause{500};

}  // namespace

GainReloader::Busy::Busy()
    : std::runtime_error("busy: the gains of another call are being loaded") {}

GainReloader::GainReloader(ConfigNode tree, const ObserverConfig& config, SharedRuntime& runtime,
                           std::function<void(const ObserverConfig&)> tell)
    : tree_(std::move(tree)),
      type_(config.type),
      directory_(config.gains_directory),
      runtime_(runtime),
      tell_(std::move(tell)) {
  for (const auto& source : config.sensors) {
    covariances_.push_back(source ? source->covariance : std::nullopt);
  }
  std::error_code fault;
  if (directory_.empty() || std::filesystem::is_directory(directory_, fault)) return;
  throw ConfigError(tree_.origin, "gains_directory", "a directory on this machine",
                    "'" + directory_ + "'");
}

/// Sources go on as they are.
void GainReloader::require_same_covariances(const ObserverConfig& next,
                                            const std::string& file) const {
  for (std::size_t i = 0; i < covariances_.size(); ++i) {
    if (next.sensors[i] && !(next.sensors[i]->covariance == covariances_[i])) {
      throw ConfigError(file, "gains/R/" + next.plant->sensors()[i].name,
                        "what messages have to do with R as it was when the observer began",
                        "another");
    }
  }
}

std::string GainReloader::reload(const std::string& file) {
  if (directory_.empty()) {
    throw std::runtime_error("gain files may only be loaded where gains_directory is configured");
  }
  const OneAtATime::Turn turn = calls_.enter();
  if (!turn.owns_lock()) throw Busy();
  std::this_thread::sleep_until(last_call_ + kPause);
  last_call_ = std::chrono::steady_clock::now();  // one that fails counts, too
  ConfigNode tree = replace_gains(tree_, read_yaml_file(confined_path(directory_, file)));
  const ObserverConfig next = read_observer_config(tree, load_plant_plugin);
  if (next.type != type_) throw ConfigError(file, "observer", type_, next.type);
  require_same_covariances(next, file);
  runtime_.replace(std::make_unique<ObserverRuntime>(next));
  tell_(next);
  last_call_ = std::chrono::steady_clock::now();
  tree_ = std::move(tree);
  if (!next.guarantee.empty()) return "certified by " + next.guarantee;
  std::string text = next.warning.empty() ? "without certificate" : next.warning;
  for (const std::string& warning : next.warnings) text += "; " + warning;
  return text;
}

}  // namespace sampled_data_observers

#include "sampled_data_observers/config/law_registry.h"

#include <map>
#include <stdexcept>
#include <utility>

#include "config/gains/readers.h"
#include "observer/constant_gain_observer.h"
#include "observer/linear_high_gain_observer.h"
#include "observer/original_high_gain_observer.h"
#include "observer/sample_and_hold_observer.h"
#include "observer/scheduled_gain_observer.h"
#include "observer/time_varying_gain_observer.h"
#include "observer/unscented_kalman_filter.h"

namespace sampled_data_observers {
namespace {

/// For a law that is made of what `read` returns.
template <class Law, auto read>
std::shared_ptr<const ObserverLaw> build(ConfigSection& gains, const LawContext& context) {
  return std::make_shared<const Law>(context.observer, read(gains, context));
}

std::shared_ptr<const ObserverLaw> build_time_varying_gain(ConfigSection& gains,
                                                           const LawContext& context) {
  if (gains.has("timers") || gains.has("K")) {
    return std::make_shared<const ScheduledGainObserver>(context.observer,
                                                         read_scheduled_gains(gains, context));
  }
  const auto [P, lambda] = read_time_varying_gains(gains, context);
  return std::make_shared<const TimeVaryingGainObserver>(context.observer, P, lambda);
}

std::shared_ptr<const ObserverLaw> build_hybrid_kalman_filter(ConfigSection& gains,
                                                              const LawContext& context) {
  const auto [covariances, is_unscented] = read_kalman_gains(gains, context);
  if (is_unscented) {
    return std::make_shared<const UnscentedKalmanFilter>(context.observer, covariances);
  }
  return std::make_shared<const HybridKalmanFilter>(context.observer, covariances);
}

std::shared_ptr<const ObserverLaw> build_high_gain(ConfigSection& gains,
                                                   const LawContext& context) {
  const auto [form, settings, maps, damping] = read_high_gains(gains, context);
  switch (form) {
    case HighGains::Form::kTransformed:
      return std::make_shared<const TransformedHighGainObserver>(context.observer, settings, maps);
    case HighGains::Form::kOriginal: {
      std::vector<std::shared_ptr<const VectorMap>> T;
      for (const TransformedHighGainObserver::Maps& of_mode : maps) T.push_back(of_mode.T);
      return std::make_shared<const OriginalHighGainObserver>(context.observer, settings, T,
                                                              damping);
    }
    case HighGains::Form::kLinear:
      break;
  }
  return std::make_shared<const LinearHighGainObserver>(context.observer, settings);
}

std::map<std::string, LawBuilder>& builders() {
  static std::map<std::string, LawBuilder> all = {
      {"ConstantGainObserver", build<ConstantGainObserver, read_sampled_gains>},
      {"HighGainObserver", build_high_gain},
      {"HybridKalmanFilter", build_hybrid_kalman_filter},
      {"IntersampleInjectionObserver", build<IntersampleInjectionObserver, read_intersample_gains>},
      {"SampleAndHoldObserver", build<SampleAndHoldObserver, read_sampled_gains>},
      {"SwitchedObserver", build<SwitchedObserver, read_switched_gains>},
      {"SynchronizedObserver", build<SynchronizedObserver, read_synchronized_gains>},
      {"TimeVaryingGainObserver", build_time_varying_gain},
  };
  return all;
}

}  // namespace

bool register_observer_type(const std::string& type, LawBuilder builder) {
  if (!builders().emplace(type, builder).second) {
    throw std::logic_error("the observer type " + type + " is registered already");
  }
  return true;
}

std::vector<std::string> observer_types() {
  std::vector<std::string> types;
  for (const auto& builder : builders()) types.push_back(builder.first);
  return types;
}

std::shared_ptr<const ObserverLaw> build_law(const std::string& type, ConfigSection& gains,
                                             const LawContext& context) {
  try {
    return builders().at(type)(gains, context);
  } catch (const std::invalid_argument& fault) {
    throw ConfigError(gains.origin(), gains.path(), "gains that fit a " + type, fault.what());
  }
}

}  // namespace sampled_data_observers

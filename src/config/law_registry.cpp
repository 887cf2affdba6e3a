#include "sampled_data_observers/config/law_registry.h"

#include <map>
#include <stdexcept>

#include "config/gains/builders.h"

namespace sampled_data_observers {
namespace {

std::map<std::string, LawBuilder>& builders() {
  static std::map<std::string, LawBuilder> all = {
      {"ConstantGainObserver", build_constant_gain},
      {"HighGainObserver", build_high_gain},
      {"HybridKalmanFilter", build_hybrid_kalman_filter},
      {"IntersampleInjectionObserver", build_intersample_injection},
      {"SampleAndHoldObserver", build_sample_and_hold},
      {"SwitchedObserver", build_switched},
      {"SynchronizedObserver", build_synchronized},
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

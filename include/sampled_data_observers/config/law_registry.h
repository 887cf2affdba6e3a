#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/plant_config.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// What the gains of a law are read with: the plant, where the estimate starts, and the names that
/// formulas among the gains may use.
struct LawContext {
  /// To be passed on to the constructor of the law.
  ObserverContext observer;
  /// For an ExpressionMap made of gains.
  ExpressionNames names;
  /// By how much the stamps of jumps may be off [s], >= 0.
  double jump_stamp_error = 0.0;

  /// The plant that is observed: its sizes are those that the gains must fit.
  const Plant& plant() const { return *observer.plant; }
};

/// Builds a law from the section `gains`, reading all keys of it. It may throw a ConfigError for a
/// fault in the gains, and std::invalid_argument for one that the law itself finds.
using LawBuilder = std::shared_ptr<const ObserverLaw> (*)(ConfigSection& gains,
                                                          const LawContext& context);

/// Adds an observer type. Returns true, so that it may initialize a constant before main().
/// @throws std::logic_error when there is a type of that name.
bool register_observer_type(const std::string& type, LawBuilder builder);

/// Names of the observer types, as the key `observer` and the nodelets have them.
std::vector<std::string> observer_types();

/// Builds the law of an observer type from the section `gains`.
/// @pre type is one of observer_types()
/// @throws ConfigError for a fault in the gains.
std::shared_ptr<const ObserverLaw> build_law(const std::string& type, ConfigSection& gains,
                                             const LawContext& context);

}  // namespace sampled_data_observers

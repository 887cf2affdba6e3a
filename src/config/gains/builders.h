#pragma once

#include <memory>

#include "sampled_data_observers/config/law_registry.h"

namespace sampled_data_observers {

// One for each observer type, in a file of its own: the LawBuilder that reads its gains.
std::shared_ptr<const ObserverLaw> build_constant_gain(ConfigSection& gains,
                                                       const LawContext& context);
std::shared_ptr<const ObserverLaw> build_intersample_injection(ConfigSection& gains,
                                                               const LawContext& context);
std::shared_ptr<const ObserverLaw> build_sample_and_hold(ConfigSection& gains,
                                                         const LawContext& context);
std::shared_ptr<const ObserverLaw> build_synchronized(ConfigSection& gains,
                                                      const LawContext& context);
std::shared_ptr<const ObserverLaw> build_hybrid_kalman_filter(ConfigSection& gains,
                                                              const LawContext& context);
std::shared_ptr<const ObserverLaw> build_time_varying_gain(ConfigSection& gains,
                                                           const LawContext& context);

std::shared_ptr<const ObserverLaw> build_high_gain(ConfigSection& gains, const LawContext& context);
std::shared_ptr<const ObserverLaw> build_switched(ConfigSection& gains, const LawContext& context);

}  // namespace sampled_data_observers

#include <optional>
#include <utility>

#include "config/gains/builders.h"
#include "observer/time_varying_gain_observer.h"

namespace sampled_data_observers {

std::shared_ptr<const ObserverLaw> build_time_varying_gain(ConfigSection& gains,
                                                           const LawContext& context) {
  const Eigen::Index n = context.plant().states();
  std::optional<Eigen::MatrixXd> P;
  if (gains.has("P")) P = gains.matrix("P", n, n);
  const std::optional<double> fallback = P ? std::optional<double>(0.0) : std::nullopt;
  const double lambda = gains.number_in("lambda", 0.0, 1.0, fallback);
  if (lambda == 1.0) throw gains.error("lambda", "a number in [0, 1)", "1");
  return std::make_shared<const TimeVaryingGainObserver>(context.observer, P, lambda);
}

}  // namespace sampled_data_observers

#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "observer/hybrid_kalman_filter.h"
#include "observer/intersample_injection_observer.h"
#include "observer/scheduled_gain.h"
#include "observer/switched_observer.h"
#include "observer/transformed_high_gain_observer.h"
#include "sampled_data_observers/config/law_registry.h"
#include "sampled_data_observers/observer/synchronized_observer.h"

namespace sampled_data_observers {

// What the section `gains` says, for each observer type in a file of its own. All keys of the
// section are read; whether the gains fit the plant beyond their sizes is for the law to say.

/// Of a TimeVaryingGainObserver with gains from one P, or from none.
struct TimeVaryingGains {
  std::optional<Eigen::MatrixXd> P;  ///< n x n
  double lambda = 0.0;
};

/// Of a HybridKalmanFilter, in one of its variants.
struct KalmanGains {
  KalmanCovariances covariances;
  bool is_unscented = false;
};

/// Of a HighGainObserver, in one of its three forms.
struct HighGains {
  enum class Form { kLinear, kTransformed, kOriginal };
  Form form = Form::kLinear;
  HighGainSettings settings;
  /// Per mode, unless the form is linear; of the original form T only.
  std::vector<TransformedHighGainObserver::Maps> maps;
  double damping = 0.0;  ///< of the original form
};

/// L of each sampled sensor: of a ConstantGainObserver and of a SampleAndHoldObserver.
std::vector<Eigen::MatrixXd> read_sampled_gains(ConfigSection& gains, const LawContext& context);
HighGains read_high_gains(ConfigSection& gains, const LawContext& context);
std::vector<IntersampleGains> read_intersample_gains(ConfigSection& gains,
                                                     const LawContext& context);
/// Of a TimeVaryingGainObserver with gains on a grid.
ScheduledGains read_scheduled_gains(ConfigSection& gains, const LawContext& context);
KalmanGains read_kalman_gains(ConfigSection& gains, const LawContext& context);
SwitchedGains read_switched_gains(ConfigSection& gains, const LawContext& context);
SynchronizedGains read_synchronized_gains(ConfigSection& gains, const LawContext& context);
TimeVaryingGains read_time_varying_gains(ConfigSection& gains, const LawContext& context);

}  // namespace sampled_data_observers

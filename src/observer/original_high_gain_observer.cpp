#include "observer/original_high_gain_observer.h"

#include <algorithm>
#include <utility>

#include "observer/gain_requirement.h"
#include "plant/differentiation.h"

namespace sampled_data_observers {

OriginalHighGainObserver::OriginalHighGainObserver(const ObserverContext& context,
                                                   const HighGainSettings& settings,
                                                   std::vector<std::shared_ptr<const VectorMap>> T,
                                                   double damping)
    : HighGainObserver(context, settings, {"T"}),
      T_(std::move(T)),
      gain_(scaled_gains(settings, plant())),
      damping_(damping),
      inverse_(settings.ell, settings.saturation.scales(), damping) {
  require_of_gains(gain_.front().size() == n(), "K: as many entries as the plant has states");
  require_of_gains(T_.size() == gain_.size(), "T: one per mode of the plant");
  for (const auto& T_q : T_) {
    require_of_gains(T_q && T_q->size() == n(), "T: as many entries as the plant has states");
  }
  build_flow();
  check_start();
}

LawGains OriginalHighGainObserver::gains() const {
  LawGains all = HighGainObserver::gains();
  return all.add("damping", damping_);
}

void OriginalHighGainObserver::derivative(const Held& held, const double* s, double* ds,
                                          double* workspace) const {
  double* x = x_.of(workspace);
  std::copy_n(s, n(), x);
  saturation().apply(x);
  PlantObserver::derivative(held, x, ds, workspace);
  if (held.y_c == nullptr) return;
  double innovation = 0.0;
  compute_innovation(plant(), held.mode, 0, held.y_c, s, held.u, &innovation);
  double* correction = correction_.of(workspace);
  double* J = J_.of(workspace);
  for (Eigen::Index i = 0; i < n(); ++i) correction[i] = gain_[held.mode](i) * innovation;
  differentiate(*T_[held.mode], x, held.u, saturation().scales(), J, differences_.of(workspace));
  inverse_.apply(J, correction, solving_.of(workspace));
  for (Eigen::Index i = 0; i < n(); ++i) ds[i] += correction[i];
}

}  // namespace sampled_data_observers

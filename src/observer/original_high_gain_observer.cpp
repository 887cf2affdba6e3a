#include "observer/original_high_gain_observer.h"

#include <algorithm>
#include <cmath>
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
      damping_(damping),
      inverse_(inverse_powers(settings, plant()), chains_of(settings, plant()).first,
               settings.saturation.scales(), damping) {
  for (const Eigen::MatrixXd& gain : scaled_gains(settings, plant())) {
    gain_.emplace_back();
    for (std::size_t i = 0; i < sensors(); ++i) {
      gain_.back().emplace_back(gain.middleCols(output_offset(i), plant().sensors()[i].outputs()));
    }
  }
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
  double* correction = correction_.of(workspace);
  double* J = J_.of(workspace);
  std::fill_n(correction, n(), 0.0);
  add_innovations(gain_[held.mode], held, s, correction, workspace);
  differentiate(*T_[held.mode], x, held.u, saturation().scales(), J, differences_.of(workspace));
  inverse_.apply(J, correction, solving_.of(workspace));
  for (Eigen::Index i = 0; i < n(); ++i) ds[i] += correction[i];
}

void OriginalHighGainObserver::confine(double* s) const {
  if (std::all_of(s, s + n(), [](double value) { return std::isfinite(value); })) {
    saturation().apply(s);
  }
}

}  // namespace sampled_data_observers

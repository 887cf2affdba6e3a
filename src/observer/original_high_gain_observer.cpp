#include "observer/original_high_gain_observer.h"

#include <algorithm>
#include <utility>

#include "linear_algebra/ordered_solve.h"
#include "observer/gain_requirement.h"
#include "observer/observable_form.h"
#include "plant/differentiation.h"

namespace sampled_data_observers {

OriginalHighGainObserver::OriginalHighGainObserver(const ObserverContext& context,
                                                   Saturation saturation, double ell,
                                                   const Eigen::VectorXd& K,
                                                   std::shared_ptr<const VectorMap> T)
    : HighGainObserver(context, std::move(saturation), ell, {K}, {"T"}),
      T_(std::move(T)),
      gain_(scaled_gain(ell, K)) {
  require_one_output();
  require_of_gains(gain_.size() == n(), "K: as many entries as the plant has states");
  require_of_gains(T_ && T_->size() == n(), "T: as many entries as the plant has states");
  build_flow();
  check_start();
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
  for (Eigen::Index i = 0; i < n(); ++i) correction[i] = gain_(i) * innovation;
  differentiate(*T_, s, held.u, saturation().scales(), J, differences_.of(workspace));
  solve_in_place(J, correction, n());
  for (Eigen::Index i = 0; i < n(); ++i) ds[i] += correction[i];
}

}  // namespace sampled_data_observers

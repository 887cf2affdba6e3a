#include "observer/transformed_high_gain_observer.h"

#include <algorithm>
#include <utility>

#include "observer/gain_requirement.h"
#include "observer/observable_form.h"

namespace sampled_data_observers {

TransformedHighGainObserver::TransformedHighGainObserver(const ObserverContext& context,
                                                         Saturation saturation, double ell,
                                                         const Eigen::VectorXd& K, Maps maps)
    : HighGainObserver(context, std::move(saturation), ell, {K}, {"T", "Phi", "Theta"}, K.size()),
      maps_(std::move(maps)),
      gain_(scaled_gain(ell, K)) {
  require_one_output();
  require_of_gains(maps_.T && maps_.T->size() == gain_.size(), "T: as many entries as K");
  require_of_gains(maps_.Phi && maps_.Phi->size() == 1, "Phi: one entry");
  require_of_gains(maps_.Theta && maps_.Theta->size() == n(), "Theta: one entry per state");
  build_flow();
  check_start();
}

void TransformedHighGainObserver::start_from(const double* estimate, double* state) const {
  HighGainObserver::start_from(estimate, state);
  maps_.T->evaluate(state, held(state).u, z_.of(state));
}

void TransformedHighGainObserver::derivative(const Held& held, const double* s, double* ds,
                                             double* workspace) const {
  const Eigen::Index d = gain_.size();
  const double* z = z_.of(s);
  double* dz = z_.of(ds);
  std::fill_n(ds, n(), 0.0);  // x̂ is computed from z
  double* argument = argument_.of(workspace);
  double* x = argument + d;
  maps_.Theta->evaluate(z, held.u, x);
  saturation().apply(x);
  maps_.T->evaluate(x, held.u, argument);
  for (Eigen::Index i = 0; i + 1 < d; ++i) dz[i] = z[i + 1];
  maps_.Phi->evaluate(argument, held.u, dz + d - 1);
  if (held.y_c == nullptr) return;
  const double difference = held.y_c[0] - z[0];
  const double innovation =
      plant().sensors().front().angular.front() ? wrap_angle(difference) : difference;
  for (Eigen::Index i = 0; i < d; ++i) dz[i] += gain_(i) * innovation;
}

void TransformedHighGainObserver::jump(const Held& held, std::size_t next,
                                       const JumpOutputs& outputs, double* state,
                                       double* workspace) const {
  HighGainObserver::jump(held, next, outputs, state, workspace);
  maps_.T->evaluate(state, held.u, z_.of(state));
}

void TransformedHighGainObserver::complete(const Held& held, double* state, double*) const {
  maps_.Theta->evaluate(z_.of(state), held.u, state);
  saturation().apply(state);
}

}  // namespace sampled_data_observers

#include "observer/transformed_high_gain_observer.h"

#include <algorithm>
#include <utility>

#include "observer/gain_requirement.h"
#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {

TransformedHighGainObserver::TransformedHighGainObserver(const ObserverContext& context,
                                                         const HighGainSettings& settings,
                                                         std::vector<Maps> maps)
    : HighGainObserver(context, settings, {"T", "Phi", "Theta"},
                       chains_of(settings, *context.plant).entries()),
      maps_(std::move(maps)),
      chains_(chains_of(settings, plant())),
      gain_(scaled_gains(settings, plant())) {
  require_of_gains(maps_.size() == gain_.size(), "T, Phi and Theta: of each mode of the plant");
  require_of_gains(plant().unit_norms().empty(),
                   "this form takes no plant with unit_norm: it flows in coordinates of its own");
  for (const Maps& of_mode : maps_) {
    require_of_gains(of_mode.T && of_mode.T->size() == z_.size(), "T: as many entries as K");
    require_of_gains(of_mode.Phi && of_mode.Phi->size() == of_outputs_.size(),
                     "Phi: one entry per continuous output");
    require_of_gains(of_mode.Theta && of_mode.Theta->size() == n(), "Theta: one entry per state");
  }
  build_flow();
  check_start();
}

void TransformedHighGainObserver::start_from(const double* estimate, double* state) const {
  HighGainObserver::start_from(estimate, state);
  maps_[mode_of(state)].T->evaluate(state, held(state).u, z_.of(state));
}

void TransformedHighGainObserver::keep_mode(std::size_t mode, double* state) const {
  HighGainObserver::keep_mode(mode, state);
  start_from(state, state);
}

void TransformedHighGainObserver::derivative(const Held& held, const double* s, double* ds,
                                             double* workspace) const {
  const Maps& maps = maps_[held.mode];
  const double* z = z_.of(s);
  double* dz = z_.of(ds);
  std::fill_n(ds, n(), 0.0);  // x̂ is computed from z
  double* argument = argument_.of(workspace);
  double* x = argument + z_.size();
  maps.Theta->evaluate(z, held.u, x);
  saturation().apply(x);
  maps.T->evaluate(x, held.u, argument);
  std::copy(z + 1, z + z_.size(), dz);
  double* phi = of_outputs_.of(workspace);
  maps.Phi->evaluate(argument, held.u, phi);
  for (std::size_t j = 0; j < chains_.size(); ++j) dz[chains_.last[j]] = phi[j];
  if (held.y_c == nullptr) return;
  double* innovation = phi;
  chains_.innovations(held.y_c, z, innovation);
  add_product(gain_[held.mode], innovation, dz);
}

void TransformedHighGainObserver::jump(const Held& held, std::size_t next,
                                       const JumpOutputs& outputs, double* state,
                                       double* workspace) const {
  HighGainObserver::jump(held, next, outputs, state, workspace);
  maps_[next].T->evaluate(state, held.u, z_.of(state));
}

void TransformedHighGainObserver::complete(const Held& held, double* state, double*) const {
  maps_[held.mode].Theta->evaluate(z_.of(state), held.u, state);
  saturation().apply(state);
}

}  // namespace sampled_data_observers

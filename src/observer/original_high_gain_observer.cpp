#include "observer/original_high_gain_observer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "linear_algebra/ordered_solve.h"
#include "observer/gain_requirement.h"
#include "observer/observable_form.h"

namespace sampled_data_observers {
namespace {

/// The step of central differences that balances rounding and truncation, relative to the variable:
/// the third root of the rounding unit, a power of two.
constexpr double kDifference = 1.0 / 131072.0;

}  // namespace

OriginalHighGainObserver::OriginalHighGainObserver(const ObserverContext& context,
                                                   Saturation saturation, double ell,
                                                   const Eigen::VectorXd& K,
                                                   std::shared_ptr<const VectorMap> T)
    : HighGainObserver(context, std::move(saturation)),
      T_(std::move(T)),
      gain_(scaled_gain(ell, K)) {
  require_one_output();
  require_of_gains(gain_.size() == n(), "K: as many entries as the plant has states");
  require_of_gains(T_ && T_->size() == n(), "T: as many entries as the plant has states");
  listed().add("ell", ell).add("K", K.transpose()).add("T", Eigen::MatrixXd());
  build_flow();
  check_start();
}

void OriginalHighGainObserver::differentiate(const double* x, const double* u, double* J,
                                             double* workspace) const {
  double* point = point_.of(workspace);
  double* above = above_.of(workspace);
  double* below = below_.of(workspace);
  std::copy_n(x, n(), point);
  for (Eigen::Index j = 0; j < n(); ++j, J += n()) {
    const double step = kDifference * std::max(std::abs(x[j]), saturation().scale(j));
    point[j] = x[j] + step;
    const double high = point[j];
    T_->evaluate(point, u, above);
    point[j] = x[j] - step;
    // What was rounded off the step must not count.
    const double width = high - point[j];
    T_->evaluate(point, u, below);
    point[j] = x[j];
    for (Eigen::Index i = 0; i < n(); ++i) J[i] = (above[i] - below[i]) / width;
  }
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
  differentiate(s, held.u, J, workspace);
  solve_in_place(J, correction, n());
  for (Eigen::Index i = 0; i < n(); ++i) ds[i] += correction[i];
}

}  // namespace sampled_data_observers

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "linear_algebra/ordered_solve.h"
#include "observer/high_gain_observer.h"
#include "observer/observable_form.h"

namespace sampled_data_observers {
namespace {

/// The step of central differences that balances rounding and truncation, relative to the variable:
/// the third root of the rounding unit, a power of two.
constexpr double kDifference = 1.0 / 131072.0;

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

/// ℓ 𝓛(ℓ) K
Eigen::VectorXd scaled_gain(double ell, const Eigen::VectorXd& K, const Plant& plant) {
  require(ell > 0.0 && std::isfinite(ell), "ell must be positive");
  require(K.size() > 0 && is_hurwitz(K), "K: A - K H is not Hurwitz");
  require(plant.sensors().size() == 1 && plant.max_outputs() == 1,
          "this form takes one continuous sensor with one output");
  Eigen::VectorXd result = K;
  for (Eigen::Index i = 0; i < K.size(); ++i)
    result(i) *= std::pow(ell, static_cast<double>(i + 1));
  return result;
}

}  // namespace

TransformedHighGainObserver::TransformedHighGainObserver(const ObserverContext& context,
                                                         Saturation saturation, double ell,
                                                         const Eigen::VectorXd& K, Maps maps)
    : HighGainObserver(context, {K.size(), 0, 0, K.size() + context.plant->states()},
                       std::move(saturation)),
      maps_(std::move(maps)),
      gain_(scaled_gain(ell, K, plant())) {
  require(maps_.T && maps_.T->size() == gain_.size(), "T: as many entries as K");
  require(maps_.Phi && maps_.Phi->size() == 1, "Phi: one entry");
  require(maps_.Theta && maps_.Theta->size() == n(), "Theta: one entry per state");
  listed().add("ell", ell).add("K", K.transpose());
  for (const char* map : {"T", "Phi", "Theta"}) listed().add(map, Eigen::MatrixXd());
  build_flow();
  check_start();
}

void TransformedHighGainObserver::start_from(const double* estimate, double* state) const {
  HighGainObserver::start_from(estimate, state);
  maps_.T->evaluate(state, held(state).u, state + n());
}

void TransformedHighGainObserver::derivative(const Held& held, const double* s, double* ds,
                                             double* workspace) const {
  const Eigen::Index d = gain_.size();
  const double* z = s + n();
  double* dz = ds + n();
  std::fill_n(ds, n(), 0.0);  // x̂ is computed from z
  double* argument = workspace;
  double* x = workspace + d;
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
  maps_.T->evaluate(state, held.u, state + n());
}

void TransformedHighGainObserver::complete(const Held& held, double* state,
                                           double* workspace) const {
  static_cast<void>(workspace);
  maps_.Theta->evaluate(state + n(), held.u, state);
  saturation().apply(state);
}

OriginalHighGainObserver::OriginalHighGainObserver(const ObserverContext& context,
                                                   Saturation saturation, double ell,
                                                   const Eigen::VectorXd& K,
                                                   std::shared_ptr<const VectorMap> T)
    : HighGainObserver(context, {0, 0, 0, context.plant->states() * (context.plant->states() + 4)},
                       std::move(saturation)),
      T_(std::move(T)),
      gain_(scaled_gain(ell, K, plant())) {
  require(gain_.size() == n(), "K: as many entries as the plant has states");
  require(T_ && T_->size() == n(), "T: as many entries as the plant has states");
  listed().add("ell", ell).add("K", K.transpose()).add("T", Eigen::MatrixXd());
  build_flow();
  check_start();
}

void OriginalHighGainObserver::differentiate(const double* x, const double* u, double* J,
                                             double* scratch) const {
  double* point = scratch;
  double* above = scratch + n();
  double* below = scratch + 2 * n();
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
  double* correction = workspace;
  double* J = workspace + n();
  double* scratch = J + n() * n();
  std::copy_n(s, n(), scratch);
  saturation().apply(scratch);
  PlantObserver::derivative(held, scratch, ds, workspace);
  if (held.y_c == nullptr) return;
  double innovation = 0.0;
  compute_innovation(plant(), held.mode, 0, held.y_c, s, held.u, &innovation);
  for (Eigen::Index i = 0; i < n(); ++i) correction[i] = gain_(i) * innovation;
  differentiate(s, held.u, J, scratch);
  solve_in_place(J, correction, n());
  for (Eigen::Index i = 0; i < n(); ++i) ds[i] += correction[i];
}

}  // namespace sampled_data_observers

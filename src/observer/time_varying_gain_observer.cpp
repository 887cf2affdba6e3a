#include "observer/time_varying_gain_observer.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "linear_algebra/definite_matrix.h"
#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {
namespace {

void check_linear(const Plant& plant) {
  if (plant.switches()) {
    throw std::invalid_argument("this observer takes plants of one mode");
  }
  const PlantMode& mode = plant.modes().front();
  if (mode.flow->affine() == nullptr) {
    throw std::invalid_argument("this observer takes plants with a linear flow, x' = A x + B u");
  }
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    if (mode.outputs[i]->affine() == nullptr) {
      throw std::invalid_argument("sensor '" + plant.sensors()[i].name +
                                  "': this observer takes linear outputs, y = C x");
    }
  }
}

}  // namespace

TimeVaryingGainObserver::Gains TimeVaryingGainObserver::make_gains(
    const Plant& plant, const std::optional<Eigen::MatrixXd>& P, double lambda) {
  check_linear(plant);
  if (!(lambda >= 0.0 && lambda < 1.0)) {
    throw std::invalid_argument("lambda must be in [0, 1)");
  }
  std::optional<Eigen::MatrixXd> checked;
  if (P) checked = checked_positive_definite("P", *P, plant.states());
  Gains gains;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Eigen::MatrixXd& C = plant.modes().front().outputs[i]->affine()->M();
    try {
      if (checked) {
        gains.push_back(std::make_unique<const CertificateGain>(C, *checked, lambda));
      } else {
        gains.push_back(std::make_unique<const InverseOutputGain>(C, lambda));
      }
    } catch (const std::invalid_argument& fault) {
      throw std::invalid_argument("sensor '" + plant.sensors()[i].name + "': " + fault.what());
    }
  }
  return gains;
}

Eigen::Index TimeVaryingGainObserver::largest_workspace(const Gains& gains) {
  Eigen::Index largest = 0;
  for (const auto& gain : gains) largest = std::max(largest, gain->workspace_size());
  return largest;
}

TimeVaryingGainObserver::TimeVaryingGainObserver(const ObserverContext& context,
                                                 const std::optional<Eigen::MatrixXd>& P,
                                                 double lambda)
    : TimeVaryingGainObserver(context, make_gains(*context.plant, P, lambda)) {
  if (P) listed_.add("P", (*P + P->transpose()) / 2.0);  // as CertificateGain has it
  listed_.add("lambda", lambda);
}

TimeVaryingGainObserver::TimeVaryingGainObserver(const ObserverContext& context, Gains gains)
    : PlantObserver(context, {SensorTiming::kSampled}),
      gains_(std::move(gains)),
      backward_flow_(-plant().modes().front().flow->affine()->M(), Eigen::MatrixXd::Zero(n(), 0)) {
  build_flow();
}

void TimeVaryingGainObserver::sample(std::size_t sensor, const double* y, const Held& held,
                                     double* state, double* workspace) const {
  double* backward = backward_.of(workspace);
  double* K = K_.of(workspace);
  double* innovation = innovation_.of(workspace);
  const auto tau = static_cast<Duration>(tau_.of(state));
  backward_flow_.transition(tau, backward, column_.of(workspace));
  gains_[sensor]->evaluate(backward, K, of_gain_.of(workspace));
  compute_innovation(plant(), held.mode, sensor, y, state, held.u, innovation);
  add_product(K, n(), plant().sensors()[sensor].outputs(), innovation, state);
  tau_.restart(state);
}

}  // namespace sampled_data_observers

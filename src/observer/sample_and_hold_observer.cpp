#include "observer/sample_and_hold_observer.h"

namespace sampled_data_observers {
namespace {

std::vector<IntersampleGains> held_innovation(const std::vector<Eigen::MatrixXd>& L) {
  std::vector<IntersampleGains> gains;
  for (const Eigen::MatrixXd& gain : L) {
    gains.push_back({-gain, Eigen::MatrixXd::Zero(gain.cols(), gain.cols()),
                     Eigen::VectorXd::Zero(gain.cols())});
  }
  return gains;
}

}  // namespace

SampleAndHoldObserver::SampleAndHoldObserver(const ObserverContext& context,
                                             const std::vector<Eigen::MatrixXd>& L)
    : IntersampleInjectionObserver(context, held_innovation(L)) {}

LawGains SampleAndHoldObserver::gains() const {
  LawGains all;
  for (const LawGain& gain : IntersampleInjectionObserver::gains().all) {
    if (is_named(gain.name, "L")) all.add(gain.name, -gain.value);
  }
  return all;
}

}  // namespace sampled_data_observers

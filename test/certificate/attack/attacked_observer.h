#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "certificate/disturbed_flow.h"
#include "certificate/state_shares.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers::test {

/// Plant and observer at one instant.
struct Attacked {
  Eigen::VectorXd x;
  Eigen::VectorXd law_state;
};

/// A plant that an observer with a guaranteed bound watches, played step by step by whoever attacks
/// the bound. What is played must lie within the assumptions. Everything starts from x = 0.
class AttackedObserver {
 public:
  AttackedObserver(const ObserverConfig& config, Eigen::MatrixXd N)
      : law_(*config.law),
        plant_(*config.plant),
        shares_(law_),
        flow_(plant_, std::move(N), plant_.integration().step) {
    workspace_.resize(law_.workspace_size());
    for (std::size_t i = 0; i < plant_.sensors().size(); ++i) {
      const SensorTiming timing = plant_.sensors()[i].timing;
      if (timing == SensorTiming::kContinuous) continue;
      sensor_ = i;
      samples_ = timing == SensorTiming::kSampled;
    }
    output_ = plant_.modes().front().outputs[sensor_]->affine();
  }

  const Plant& plant() const { return plant_; }
  const Eigen::MatrixXd& C() const { return output_->M(); }

  /// The estimate begins with this error x − x̂.
  Attacked begin(const Eigen::VectorXd& error) const {
    Attacked result{Eigen::VectorXd::Zero(plant_.states()), Eigen::VectorXd(law_.state_size())};
    law_.initialize(result.law_state.data());
    const Eigen::VectorXd estimate = result.x - error;
    law_.observer().start_from(estimate.data(), result.law_state.data());
    return result;
  }

  void flow(Duration duration, const Eigen::VectorXd& w, Attacked& at) {
    flow_.apply(0, w, duration, at.x);
    law_.flow(duration, at.law_state.data(), workspace_.data());
  }

  /// A sample, or a jump where the plant is measured at jumps, with this noise.
  void event(const Eigen::VectorXd& noise, Attacked& at) {
    const Eigen::VectorXd y = C() * at.x + output_->c() + noise;
    if (samples_) {
      reset({0, EventKind::kSample, static_cast<int>(sensor_), y.data(), y.size(), 0}, at);
      return;
    }
    const AffineMap& jump = *plant_.modes().front().jump->affine();
    at.x = (jump.M() * at.x + jump.c()).eval();
    reset({0, EventKind::kJump, 0, y.data(), y.size(), 0}, at);
  }

  Eigen::VectorXd error(const Attacked& at) const {
    return at.x - at.law_state.head(plant_.states());
  }

  double bound(const Attacked& at) const { return law_.error_bound(at.law_state.data()); }

  const Eigen::VectorXd& state_bounds(const Attacked& at) { return shares_.bounds(at.law_state); }

  /// Whether the attack is on the bounds on each state, instead of that on the norm.
  void attack_states(bool are_attacked) { states_are_attacked_ = are_attacked; }

  /// |x − x̂| over its bound, or the largest of |x_j − x̂_j| over its own, less what double precision
  /// leaves of both; counted as a comparison.
  double compare(const Attacked& at) {
    ++comparisons_;
    const double bound = this->bound(at);
    if (!std::isfinite(bound)) {
      ++without_bound_;
      return 0.0;
    }
    const double rounding = 1e-12 * (at.x.norm() + at.law_state.head(plant_.states()).norm());
    const double share = std::max(0.0, error(at).norm() - rounding) / std::max(bound, 1e-300);
    largest_share_ = std::max(largest_share_, share);
    const double of_states = shares_.largest(at.law_state, error(at), rounding);
    largest_state_share_ = std::max(largest_state_share_, of_states);
    if (comparisons_ % kPerEllipsoid == 0) {
      largest_ellipsoid_share_ = std::max(largest_ellipsoid_share_,
                                          shares_.of_ellipsoid(at.law_state, error(at), rounding));
    }
    return states_are_attacked_ ? of_states : share;
  }

  std::size_t comparisons() const { return comparisons_; }
  std::size_t without_bound() const { return without_bound_; }
  double largest_share() const { return largest_share_; }
  /// Of the bound on a state, and √(eᵀ Q⁻¹ e) of the ellipsoid.
  double largest_state_share() const { return largest_state_share_; }
  double largest_ellipsoid_share() const { return largest_ellipsoid_share_; }

 private:
  /// It is compared with one of so many errors.
  static constexpr std::size_t kPerEllipsoid = 8;

  void reset(const Event& event, Attacked& at) {
    static_cast<void>(law_.reset(event, at.law_state.data(), workspace_.data()));
  }

  const ObserverLaw& law_;
  const Plant& plant_;
  StateShares shares_;
  DisturbedFlow flow_;
  Eigen::VectorXd workspace_;
  std::size_t sensor_ = 0;
  bool samples_ = true;
  const AffineMap* output_ = nullptr;
  std::size_t comparisons_ = 0;
  std::size_t without_bound_ = 0;
  double largest_share_ = 0.0;
  double largest_state_share_ = 0.0;
  double largest_ellipsoid_share_ = 0.0;
  bool states_are_attacked_ = false;
};

}  // namespace sampled_data_observers::test

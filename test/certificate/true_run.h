#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/plant/linear_flow.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers::test {

constexpr Stamp kRunStart = 1'600'000'000'000'000'000;

/// A true affine plant of one mode, beside its observer: what happens to it is told to the observer
/// later, or never, and every estimate that is given out is compared with it.
class TrueRun {
 public:
  /// @param N  n x n_w, where a disturbance enters
  TrueRun(const ObserverConfig& config, const Eigen::VectorXd& initial_error,
          const Eigen::MatrixXd& N = {})
      : config_(config),
        plant_(*config.plant),
        flow_(flow_of(plant_, N)),
        estimator_(config.law, config.options),
        estimate_(estimator_.make_estimate()),
        held_(Eigen::VectorXd::Zero(plant_.inputs() + 1 + N.cols())) {
    held_(plant_.inputs()) = 1.0;
    config.law->initialize(estimate_.state.data());
    x_ = estimate_.state.head(plant_.states()) + initial_error;
    history_.push_back({kRunStart, x_, held_});
    estimator_.restart(kRunStart);
  }

  // What happens at `seconds` after the start, not before what happened last; it is told so many
  // seconds later.
  void input(double seconds, double value, double later) {
    go_to(seconds);
    held_(0) = value;
    happen({EventKind::kInput, 0, {value}}, later);
  }
  /// From then on.
  void disturb(double seconds, const Eigen::VectorXd& w) {
    go_to(seconds);
    held_.tail(w.size()) = w;
    history_.push_back({stamp_of(now_), x_, held_});
  }
  void sample(double seconds, double noise = 0.0) {
    go_to(seconds);
    const AffineMap& output = *plant_.modes().front().outputs.front()->affine();
    happen({EventKind::kSample, 0, {(output.M() * x_ + output.c())(0) + noise}}, 0.0);
  }
  /// A jump with its outputs, told with a stamp that is so much later [s].
  /// @param noise  of the first output
  void jump(double seconds, double later, double stamp_error = 0.0, double noise = 0.0) {
    go_to(seconds);
    const Eigen::VectorXd y = plant_.modes().front().outputs.front()->affine()->M() * x_;
    std::vector<double> values(y.data(), y.data() + y.size());
    values.front() += noise;
    const AffineMap& map = *plant_.modes().front().jump->affine();
    x_ = Eigen::VectorXd(map.M() * x_ + map.c());
    happen({EventKind::kJump, 0, values}, later, stamp_error);
  }
  /// A jump whose output does not come.
  void unmeasured_jump(double seconds, double later, double stamp_error) {
    go_to(seconds);
    const AffineMap& map = *plant_.modes().front().jump->affine();
    x_ = Eigen::VectorXd(map.M() * x_ + map.c());
    happen({EventKind::kJump, 0, {}}, later, stamp_error);
  }
  /// A jump that is told by itself, and outputs of some sensors, behind it.
  void jump_in_parts(double seconds, double later, const std::vector<int>& sensors) {
    go_to(seconds);
    const Eigen::VectorXd before = x_;
    unmeasured_jump(seconds, later, 0.0);
    for (const int sensor : sensors) {
      const auto& output = plant_.modes().front().outputs[static_cast<std::size_t>(sensor)];
      const Eigen::VectorXd y = output->affine()->M() * before;
      happen({EventKind::kJumpOutput, sensor, {y.data(), y.data() + y.size()}}, later);
    }
  }
  /// Told, although the plant did not jump.
  void false_jump(double seconds) {
    go_to(seconds);
    const double y = (plant_.modes().front().outputs.front()->affine()->M() * x_)(0);
    happen({EventKind::kJump, 0, {y}}, 0.0);
  }

  /// Tells all that is due at `seconds`.
  void tell(double seconds) {
    const Stamp now = stamp_of(seconds);
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const Told& a, const Told& b) { return a.arrival < b.arrival; });
    while (!waiting_.empty() && waiting_.front().arrival <= now) {
      const Told told = waiting_.front();
      waiting_.erase(waiting_.begin());
      reports_.push_back(
          estimator_.submit({told.stamp, told.what.kind, told.what.sensor, told.what.values.data(),
                             static_cast<Eigen::Index>(told.what.values.size()), 0},
                            told.arrival));
    }
  }

  struct Comparison {
    PublishedBound bound;
    double error = 0.0;
    bool entries_hold = false;  ///< the bounds on them, which are infinite where that one is
    bool holds() const { return error <= bound.value && entries_hold; }
  };
  /// The estimate of `seconds` as it is given out at `now`.
  Comparison compare(double seconds, double now) {
    EXPECT_EQ(Timeline::Query::kOk, estimator_.estimate_at(stamp_of(seconds), estimate_));
    Comparison result;
    result.bound = estimator_.bound(estimate_, stamp_of(now));
    const Eigen::VectorXd error = truth(stamp_of(seconds)) - estimate_.state.head(plant_.states());
    Eigen::VectorXd bounds(error.size());
    estimator_.state_bounds(estimate_, stamp_of(now), bounds);
    result.error = error.norm();
    const bool are_finite = std::isfinite(result.bound.value);
    result.entries_hold = (error.cwiseAbs().array() <= bounds.array()).all() &&
                          (are_finite ? bounds.allFinite() : std::isinf(bounds.minCoeff()));
    return result;
  }
  Comparison compare(double seconds) { return compare(seconds, seconds); }

  Estimator& estimator() { return estimator_; }
  const std::vector<EventReport>& reports() const { return reports_; }
  static Stamp stamp_of(double seconds) { return kRunStart + from_seconds(seconds); }

 private:
  struct What {
    EventKind kind;
    int sensor;
    std::vector<double> values;
  };
  struct Told {
    Stamp arrival;
    Stamp stamp;
    What what;
  };
  struct Knot {
    Stamp stamp;
    Eigen::VectorXd x;
    Eigen::VectorXd held;
  };

  static LinearFlow flow_of(const Plant& plant, const Eigen::MatrixXd& N) {
    const AffineMap& map = *plant.modes().front().flow->affine();
    Eigen::MatrixXd B(plant.states(), plant.inputs() + 1 + N.cols());
    B.leftCols(plant.inputs()) = map.N();
    B.col(plant.inputs()) = map.c();
    if (N.cols() > 0) B.rightCols(N.cols()) = N;
    return LinearFlow(map.M(), B);
  }
  Eigen::VectorXd flowed(const Knot& from, Stamp stamp) const {
    Eigen::VectorXd x = from.x;
    Eigen::VectorXd scratch(x.size());
    flow_.apply(stamp - from.stamp, x.data(), from.held.data(), scratch.data());
    return x;
  }
  void go_to(double seconds) {
    x_ = flowed(history_.back(), stamp_of(seconds));
    now_ = seconds;
  }
  void happen(const What& what, double later, double stamp_error = 0.0) {
    history_.push_back({stamp_of(now_), x_, held_});
    waiting_.push_back({stamp_of(now_ + later), stamp_of(now_) + from_seconds(stamp_error), what});
  }
  Eigen::VectorXd truth(Stamp stamp) const {
    std::size_t i = history_.size() - 1;
    while (history_[i].stamp > stamp) --i;
    return flowed(history_[i], stamp);
  }

  const ObserverConfig& config_;
  const Plant& plant_;
  LinearFlow flow_;
  Estimator estimator_;
  Estimate estimate_;
  Eigen::VectorXd held_;
  Eigen::VectorXd x_;
  double now_ = 0.0;
  std::vector<Knot> history_;
  std::vector<Told> waiting_;
  std::vector<EventReport> reports_;
};

}  // namespace sampled_data_observers::test

#include "textbook_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers::test {
namespace {

constexpr Stamp kStart = 1'600'000'000'000'000'000;
constexpr int kSamples = 1200;
constexpr int kParts = 4;      // between two samples
constexpr int kIntervals = 9;  // that come
constexpr int kSamplesPerMove = 30;

Eigen::MatrixXd exponential_with(const Eigen::MatrixXd& A, const Eigen::MatrixXd& inputs,
                                 double duration) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(A.rows() + inputs.cols(), A.rows() + inputs.cols());
  all.topLeftCorner(A.rows(), A.rows()) = A;
  all.topRightCorner(A.rows(), inputs.cols()) = inputs;
  return exponential_of(all * duration);
}

/// A state feedback that keeps the plant where it is, by the Riccati equation of samples each T2.
Eigen::RowVectorXd holding_feedback(const TextbookPlant& plant) {
  constexpr int kIterations = 2000;
  const Eigen::Index n = plant.A.rows();
  const Eigen::MatrixXd flow = exponential_with(plant.A, plant.B, plant.T2);
  const Eigen::MatrixXd A = flow.topLeftCorner(n, n);
  const Eigen::VectorXd B = flow.topRightCorner(n, 1);
  // The input moves the outputs by about 1 within kSamplesPerMove samples.
  const double shown =
      (plant.C *
       exponential_with(plant.A, plant.B, kSamplesPerMove * plant.T2).topRightCorner(n, 1))
          .norm();
  const Eigen::MatrixXd Q = plant.C.transpose() * plant.C / (shown * shown);
  Eigen::MatrixXd P = Q;
  Eigen::RowVectorXd K;
  for (int i = 0; i < kIterations; ++i) {
    K = (B.transpose() * P * A) / (1.0 + B.dot(P * B));
    P = (A.transpose() * P * (A - B * K) + Q).eval();
  }
  return K;
}

class TextbookRun {
 public:
  TextbookRun(const TextbookPlant& plant, const ObserverConfig& observer, const Eigen::MatrixXd& N,
              double disturbance, Signals signals)
      : plant_(plant),
        N_(N),
        disturbance_(disturbance),
        signals_(signals),
        inputs_(plant.A.rows(), 1 + N.cols()),
        estimator_(observer.law, observer.options),
        estimate_(estimator_.make_estimate()) {
    inputs_ << plant.B, N;
  }

  Seen go() {
    const Eigen::Index n = plant_.A.rows();
    state_ = direction(n) * (10.0 * plant_.noise);
    Eigen::VectorXd copy = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd held = Eigen::VectorXd::Zero(plant_.C.rows());
    const Eigen::RowVectorXd K = holding_feedback(plant_);
    for (int k = 0; k < kSamples; ++k) {
      const double u = (k / kSamplesPerMove % 2 == 0 ? 1.0 : -1.0) - K.dot(state_);
      submit(EventKind::kInput, Eigen::VectorXd::Constant(1, u));
      Eigen::VectorXd inputs(1 + N_.cols());
      inputs << u, signal(N_.cols(), disturbance_, k / 7);
      Eigen::VectorXd known = Eigen::VectorXd::Zero(inputs.size());
      known(0) = u;
      const Duration part = next_part(k);
      for (int i = 0; i < kParts; ++i) {
        const Eigen::MatrixXd& flow = flow_over(part);
        state_ =
            (flow.topLeftCorner(n, n) * state_ + flow.topRightCorner(n, inputs.size()) * inputs)
                .eval();
        copy = (flow.topLeftCorner(n, n) * copy + flow.topRightCorner(n, inputs.size()) * known)
                   .eval();
        stamp_ += part;
        look(copy, held, k);
      }
      held = plant_.C * state_ + signal(plant_.C.rows(), plant_.noise, k);
      submit(EventKind::kSample, held);
      look(copy, held, k);
    }
    for (double* square : {&seen_.estimated, &seen_.held, &seen_.open_loop}) {
      *square = std::sqrt(*square / looks_);
    }
    return seen_;
  }

 private:
  void submit(EventKind kind, const Eigen::VectorXd& values) {
    Event event;
    event.stamp = stamp_;
    event.kind = kind;
    event.values = values.data();
    event.size = values.size();
    estimator_.submit(event, stamp_);
  }

  Duration next_part(int k) {
    int choice = std::uniform_int_distribution<int>(0, kIntervals - 1)(random_);
    if (signals_ == Signals::kConstant) choice = k % 400 < 200 ? 0 : kIntervals - 1;
    const double interval =
        plant_.T1 + (plant_.T2 - plant_.T1) * choice / static_cast<double>(kIntervals - 1);
    // Inside [T1, T2], whole parts or not.
    const auto nanoseconds = static_cast<Duration>(std::llround(1e9 * interval));
    return choice == 0 ? (nanoseconds + kParts - 1) / kParts : nanoseconds / kParts;
  }

  const Eigen::MatrixXd& flow_over(Duration part) {
    Eigen::MatrixXd& flow = flows_[part];
    if (flow.size() == 0) {
      flow = exponential_with(plant_.A, inputs_, 1e-9 * static_cast<double>(part));
    }
    return flow;
  }

  Eigen::VectorXd direction(Eigen::Index size) {
    std::normal_distribution<double> normal;
    const Eigen::VectorXd any = Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random_); });
    return any.normalized();
  }

  Eigen::VectorXd signal(Eigen::Index size, double bound, int step) {
    if (signals_ == Signals::kRandom) return direction(size) * bound;
    const double sign = signals_ == Signals::kConstant || (step / 20) % 2 == 0 ? 1.0 : -1.0;
    return Eigen::VectorXd::Constant(size, sign * bound / std::sqrt(static_cast<double>(size)));
  }

  void look(const Eigen::VectorXd& copy, const Eigen::VectorXd& held, int k) {
    estimator_.estimate_at(stamp_, estimate_);
    const double bound = estimator_.bound(estimate_, stamp_).value;
    EXPECT_TRUE(std::isfinite(bound));
    const Eigen::VectorXd error = state_ - estimate_.state.head(state_.size());
    seen_.largest_share = std::max(seen_.largest_share, error.norm() / bound);
    if (k < kSamples / 2) return;
    seen_.worst_error = std::max(seen_.worst_error, error.norm());
    seen_.largest_bound = std::max(seen_.largest_bound, bound);
    const Eigen::VectorXd y = plant_.C * state_;
    seen_.estimated += (plant_.C * error).squaredNorm();
    seen_.held += (y - held).squaredNorm();
    seen_.open_loop += (y - plant_.C * copy).squaredNorm();
    ++looks_;
  }

  const TextbookPlant& plant_;
  Eigen::MatrixXd N_;
  double disturbance_;
  Signals signals_;
  Eigen::MatrixXd inputs_;
  Estimator estimator_;
  Estimate estimate_;
  std::mt19937 random_{5};
  std::map<Duration, Eigen::MatrixXd> flows_;
  Eigen::VectorXd state_;
  Stamp stamp_ = kStart;
  Seen seen_;
  int looks_ = 0;
};

}  // namespace

Seen run_textbook_plant(const TextbookPlant& plant, const ObserverConfig& observer,
                        const Eigen::MatrixXd& N, double disturbance, Signals signals) {
  return TextbookRun(plant, observer, N, disturbance, signals).go();
}

}  // namespace sampled_data_observers::test

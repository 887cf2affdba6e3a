// The numbers of a bound by a Lyapunov function that depends on timers, where rounding would make
// them too small: against sums in long double.
#include "certificate/timer_dependent_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "certificate/timer_dependent_conditions.h"

namespace sampled_data_observers::test {
namespace {

/// e of n entries with one output, a gain K, and the same P at all nodes.
class TimerDependentBoundTest : public ::testing::Test {
 protected:
  void set(const Eigen::MatrixXd& P, const Eigen::MatrixXd& C, const Eigen::MatrixXd& K) {
    const Eigen::Index n = P.rows();
    system_.states = n;
    system_.size = n;
    system_.F = {MatrixExpression(Eigen::MatrixXd(-Eigen::MatrixXd::Identity(n, n)))};
    system_.G.resize(n, 0);
    system_.S.resize(0, n);
    system_.N = Eigen::MatrixXd::Identity(n, 1);
    system_.C_p.resize(0, n);
    ErrorReset reset;
    reset.name = "output";
    reset.J = Eigen::MatrixXd::Identity(n, n);
    reset.C = C;
    reset.K = [K](std::size_t) { return MatrixExpression(K); };
    system_.resets = {reset};
    values_ = {{"P/0", P},
               {"P/1", P},
               {"P/2", P},
               {"lambda_t", scalar_matrix(1e-3)},
               {"gamma", scalar_matrix(1.0)},
               {"nu/output", scalar_matrix(1.0)}};
  }

  std::vector<double> begun(const ErrorAssumptions& assumptions) {
    bound_ = std::make_unique<TimerDependentBound>(
        TimerDependentFunction(system_, TensorGrid({{0.0, 0.5, 1.0}}), {0.5}),
        std::vector<double>{1.0}, values_, assumptions);
    std::vector<double> state(static_cast<std::size_t>(bound_->state_size()));
    bound_->initialize(state.data());
    return state;
  }

  ErrorSystem system_;
  NamedMatrices values_;
  std::unique_ptr<TimerDependentBound> bound_;
};

TEST_F(TimerDependentBoundTest, KeepsAllOfWhatIsPushedInAShortTime) {
  set(Eigen::MatrixXd::Identity(1, 1), Eigen::MatrixXd::Ones(1, 1),
      Eigen::MatrixXd::Constant(1, 1, 0.5));
  ErrorAssumptions assumptions;
  assumptions.disturbance = 1.0;
  for (int i = 1; i <= 2000; ++i) {
    std::vector<double> state = begun(assumptions);
    const double duration = 6e-6 + 1e-9 * i;
    bound_->flow(duration, state.data());
    const long double rate = 2e-3L;
    const long double exact =
        std::sqrt(-std::expm1(-rate * static_cast<long double>(duration)) / rate);
    ASSERT_GE(bound_->bound(state.data()), exact) << duration;
    ASSERT_LE(bound_->bound(state.data()), exact * 1.0001L) << duration;
  }
}

TEST_F(TimerDependentBoundTest, KnowsWhatNoiseDoesThatAnIllConditionedPHides) {
  ErrorAssumptions assumptions;
  assumptions.noise = 1.0;
  for (int i = 1; i <= 200; ++i) {
    const double angle = 0.007 * i;
    Eigen::MatrixXd Q(2, 2);
    Q << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    Eigen::MatrixXd P = Q * Eigen::Vector2d(1.0, 1e-11).asDiagonal() * Q.transpose();
    P(1, 0) = P(0, 1);
    const Eigen::MatrixXd K = Q.col(1);
    set(P, Eigen::MatrixXd::Identity(1, 2), K);
    std::vector<double> state = begun(assumptions);
    // Sooner than T1: nothing but what noise does remains.
    bound_->flow(0.25, state.data());
    bound_->sample(0, state.data(), nullptr);
    long double form = 0.0L;
    for (Eigen::Index a = 0; a < 2; ++a) {
      for (Eigen::Index b = 0; b < 2; ++b) {
        form += static_cast<long double>(K(a, 0)) * P(a, b) * K(b, 0);
      }
    }
    ASSERT_GE(static_cast<long double>(state.front()), form) << angle;
  }
}

}  // namespace
}  // namespace sampled_data_observers::test

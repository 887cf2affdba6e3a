// Times between samples of two sensors at which they show less together than the flow.
#include "design/pathological_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

const double kHalfTurn = std::acos(-1.0);
constexpr double kAnyTime = std::numeric_limits<double>::infinity();

Eigen::MatrixXd one_oscillator(double omega) {
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, -omega * omega, 0;
  return A;
}

Eigen::MatrixXd two_oscillators(double first, double second) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
  A.topLeftCorner(2, 2) = one_oscillator(first);
  A.bottomRightCorner(2, 2) = one_oscillator(second);
  return A;
}

Eigen::MatrixXd output(std::initializer_list<double> values) {
  return Eigen::RowVectorXd(Eigen::Map<const Eigen::RowVectorXd>(
      values.begin(), static_cast<Eigen::Index>(values.size())));
}

/// The least singular value of what both sensors show, each every tau, over when the second begins.
double least_shown(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C1, double tau1,
                   const Eigen::MatrixXd& C2, double tau2) {
  constexpr int kSamples = 8;
  constexpr int kOffsets = 40;
  double least = kAnyTime;
  for (int offset = 0; offset < kOffsets; ++offset) {
    Eigen::MatrixXd shown(2 * kSamples, A.cols());
    for (int k = 0; k < kSamples; ++k) {
      shown.row(2 * k) = C1 * exponential_of(A * (k * tau1));
      shown.row(2 * k + 1) = C2 * exponential_of(A * (k * tau2 + tau2 * offset / kOffsets));
    }
    least = std::min(least, singular_values(shown).minCoeff());
  }
  return least;
}

TEST(PathologicalTimes, OfPositionAndVelocityOfAnOscillatorAreHalfPeriods) {
  const Eigen::MatrixXd A = one_oscillator(2.0);
  const Eigen::MatrixXd position = output({1, 0});
  const Eigen::MatrixXd velocity = output({0, 1});
  const auto found =
      pathological_times_of_sensors(A, {{position, {0.5, 2.0}}, {velocity, {2.0, 4.0}}});
  ASSERT_EQ(1u, found.size());
  EXPECT_NEAR(kHalfTurn / 2, *found[0].tau[0], 1e-9);
  EXPECT_NEAR(kHalfTurn, *found[0].tau[1], 1e-9);
  EXPECT_FALSE(found[0].decays);
  EXPECT_LT(least_shown(A, position, kHalfTurn / 2, velocity, kHalfTurn), 1e-12);
  EXPECT_GT(least_shown(A, position, kHalfTurn / 2, velocity, kHalfTurn - 0.2), 0.1);
  EXPECT_GT(least_shown(A, position, kHalfTurn / 2 - 0.2, velocity, kHalfTurn), 0.1);
  EXPECT_TRUE(
      pathological_times_of_sensors(A, {{position, {0.5, 2.0}}, {velocity, {1.6, 3.1}}}).empty());
  // Measured together, they show the state at once.
  EXPECT_TRUE(pathological_times_of_sensors(A, {{Eigen::MatrixXd::Identity(2, 2), {0.0, kAnyTime}},
                                                {velocity, {0.0, kAnyTime}}})
                  .empty());
}

TEST(PathologicalTimes, ASensorThatShowsNoneOfTheModesDoesNotMatter) {
  const auto found = pathological_times_of_sensors(
      two_oscillators(1.0, 10.0),
      {{output({1, 0, 0, 0}), {3.0, 3.2}}, {output({0, 0, 1, 0}), {0.01, 0.02}}});
  ASSERT_EQ(1u, found.size());
  EXPECT_NEAR(kHalfTurn, *found[0].tau[0], 1e-9);
  EXPECT_FALSE(found[0].tau[1]);
  EXPECT_LT(found[0].directions.bottomRows(2).norm(), 1e-9);
}

TEST(PathologicalTimes, SensorsThatWeighTwoModesDifferentlyTellThemApart) {
  const Eigen::MatrixXd A = two_oscillators(1.0, std::sqrt(2.0));
  const Eigen::MatrixXd sum = output({1, 0, 1, 0});
  const double beat = 2.0 * kHalfTurn / (std::sqrt(2.0) - 1.0);  // 15.17 s, of neither half period
  const SamplingTimes times{15.1, 15.2};
  const auto same = pathological_times_of_sensors(A, {{sum, times}, {2.0 * sum, times}});
  ASSERT_EQ(1u, same.size());
  EXPECT_NEAR(beat, *same[0].tau[0], 1e-9);
  EXPECT_LT(least_shown(A, sum, beat, 2.0 * sum, beat), 1e-9);
  const Eigen::MatrixXd other = output({1, 0, 3, 0});
  EXPECT_TRUE(pathological_times_of_sensors(A, {{sum, times}, {other, times}}).empty());
  EXPECT_GT(least_shown(A, sum, beat, other, beat), 0.1);
}

TEST(PathologicalTimes, OfModesThatDecayDecay) {
  Eigen::MatrixXd A(2, 2);
  A << -0.1, 1, -4, -0.1;
  const auto found = pathological_times_of_sensors(
      A, {{output({1, 0}), {0.0, kAnyTime}}, {output({1, 1}), {0.0, kAnyTime}}});
  ASSERT_EQ(1u, found.size());
  EXPECT_TRUE(found[0].decays);
  EXPECT_NEAR(kHalfTurn / 2, *found[0].tau[0], 1e-9);
}

}  // namespace
}  // namespace sampled_data_observers

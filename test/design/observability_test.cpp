// Observability against closed forms.
#include "design/observability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

const double kPi = std::acos(-1.0);

Eigen::MatrixXd filled(Eigen::Index rows, Eigen::Index cols, std::initializer_list<double> values) {
  Eigen::MatrixXd result(rows, cols);
  Eigen::Index i = 0;
  for (const double value : values) {
    result(i / cols, i % cols) = value;
    ++i;
  }
  return result;
}

Eigen::MatrixXd undamped(double omega) { return filled(2, 2, {0, 1, -omega * omega, 0}); }

/// sferlazza2019 (66)
const Eigen::MatrixXd kAircraft = filled(3, 3, {-0.02, -1.4, 9.8, -0.01, -0.4, 0, 0, 1, 0});
const Eigen::MatrixXd kAircraftOutput = filled(1, 3, {1, 0, 1});

/// A change of coordinates that is no rotation.
const Eigen::MatrixXd kChange = filled(4, 4, {1, 2, 0, -1, 0, 1, 3, 0, 2, 0, 1, 1, -1, 1, 0, 2});

TEST(PathologicalIntervals, OfAnOscillatorAreTheHalfPeriods) {
  const double omega = 2.0;
  const auto found = pathological_intervals(undamped(omega), filled(1, 2, {1, 0}), 5.0);
  ASSERT_EQ(found.size(), 3u);  // pi / 2, pi, 3 pi / 2
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k].tau, static_cast<double>(k + 1) * kPi / omega, 1e-12);
    EXPECT_FALSE(found[k].decays);
    // Position is sampled; the velocity is what it does not show.
    EXPECT_NEAR(std::abs(found[k].directions(1, 0)), 1.0, 1e-9);
    EXPECT_NEAR(sampled_observability(undamped(omega), filled(1, 2, {1, 0}), found[k].tau), 0.0,
                1e-12);
  }
}

TEST(PathologicalIntervals, DoNotExistWhereAllStatesAreMeasured) {
  EXPECT_TRUE(pathological_intervals(undamped(2.0), Eigen::MatrixXd::Identity(2, 2), 50).empty());
}

TEST(PathologicalIntervals, DoNotExistForRealEigenvalues) {
  EXPECT_TRUE(
      pathological_intervals(filled(2, 2, {0, 1, 0, 0}), filled(1, 2, {1, 0}), 1e3).empty());
  EXPECT_EQ(longest_beat(filled(2, 2, {0, 1, 0, 0})), 0.0);
}

TEST(PathologicalIntervals, OfTwoOscillatorsAreAlsoTheirBeats) {
  // Frequencies 1 and 3 with the same decay: differences 2, 4, 2 and 6 of the eigenvalues.
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
  A.topLeftCorner(2, 2) = filled(2, 2, {-1, 1, -1, -1});
  A.bottomRightCorner(2, 2) = filled(2, 2, {-1, 3, -3, -1});
  const Eigen::MatrixXd C = filled(1, 4, {1, 0, 1, 0});
  const Eigen::MatrixXd T = kChange;
  const auto found = pathological_intervals(T * A * inverse_of(T), C * inverse_of(T), 3.2);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_NEAR(found[0].tau, kPi / 3.0, 1e-9);
  EXPECT_NEAR(found[1].tau, kPi / 2.0, 1e-9);
  EXPECT_NEAR(found[2].tau, 2.0 * kPi / 3.0, 1e-9);
  EXPECT_NEAR(found[3].tau, kPi, 1e-9);
  for (const PathologicalInterval& interval : found) EXPECT_TRUE(interval.decays);
  EXPECT_NEAR(longest_beat(A), kPi, 1e-9);
}

TEST(PathologicalIntervals, OfTheAircraftBeginAt8541AndNotAt3425) {
  // The paper's text says 3.425, which does not follow from (66).
  const auto found = pathological_intervals(kAircraft, kAircraftOutput, 9.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].tau, 8.541, 1e-3);
  EXPECT_NEAR(found[0].tau, kPi / 0.36782, 1e-4);
  EXPECT_FALSE(found[0].decays);
  EXPECT_LT(sampled_observability(kAircraft, kAircraftOutput, found[0].tau), 1e-9);
  EXPECT_GT(sampled_observability(kAircraft, kAircraftOutput, 3.425), 1e-3);
}

TEST(Modes, OfTheAircraftAreThosePrinted) {
  const std::vector<Mode> modes = modes_of(kAircraft);
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_NEAR(modes[0].eigenvalue.real(), 0.118, 1e-3);
  EXPECT_NEAR(modes[0].eigenvalue.imag(), 0.368, 1e-3);
  EXPECT_EQ(modes[0].directions.cols(), 2);
  EXPECT_NEAR(modes[1].eigenvalue.real(), -0.656, 1e-3);
  EXPECT_FALSE(modes[0].decays(TimeDomain::kContinuous));
  EXPECT_TRUE(modes[1].decays(TimeDomain::kContinuous));
}

TEST(Modes, OfATripleIntegratorAreOneInAnyCoordinates) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
  A(0, 1) = A(1, 2) = 1.0;
  A(3, 3) = -5.0;
  const std::vector<Mode> modes = modes_of(kChange * A * inverse_of(kChange));
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_EQ(modes[0].eigenvalue, 0.0);
  EXPECT_EQ(modes[0].directions.cols(), 3);
  EXPECT_FALSE(modes[0].decays(TimeDomain::kContinuous));
}

TEST(UnseenModes, NameTheModeAndWhatItMoves) {
  // The output sees x1 and x2; x3 decays by itself and x4 follows it.
  const Eigen::MatrixXd A = filled(4, 4, {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, -2, 0, 0, 0, 0, -7});
  const Eigen::MatrixXd C = filled(1, 4, {1, 0, 0, 1});
  const std::vector<Mode> unseen = unseen_modes(A, C);
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_NEAR(unseen[0].eigenvalue.real(), -2.0, 1e-12);
  EXPECT_NEAR(std::abs(unseen[0].directions(2, 0)), 1.0, 1e-12);
  EXPECT_TRUE(is_detectable(A, C, TimeDomain::kContinuous));
  EXPECT_FALSE(observability_order(A, C).has_value());
}

TEST(UnseenModes, AreFoundInAnyCoordinatesAndUnits) {
  const Eigen::MatrixXd A = filled(4, 4, {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 3, 1, 0, 0, 0, 3});
  const Eigen::MatrixXd C = filled(1, 4, {1, 0, 0, 1});  // sees the second of the double mode only
  for (const double unit : {1.0, 1e-6, 1e6}) {
    const std::vector<Mode> unseen =
        unseen_modes(kChange * A * inverse_of(kChange), unit * C * inverse_of(kChange));
    ASSERT_EQ(unseen.size(), 1u) << unit;
    EXPECT_NEAR(unseen[0].eigenvalue.real(), 3.0, 1e-6);
    const Eigen::VectorXd expected = kChange.col(2).normalized();
    EXPECT_NEAR(std::abs(expected.dot(unseen[0].directions.col(0))), 1.0, 1e-9);
  }
  EXPECT_FALSE(is_detectable(A, C, TimeDomain::kContinuous));
  EXPECT_NEAR(detectability_margin(A, C, TimeDomain::kContinuous), 0.0, 1e-12);
}

TEST(UnseenModes, AreAllWithoutOutputs) {
  const std::vector<Mode> unseen = unseen_modes(undamped(1.0), Eigen::MatrixXd(0, 2));
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_NEAR(unseen[0].eigenvalue.imag(), 1.0, 1e-12);
  EXPECT_FALSE(is_detectable(undamped(1.0), Eigen::MatrixXd(0, 2), TimeDomain::kContinuous));
}

TEST(Detectability, OnTheEdgeOfStabilityIsNotGiven) {
  EXPECT_FALSE(is_detectable(filled(1, 1, {0}), filled(1, 1, {0}), TimeDomain::kContinuous));
  EXPECT_FALSE(is_detectable(filled(1, 1, {-1}), filled(1, 1, {0}), TimeDomain::kDiscrete));
  EXPECT_TRUE(is_detectable(filled(1, 1, {-1}), filled(1, 1, {0}), TimeDomain::kContinuous));
  EXPECT_TRUE(is_detectable(filled(1, 1, {0}), filled(1, 1, {0}), TimeDomain::kDiscrete));
}

TEST(Detectability, MarginIsTheDistanceOfTheOutputFromZero) {
  // One state that grows: [A - 1; C] = [0; c].
  EXPECT_NEAR(detectability_margin(filled(1, 1, {1}), filled(1, 1, {0.3}), TimeDomain::kContinuous),
              0.3, 1e-12);
  EXPECT_EQ(detectability_margin(filled(1, 1, {-1}), filled(1, 1, {0}), TimeDomain::kContinuous),
            std::numeric_limits<double>::infinity());
}

TEST(ObservabilityOrder, CountsTheDerivativesThatAreNeeded) {
  const Eigen::MatrixXd chain = filled(3, 3, {0, 1, 0, 0, 0, 1, 0, 0, 0});
  EXPECT_EQ(observability_order(chain, filled(1, 3, {1, 0, 0})), 3);
  EXPECT_EQ(observability_order(chain, filled(2, 3, {1, 0, 0, 0, 0, 1})), 2);
  EXPECT_EQ(observability_order(chain, Eigen::MatrixXd::Identity(3, 3)), 1);
  EXPECT_EQ(observability_order(chain, filled(1, 3, {0, 1, 0})), std::nullopt);
}

TEST(PairAtJumps, IsDetectableTogetherWhereFlowAndJumpsAloneAreNot) {
  // bernard2022, example 5.5
  const Eigen::MatrixXd A = filled(3, 3, {0, 1, 0, 0, 0, 0, 0, 0, 0});
  const Eigen::MatrixXd A_d = filled(3, 3, {1, 0, 0, 0, 1, 0, 1, 0, 0});
  const Eigen::MatrixXd C_d = filled(1, 3, {1, 0, 0});
  EXPECT_FALSE(is_detectable(A, C_d, TimeDomain::kContinuous));
  EXPECT_FALSE(is_detectable(A_d, C_d, TimeDomain::kDiscrete));
  for (const double tau : {0.1, 2.0, 5.0}) {
    const DiscretePair pair = pair_at_jumps(A, A_d, C_d, tau);
    EXPECT_TRUE(is_detectable(pair.F, pair.H, TimeDomain::kDiscrete)) << tau;
    EXPECT_GT(detectability_margin(pair.F, pair.H, TimeDomain::kDiscrete), 1e-3);
    EXPECT_NEAR(pair.H(0, 1), tau, 1e-12);
  }
  const DiscretePair at_once = pair_at_jumps(A, A_d, C_d, 0.0);
  EXPECT_FALSE(is_detectable(at_once.F, at_once.H, TimeDomain::kDiscrete));
}

TEST(SampledObservability, IsThatOfTheObservabilityMatrix) {
  // Position and velocity from two positions tau apart: [1 0; 1 tau].
  const double tau = 0.5;
  const double expected = singular_values(filled(2, 2, {1, 0, 1, tau}))(1);
  EXPECT_NEAR(sampled_observability(filled(2, 2, {0, 1, 0, 0}), filled(1, 2, {1, 0}), tau),
              expected, 1e-14);
  // A state that nothing shows does not count.
  EXPECT_NEAR(sampled_observability(filled(3, 3, {0, 1, 0, 0, 0, 0, 0, 0, -1}),
                                    filled(1, 3, {1, 0, 0}), tau),
              singular_values(filled(3, 2, {1, 0, 1, tau, 1, 2 * tau}))(1), 1e-14);
}

}  // namespace
}  // namespace sampled_data_observers

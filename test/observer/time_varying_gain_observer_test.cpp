#include "observer/time_varying_gain_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "plant/linear_plant.h"
#include "plant/lipschitz_map.h"
#include "support/allocation_counter.h"
#include "support/matrix_functions.h"

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd rows(std::initializer_list<std::initializer_list<double>> values) {
  Eigen::MatrixXd M(static_cast<Eigen::Index>(values.size()),
                    static_cast<Eigen::Index>(values.begin()->size()));
  Eigen::Index i = 0;
  for (const auto& row : values) {
    Eigen::Index j = 0;
    for (const double value : row) M(i, j++) = value;
    ++i;
  }
  return M;
}

/// sferlazza2019, (66), and the certificate (67) for intervals in [1, 3].
const Eigen::MatrixXd kA = rows({{-0.02, -1.4, 9.8}, {-0.01, -0.4, 0.0}, {0.0, 1.0, 0.0}});
const Eigen::MatrixXd kC = rows({{1.0, 0.0, 1.0}});
const Eigen::MatrixXd kP =
    rows({{0.8334, -0.0041, 0.8333}, {-0.0041, 2.0116, -0.0359}, {0.8333, -0.0359, 0.8341}});

std::shared_ptr<const Plant> plant(const Eigen::MatrixXd& A,
                                   const std::vector<Eigen::MatrixXd>& C) {
  LinearPlantDescription description;
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    description.state_names.push_back("x" + std::to_string(i + 1));
  }
  description.A = A;
  description.B = Eigen::MatrixXd::Zero(A.rows(), 0);
  for (std::size_t i = 0; i < C.size(); ++i) {
    description.sensors.push_back({"s" + std::to_string(i + 1), C[i],
                                   std::vector<bool>(static_cast<std::size_t>(C[i].rows()))});
  }
  return make_linear_plant(description);
}

ObserverContext context(const Eigen::MatrixXd& A, const std::vector<Eigen::MatrixXd>& C) {
  return {plant(A, C), Eigen::VectorXd::Zero(A.rows()), Eigen::VectorXd::Zero(0)};
}

/// One law with a state of its own, driven by durations and samples.
class LawRun {
 public:
  explicit LawRun(const TimeVaryingGainObserver& law)
      : law_(law), state_(law.state_size()), workspace_(law.workspace_size()) {
    law_.initialize(state_.data());
  }
  Eigen::VectorXd estimate() const { return state_.head(law_.estimate_size()); }
  void set_estimate(const Eigen::VectorXd& x) { state_.head(x.size()) = x; }
  void flow(double seconds) { law_.flow(from_seconds(seconds), state_.data(), workspace_.data()); }
  void sample(int sensor, const Eigen::VectorXd& y) {
    law_.reset({1, EventKind::kSample, sensor, y.data(), y.size()}, state_.data(),
               workspace_.data());
  }

 private:
  const TimeVaryingGainObserver& law_;
  Eigen::VectorXd state_;
  Eigen::VectorXd workspace_;
};

/// K(τ), column by column, from what unit samples do to an estimate of 0.
Eigen::MatrixXd gain(const TimeVaryingGainObserver& law, double tau, int sensor = 0) {
  const Eigen::Index m = law.plant().sensors()[static_cast<std::size_t>(sensor)].outputs();
  Eigen::MatrixXd K(law.estimate_size(), m);
  for (Eigen::Index j = 0; j < m; ++j) {
    LawRun run(law);
    run.flow(tau);
    run.sample(sensor, Eigen::VectorXd::Unit(m, j));
    K.col(j) = run.estimate();
  }
  return K;
}

Eigen::MatrixXd backward(const Eigen::MatrixXd& A, double tau) {
  return test::exponential(-A * tau);
}

/// Ψ = e^{−Aᵀτ} P e^{−Aτ}
Eigen::MatrixXd weight(const Eigen::MatrixXd& A, const Eigen::MatrixXd& P, double tau) {
  const Eigen::MatrixXd E = backward(A, tau);
  return E.transpose() * P * E;
}

/// (36) and (37), corrected, written down with Eigen in long double: M22 is a difference of nearly
/// equal matrices.
Eigen::MatrixXd expected_gain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C_double,
                              const Eigen::MatrixXd& P_double, long double lambda, double tau) {
  using test::extended::Matrix;
  const Matrix C = C_double.cast<long double>();
  const Matrix P = P_double.cast<long double>();
  const Eigen::Index n = C.cols();
  const Eigen::Index m = C.rows();
  const Matrix E =
      test::extended::exponential(A.cast<long double>() * static_cast<long double>(-tau));
  const Matrix Psi = E.transpose() * P * E;
  const Matrix complement = test::extended::kernel(C);
  const Matrix W = test::extended::inverse(complement.transpose() * Psi * complement);
  const Matrix coupling = C * Psi * complement;
  const Matrix M11 = C * Psi * C.transpose() - coupling * W * coupling.transpose();
  const Matrix M22 = P - P * complement * W * complement.transpose() * P;
  Matrix stacked = Matrix::Zero(n, m);
  stacked.topRows(m) = test::extended::cholesky_upper(M11);
  const Matrix R22 = test::extended::cholesky_upper(M22);
  const Matrix M21 = lambda * R22.transpose() * stacked;
  const Matrix difference =
      C.transpose() - complement * W * coupling.transpose() - test::extended::inverse(P) * M21;
  const Matrix K = difference * test::extended::inverse(C * C.transpose());
  return K.cast<double>();
}

TEST(TimeVaryingGainTest, IsThePapersForTheExampleOverTheWholeInterval) {
  for (const double lambda : {0.0, 0.3, 0.7, 0.95}) {
    const TimeVaryingGainObserver law(context(kA, {kC}), kP, lambda);
    for (double tau = 1.0; tau <= 3.0; tau += 0.05) {
      const Eigen::MatrixXd expected = expected_gain(kA, kC, kP, lambda, tau);
      EXPECT_LT((gain(law, tau) - expected).norm(), 1e-10 * expected.norm())
          << "lambda " << lambda << " tau " << tau;
    }
  }
}

TEST(TimeVaryingGainTest, HasTheClosedFormOfExample1) {
  // (26), for k pi < T1 <= T2 < (k + 1) pi; P by (24).
  for (const double alpha : {0.0, 0.2}) {
    const Eigen::MatrixXd A = rows({{alpha, 1.0}, {-1.0, alpha}});
    const double p22 = 0.5;
    const double p11 = 1.1 * std::exp(2.0 * alpha * 2.8) * p22 / std::pow(std::sin(2.8), 2);
    const TimeVaryingGainObserver law(context(A, {rows({{1.0, 0.0}})}),
                                      rows({{p11, 0.0}, {0.0, p22}}), 0.0);
    for (double tau = 0.4; tau <= 2.8; tau += 0.1) {
      const double s = std::sin(tau);
      const double c = std::cos(tau);
      const Eigen::MatrixXd K = gain(law, tau);
      EXPECT_NEAR(1.0, K(0, 0), 1e-14);
      EXPECT_NEAR((p11 - p22) * s * c / (p11 * s * s + p22 * c * c), K(1, 0), 1e-13) << tau;
    }
  }
}

TEST(TimeVaryingGainTest, AtTauZeroItProjectsInTheNormOfP) {
  // The nearest estimate, in the norm of P, that agrees with the sample, whatever lambda.
  const Eigen::MatrixXd inverse = test::inverse(kP);
  const Eigen::MatrixXd expected =
      inverse * kC.transpose() * test::inverse(kC * inverse * kC.transpose());
  for (const double lambda : {0.0, 0.3, 0.95}) {
    const TimeVaryingGainObserver law(context(kA, {kC}), kP, lambda);
    EXPECT_LT((gain(law, 0.0) - expected).norm(), 1e-10) << lambda;
    EXPECT_LT((gain(law, 1e-9) - expected).norm(), 1e-4) << lambda;  // P is nearly singular
  }
}

TEST(TimeVaryingGainTest, IsThatOfLambdaZeroWhereThePIsNoCertificate) {
  // Observability is lost at 8.541 s, so that no P is a certificate there.
  const TimeVaryingGainObserver plain(context(kA, {kC}), kP, 0.0);
  const TimeVaryingGainObserver damped(context(kA, {kC}), kP, 0.7);
  EXPECT_EQ(gain(plain, 8.541), gain(damped, 8.541));
  EXPECT_GT((gain(plain, 2.0) - gain(damped, 2.0)).norm(), 1e-4);
}

TEST(TimeVaryingGainTest, SurvivesAGapAfterWhichNothingIsLeftOfTheError) {
  // e^{-A tau} overflows; a law that then skipped samples would never take one again.
  const Eigen::MatrixXd A = rows({{-1.0, 0.0}, {0.0, -100.0}});
  const std::optional<Eigen::MatrixXd> P = rows({{1.0, 0.2}, {0.2, 1.0}});
  for (const double lambda : {0.0, 0.9}) {
    const TimeVaryingGainObserver certified(context(A, {rows({{1.0, 1.0}})}), P, lambda);
    const TimeVaryingGainObserver inverse(context(A, {rows({{1.0, 1.0}, {0.0, 2.0}})}),
                                          std::nullopt, lambda);
    for (const double gap : {0.4, 5.0, 40.0, 1e3, 1e5}) {
      const Eigen::MatrixXd K = gain(certified, gap);
      EXPECT_LT(K.norm(), 10.0) << gap;
      EXPECT_NEAR(1.0, K.sum(), 1e-12) << gap;  // C K = 1: that of lambda = 0
      EXPECT_TRUE(gain(inverse, gap).allFinite()) << gap;
    }
    EXPECT_LT((gain(inverse, 1e5) - rows({{1.0, -0.5}, {0.0, 0.5}})).norm(), 1e-15);
  }
}

TEST(InverseOutputGainTest, KeepsTheShareLambdaOfTheErrorAfterTheSampleBefore) {
  const Eigen::MatrixXd C = rows({{1.0, 0.5, 0.0}, {0.0, 1.0, -0.3}, {0.2, 0.0, 1.0}});
  for (const double lambda : {0.0, 0.4, 0.99}) {
    const TimeVaryingGainObserver law(context(kA, {C}), std::nullopt, lambda);
    LawRun run(law);
    Eigen::VectorXd x = Eigen::Vector3d(1.0, -2.0, 0.5);
    for (const double tau : {0.7, 2.3, 0.01}) {
      x = test::exponential(kA * tau) * x;
      run.flow(tau);
      const Eigen::VectorXd e = x - run.estimate();
      run.sample(0, C * x);
      const Eigen::VectorXd expected = lambda * backward(kA, tau) * e;
      EXPECT_LT((x - run.estimate() - expected).norm(), 1e-13 * (1.0 + e.norm()));
    }
  }
}

class CertifiedRunTest : public ::testing::TestWithParam<double> {};

TEST_P(CertifiedRunTest, VIsConstantInFlowFallsAtSamplesAndTheErrorVanishes) {
  const TimeVaryingGainObserver law(context(kA, {kC}), kP, GetParam());
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    std::mt19937_64 generator(seed);
    std::uniform_int_distribution<int> milliseconds(1000, 3000);
    // The plant at 0, so that the estimate is the error but for its sign; the plant is unstable,
    // and a state of its own would hide the error's last digits.
    LawRun run(law);
    run.set_estimate(Eigen::Vector3d(1.0, -0.5, 0.7));
    const auto V = [&](double tau) {
      const Eigen::VectorXd e = run.estimate();
      return e.dot(weight(kA, kP, tau) * e);
    };
    double after = V(0.0);
    const double start = after;
    for (int i = 0; i < 400; ++i) {
      const double tau = 1e-3 * milliseconds(generator);
      run.flow(0.25 * tau);
      EXPECT_NEAR(1.0, V(0.25 * tau) / after, 1e-9);
      run.flow(0.75 * tau);
      EXPECT_NEAR(1.0, V(tau) / after, 1e-9);
      run.sample(0, Eigen::VectorXd::Zero(1));
      EXPECT_LT(V(0.0), after) << "sample " << i;
      after = V(0.0);
    }
    EXPECT_LT(after, 1e-8 * start) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Lambdas, CertifiedRunTest, ::testing::Values(0.0, 0.3, 0.7, 0.95));

TEST(TimeVaryingGainObserverTest, TwoSensorsShareTauAndEachHasItsGain) {
  const Eigen::MatrixXd C2 = rows({{0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}});
  for (const double lambda : {0.0, 0.5}) {
    const TimeVaryingGainObserver law(context(kA, {kC, C2}), kP, lambda);
    EXPECT_LT((gain(law, 2.0, 1) - expected_gain(kA, C2, kP, lambda, 2.0)).norm(), 1e-9);
    LawRun run(law);
    run.set_estimate(Eigen::Vector3d(1.0, -0.5, 0.7));
    run.flow(1.25);
    run.sample(0, Eigen::VectorXd::Zero(1));
    run.flow(1.5);
    // Since the sample of the other sensor 1.5 s have passed, since the start 2.75 s.
    const Eigen::VectorXd before = run.estimate();
    run.sample(1, Eigen::Vector2d::Zero());
    const Eigen::MatrixXd K = expected_gain(kA, C2, kP, lambda, 1.5);
    EXPECT_LT((run.estimate() - (before - K * C2 * before)).norm(), 1e-10);
  }
}

TEST(TimeVaryingGainObserverTest, TwoSensorsOfOneStampNeverRaiseV) {
  const Eigen::MatrixXd C2 = rows({{0.0, 1.0, 0.0}});
  for (const double lambda : {0.0, 0.3, 0.95}) {
    const TimeVaryingGainObserver law(context(kA, {kC, C2}), kP, lambda);
    LawRun run(law);
    run.set_estimate(Eigen::Vector3d(1.0, -0.5, 0.7));
    const auto V = [&] { return run.estimate().dot(kP * run.estimate()); };
    run.flow(2.0);
    run.sample(0, Eigen::VectorXd::Zero(1));
    const double one = V();
    run.sample(1, Eigen::VectorXd::Zero(1));
    EXPECT_LE(V(), one * (1.0 + 1e-12));
    EXPECT_NEAR(0.0, run.estimate()(1), 1e-14);
  }
}

TEST(TimeVaryingGainObserverTest, SamplesAllocateNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const TimeVaryingGainObserver law(context(kA, {kC}), kP, 0.7);
  LawRun run(law);
  const Eigen::VectorXd y = Eigen::VectorXd::Ones(1);
  const std::size_t before = test::allocations();
  for (int i = 0; i < 10; ++i) {
    run.flow(1.7);
    run.sample(0, y);
  }
  EXPECT_EQ(before, test::allocations());
}

std::string fault(const ObserverContext& context, const std::optional<Eigen::MatrixXd>& P,
                  double lambda) {
  try {
    const TimeVaryingGainObserver law(context, P, lambda);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no fault";
}

TEST(TimeVaryingGainObserverTest, SaysWhichGainsItCantUse) {
  const ObserverContext good = context(kA, {kC});
  Eigen::MatrixXd skew = kP;
  skew(0, 1) += 0.001;
  EXPECT_EQ("no fault", fault(good, kP, 0.5));
  EXPECT_EQ("P must be symmetric; entries (2, 1) and (1, 2) differ", fault(good, skew, 0.0));
  EXPECT_EQ("P must be positive definite", fault(good, Eigen::MatrixXd(-kP), 0.0));
  EXPECT_EQ("P must be 3 x 3", fault(good, Eigen::MatrixXd(Eigen::MatrixXd::Identity(2, 2)), 0.0));
  EXPECT_EQ("lambda must be in [0, 1)", fault(good, kP, 1.0));
  EXPECT_EQ("lambda must be in [0, 1)", fault(good, kP, -0.1));
  EXPECT_EQ("lambda must be in [0, 1)", fault(good, kP, std::nan("")));
  EXPECT_EQ("sensor 's1': C must be square where there is no P", fault(good, std::nullopt, 0.0));
  const Eigen::MatrixXd singular = rows({{1.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {1.0, 1.0, 1.0}});
  EXPECT_EQ("sensor 's2': C must be invertible where there is no P",
            fault(context(kA, {Eigen::MatrixXd::Identity(3, 3), singular}), std::nullopt, 0.0));
  EXPECT_EQ("sensor 's1': the rows of C must be linearly independent",
            fault(context(kA, {rows({{1.0, 0.0, 1.0}, {2.0, 0.0, 2.0}})}), kP, 0.0));
  EXPECT_EQ(
      "sensor 's1': the rows of C must be linearly independent",
      fault(
          context(kA, {rows({{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {1.0, 1.0, 1.0}})}),
          kP, 0.0));
}

TEST(TimeVaryingGainObserverTest, SaysWhichPlantsItCantTake) {
  const auto changed = [](auto&& change) {
    PlantDescription description;
    description.state_names = {"x"};
    description.sensors = {{"s", SensorTiming::kSampled, {false}}};
    PlantMode mode;
    mode.label = 1;
    mode.flow = std::make_shared<const AffineMap>(Eigen::MatrixXd::Identity(1, 1));
    mode.outputs = {mode.flow};
    description.modes = {mode};
    change(description);
    return ObserverContext{std::make_shared<const Plant>(description), Eigen::VectorXd::Zero(1),
                           Eigen::VectorXd::Zero(0)};
  };
  LipschitzDescription lipschitz;
  lipschitz.A = lipschitz.G = lipschitz.S = Eigen::MatrixXd::Identity(1, 1);
  lipschitz.B = Eigen::MatrixXd::Zero(1, 0);
  lipschitz.psi = std::make_shared<const AffineMap>(Eigen::MatrixXd::Identity(1, 1));
  const auto nonlinear = std::make_shared<const LipschitzMap>(lipschitz);
  const std::optional<Eigen::MatrixXd> P = Eigen::MatrixXd::Identity(1, 1);
  EXPECT_EQ("no fault", fault(changed([](PlantDescription&) {}), P, 0.0));
  EXPECT_EQ("this observer takes plants with a linear flow, x' = A x + B u",
            fault(changed([&](PlantDescription& p) { p.modes[0].flow = nonlinear; }), P, 0.0));
  EXPECT_EQ(
      "sensor 's': this observer takes linear outputs, y = C x",
      fault(changed([&](PlantDescription& p) { p.modes[0].outputs[0] = nonlinear; }), P, 0.0));
  EXPECT_EQ("this observer takes plants of one mode", fault(changed([&](PlantDescription& p) {
                                                              p.modes.push_back(p.modes[0]);
                                                              p.modes[1].label = 2;
                                                            }),
                                                            P, 0.0));
  EXPECT_NE(
      std::string::npos,
      fault(changed([&](PlantDescription& p) { p.sensors[0].timing = SensorTiming::kContinuous; }),
            P, 0.0)
          .find("continuous"));
}

}  // namespace
}  // namespace sampled_data_observers

// Random plants, detectable and not: what a design accepts must be true.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "design/rigorous_check.h"
#include "design/synthesis.h"
#include "design/workers.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr int kPlants = 500;
constexpr int kMaxStates = 8;
/// Every one of so many accepted designs is proved in ball arithmetic, too.
constexpr int kProofEvery = 5;

class RandomPlants {
 public:
  explicit RandomPlants(unsigned seed) : generator_(seed) {}

  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
  double real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols) {
    Eigen::MatrixXd result(rows, cols);
    for (Eigen::Index i = 0; i < result.size(); ++i) result.data()[i] = normal_(generator_);
    return result;
  }

  /// A plant of which some states, in other coordinates, grow and act on no output.
  CertificateSubject undetectable() {
    const Eigen::Index n = whole(1, kMaxStates);
    const Eigen::Index hidden = whole(1, static_cast<int>(n));
    Eigen::MatrixXd A = matrix(n, n);
    A.topRightCorner(n - hidden, hidden).setZero();
    // Moves all eigenvalues of the hidden part to the right.
    const auto corner = A.bottomRightCorner(hidden, hidden);
    const double least = eigenvalues_of(corner).real().minCoeff();
    A.bottomRightCorner(hidden, hidden).diagonal().array() += 0.1 - least;
    Eigen::MatrixXd C = matrix(whole(1, 3), n);
    C.rightCols(hidden).setZero();
    const Eigen::MatrixXd T = matrix(n, n) + 3.0 * Eigen::MatrixXd::Identity(n, n);
    return subject(T * A * inverse_of(T), C * inverse_of(T));
  }

  CertificateSubject any() {
    const Eigen::Index n = whole(1, kMaxStates);
    return subject(matrix(n, n), matrix(whole(1, 3), n));
  }

 private:
  CertificateSubject subject(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C) {
    CertificateSubject subject;
    ModeMatrices mode;
    mode.A = A;
    mode.C = C;
    const Eigen::Index n = A.rows();
    subject.plant.modes = {mode};
    for (Eigen::Index i = 0; i < n; ++i) {
      subject.plant.state_names.push_back("x" + std::to_string(i + 1));
    }
    subject.plant.G.resize(n, 0);
    subject.plant.S.resize(0, n);
    subject.plant.N.resize(n, 0);
    subject.plant.C_p.resize(0, n);
    subject.T2 = real(0.02, 0.5) / (1.0 + norm2(A));
    subject.T1 = real(0.1, 1.0) * subject.T2;
    return subject;
  }

  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
};

/// Runs the error of ferrante2019 (7), ε̇ = A ε − L θ, θ̇ = H θ and θ⁺ = C ε at samples, over random
/// times between samples. With the innovation just taken, V = εᵀ P1 ε, which must fall at the rate
/// 2 λ_t from sample to sample.
void expect_convergence(const Certificate& certificate, RandomPlants& random) {
  constexpr int kTimes = 16;
  constexpr int kSamples = 2000;
  const Eigen::MatrixXd& A = certificate.subject.plant.A();
  const Eigen::MatrixXd& C = certificate.subject.plant.C();
  const Eigen::Index n = A.rows();
  const Eigen::Index m = C.rows();
  Eigen::MatrixXd flow = Eigen::MatrixXd::Zero(n + m, n + m);
  flow.topLeftCorner(n, n) = A;
  flow.topRightCorner(n, m) = -certificate.values.at("L");
  flow.bottomRightCorner(m, m) = certificate.values.at("H");
  std::vector<double> times;
  std::vector<Eigen::MatrixXd> steps;
  for (int i = 0; i < kTimes; ++i) {
    times.push_back(i == 0 ? certificate.subject.T2
                           : random.real(certificate.subject.T1, certificate.subject.T2));
    const Eigen::MatrixXd whole = exponential_of(flow * times.back());
    steps.push_back(whole.topLeftCorner(n, n) + whole.topRightCorner(n, m) * C);
  }
  const Eigen::MatrixXd& P1 = certificate.values.at("P1");
  const double rate = 2.0 * scalar_value(certificate.values, "lambda_t");
  Eigen::VectorXd error = random.matrix(n, 1);
  const double initial = error.dot(P1 * error);
  double t = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    const auto i = static_cast<std::size_t>(random.whole(0, kTimes - 1));
    error = (steps[i] * error).eval();
    t += times[i];
    ASSERT_LE(error.dot(P1 * error), 1.000001 * std::exp(-rate * t) * initial + 1e-200)
        << "after " << k + 1 << " samples";
  }
}

TEST(RandomPlants, GiveDesignsThatHoldOrNone) {
  RandomPlants random(2024);
  const DesignMethod& method = *find_design_method("ferrante2019_proposition2");
  SynthesisOptions options;
  options.jobs = default_jobs();
  options.time_limit = 5.0;
  int accepted = 0;
  int proofs = 0;
  int undecided = 0;
  int told_undetectable = 0;
  double longest = 0.0;
  for (int i = 0; i < kPlants; ++i) {
    SCOPED_TRACE("plant " + std::to_string(i));
    const bool is_undetectable = i % 4 == 0;
    DesignProblem problem;
    problem.subject = is_undetectable ? random.undetectable() : random.any();
    problem.given = {{"lambda_t", 0.01 / problem.subject.T2},
                     {"delta", random.real(1.0, 6.0) / problem.subject.T2}};
    const auto start = std::chrono::steady_clock::now();
    Design design;
    try {
      design = synthesize(method, problem, options);
    } catch (const DesignError& error) {
      const bool tells = std::string(error.what()).find("not detectable") != std::string::npos;
      told_undetectable += tells ? 1 : 0;
      EXPECT_EQ(tells, is_undetectable) << error.what();
      continue;
    }
    longest = std::max(
        longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    EXPECT_FALSE(is_undetectable);
    ++accepted;
    EXPECT_TRUE(all_hold(check(design.certificate)));
    expect_convergence(design.certificate, random);
    if (accepted % kProofEvery != 0) continue;
    for (const ConditionProof& proof : prove(
             method.theorem().conditions(design.certificate.subject), design.certificate.values)) {
      ++proofs;
      EXPECT_NE(proof.status, ProofStatus::kDisproved) << proof.name;
      undecided += proof.status == ProofStatus::kUndecided ? 1 : 0;
    }
  }
  std::printf(
      "%d plants: %d designs, %d told not to be detectable, longest synthesis %.2f s; "
      "of %d conditions %d could not be proved\n",
      kPlants, accepted, told_undetectable, longest, proofs, undecided);
  EXPECT_GT(accepted, kPlants / 4);
  EXPECT_EQ(told_undetectable, kPlants / 4);
  EXPECT_LE(undecided, proofs / 20);
}

}  // namespace
}  // namespace sampled_data_observers

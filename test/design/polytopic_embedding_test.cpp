// The polytope around e^{Aτ} of ferrante2016, section 4.1.
#include "design/polytopic_embedding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "linear_algebra/matrix_functions.h"
#include "paper_plants.h"

namespace sampled_data_observers::test {
namespace {

Eigen::MatrixXd matrix(Eigen::Index n, const std::vector<double>& entries) {
  return Eigen::Map<const Eigen::MatrixXd>(entries.data(), n, n).transpose();
}

TEST(ModeFunction, HasItsExtremaInClosedForm) {
  // e^t cos(t) rises until t = π/4.
  const ModeFunction growing{0, 1.0, 1.0, false};
  EXPECT_NEAR(growing.extrema(0.0, 2.0).max, std::exp(M_PI_4) * std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(growing.extrema(0.0, 2.0).min, std::exp(2.0) * std::cos(2.0), 1e-14);
  // t e^{-2t} is largest at t = 1/2.
  const ModeFunction hump{1, -2.0, 0.0, false};
  EXPECT_NEAR(hump.extrema(0.1, 3.0).max, 0.5 * std::exp(-1.0), 1e-15);
  EXPECT_NEAR(hump.extrema(0.1, 3.0).min, 3.0 * std::exp(-6.0), 1e-15);
  // sin over many turns.
  const ModeFunction sine{0, 0.0, 7.0, true};
  EXPECT_NEAR(sine.extrema(1.0, 1000.0).max, 1.0, 1e-12);
  EXPECT_NEAR(sine.extrema(1.0, 1000.0).min, -1.0, 1e-12);
}

TEST(ModeFunction, HasExtremaThatNoSampleExceedsAndSomeReach) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const bool turns = i % 3 != 0;
    const ModeFunction f{static_cast<int>(3.0 * uniform(random)), 4.0 * uniform(random) - 2.0,
                         turns ? 8.0 * uniform(random) : 0.0, turns && i % 2 == 0};
    const double low = 2.0 * uniform(random);
    const double high = low + 4.0 * uniform(random);
    const ModeFunction::Extrema extrema = f.extrema(low, high);
    double min = f.at(low);
    double max = min;
    constexpr int kSamples = 4000;
    for (int k = 1; k <= kSamples; ++k) {
      const double value = f.at(low + (high - low) * k / kSamples);
      min = std::min(min, value);
      max = std::max(max, value);
    }
    const double scale = std::max(std::abs(min), std::abs(max));
    EXPECT_LE(extrema.min, min + 1e-12 * scale) << i;
    EXPECT_GE(extrema.max, max - 1e-12 * scale) << i;
    EXPECT_NEAR(extrema.min, min, 1e-4 * scale) << i;
    EXPECT_NEAR(extrema.max, max, 1e-4 * scale) << i;
  }
}

TEST(ResidueExpansion, IsTheExponentialForAnyMultiplicity) {
  const std::vector<Eigen::MatrixXd> matrices = {
      matrix(1, {0}),
      matrix(2, {0, 1, 0, 0}),                 // double, defective
      matrix(2, {3, 0, 0, 3}),                 // double, not defective
      matrix(3, {1, 1, 0, 0, 1, 1, 0, 0, 1}),  // triple
      matrix(2, {-0.2, 5, -5, -0.2}),
      matrix(4, {0, 1, 1, 0, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0}),  // double ±i, defective
      matrix(4, {-100, 0, 0, 0, 1, -1, 0, 0, 0, 1, -0.1, 0, 0, 0, 1, 2}),
  };
  for (const Eigen::MatrixXd& A : matrices) {
    const ResidueExpansion expansion = residue_expansion(A, 0.1, 2.0);
    for (const double t : {0.1, 0.37, 1.0, 1.73, 2.0}) {
      const Eigen::MatrixXd exact = exponential_of(A * t);
      EXPECT_LT((expansion.at(t) - exact).norm(), 1e-7 * exact.norm()) << A << "\nt = " << t;
    }
  }
}

TEST(PolytopicEmbedding, Has16VerticesForTheMassSpringWithBias) {
  const CertificateSubject subject = mass_spring(0.2, 3.0);
  EXPECT_EQ(polytopic_embedding(subject.plant.A(), 0.2, 3.0).size(), 16u);
  EXPECT_EQ(polytopic_embedding(subject.plant.A(), 0.5, 0.5).size(), 1u);
}

TEST(PolytopicEmbedding, ContainsTheExponential) {
  // A linear function of matrices is largest at a vertex.
  const CertificateSubject subject = mass_spring(0.2, 3.0);
  const auto vertices = polytopic_embedding(subject.plant.A(), 0.2, 3.0);
  std::srand(5);
  for (int i = 0; i < 50; ++i) {
    const Eigen::MatrixXd direction = Eigen::MatrixXd::Random(5, 5);
    double largest = -1e300;
    for (const auto& X : vertices) largest = std::max(largest, direction.cwiseProduct(X).sum());
    for (double tau = 0.2; tau <= 3.0; tau += 0.01) {
      const Eigen::MatrixXd flow = exponential_of(subject.plant.A() * tau);
      EXPECT_LE(direction.cwiseProduct(flow).sum(), largest + 1e-9);
    }
  }
}

TEST(PolytopicEmbedding, RefusesMoreVerticesThanCanBeSolvedFor) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(9, 9);
  for (int i = 0; i < 9; ++i) A(i, i) = -0.3 * (i + 1);
  try {
    polytopic_embedding(A, 0.1, 1.0);
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("more than 256 vertices"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace sampled_data_observers::test

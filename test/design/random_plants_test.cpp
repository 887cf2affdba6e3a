// Designs for plants that nobody chose: no crash, no hang, and what is accepted converges.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "linear_algebra/matrix_functions.h"
#include "observer/time_varying_gain.h"
#include "paper_plants.h"

namespace sampled_data_observers::test {
namespace {

class RandomPlants {
 public:
  explicit RandomPlants(unsigned seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Eigen::Index integer(Eigen::Index low, Eigen::Index high) {
    return std::uniform_int_distribution<Eigen::Index>(low, high)(random_);
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols) {
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return uniform(-1.0, 1.0); });
  }

  /// Of 1 to max_states states.
  CertificateSubject plant(Eigen::Index max_states) {
    const Eigen::Index n = integer(1, max_states);
    const double T1 = uniform(0.1, 0.8);
    return linear_subject(uniform(0.3, 1.5) * matrix(n, n),
                          matrix(integer(1, std::min<Eigen::Index>(2, n)), n), T1,
                          T1 + uniform(0.0, 0.6));
  }

  /// With one more state, of a growing mode that the output does not show, in other coordinates.
  CertificateSubject undetectable_plant(Eigen::Index max_states) {
    CertificateSubject subject = plant(max_states - 1);
    const Eigen::Index n = subject.plant.states() + 1;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    A.topLeftCorner(n - 1, n - 1) = subject.plant.A();
    A(n - 1, n - 1) = uniform(0.0, 1.0);
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(subject.plant.C().rows(), n);
    C.leftCols(n - 1) = subject.plant.C();
    const Eigen::MatrixXd T = Eigen::MatrixXd::Identity(n, n) + 0.3 * matrix(n, n);
    return linear_subject(inverse_of(T) * A * T, C * T, subject.T1, subject.T2);
  }

 private:
  std::mt19937 random_;
};

/// The gain at samples τ after the one before.
using GainAt = std::function<Eigen::MatrixXd(double tau)>;

/// The error decays over samples at random times, or by all of its size over one of the same times.
void expect_convergence(const CertificateSubject& subject, const GainAt& gain,
                        RandomPlants& random) {
  const Eigen::Index n = subject.plant.states();
  constexpr std::size_t kTimes = 12;
  std::vector<Eigen::MatrixXd> steps;
  for (std::size_t i = 0; i < kTimes; ++i) {
    const double tau = i == 0   ? subject.T1
                       : i == 1 ? subject.T2
                                : random.uniform(subject.T1, subject.T2);
    steps.emplace_back((Eigen::MatrixXd::Identity(n, n) - gain(tau) * subject.plant.C()) *
                       exponential_of(subject.plant.A() * tau));
  }
  Eigen::MatrixXd error = Eigen::MatrixXd::Identity(n, n);
  for (int j = 0; j < 20000 && error.norm() > 1e-6; ++j) {
    error = steps[static_cast<std::size_t>(random.integer(0, kTimes - 1))] * error;
  }
  EXPECT_LE(error.norm(), 1e-6);
}

GainAt gain_of(const Design& design) {
  const CertificateSubject& subject = design.certificate.subject;
  const NamedMatrices& values = design.certificate.values;
  if (values.count("L") > 0) return [&values](double) { return values.at("L"); };
  const auto law = std::make_shared<const CertificateGain>(subject.plant.C(), values.at("P"),
                                                           scalar_value(values, "lambda"));
  return [law, &subject](double tau) {
    Eigen::MatrixXd K(subject.plant.states(), subject.plant.C().rows());
    Eigen::VectorXd workspace(law->workspace_size());
    const Eigen::MatrixXd backward = exponential_of(-subject.plant.A() * tau);
    law->evaluate(backward.data(), K.data(), workspace.data());
    return K;
  };
}

/// @return how many of the plants got a design
int design_for_random_plants(const char* method, Eigen::Index max_states, int plants) {
  RandomPlants random(11);
  int accepted = 0;
  for (int i = 0; i < plants; ++i) {
    const CertificateSubject subject = random.plant(max_states);
    SCOPED_TRACE("plant " + std::to_string(i));
    try {
      const Design design = design_by(method, subject);
      EXPECT_TRUE(all_hold(
          check(design.certificate.theorem->conditions(subject), design.certificate.values, 1001)));
      expect_convergence(subject, gain_of(design), random);
      ++accepted;
    } catch (const DesignError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("found no design"), std::string::npos) << message;
      EXPECT_EQ(message.find("process died"), std::string::npos) << message;
      EXPECT_EQ(message.find("time limit"), std::string::npos) << message;
    }
  }
  for (int i = 0; i < 6; ++i) {
    const std::string message = refusal(method, random.undetectable_plant(max_states));
    EXPECT_NE(message.find("not detectable"), std::string::npos) << message;
  }
  return accepted;
}

TEST(RandomPlants, AreDesignedForByCorollary1OfFerrante2016) {
  EXPECT_GE(design_for_random_plants("ferrante2016_corollary1", 5, 30), 15);
}

TEST(RandomPlants, AreDesignedForByAlgorithm1OfSferlazza2019) {
  EXPECT_GE(design_for_random_plants("sferlazza2019_algorithm1", 6, 30), 15);
}

}  // namespace
}  // namespace sampled_data_observers::test

#include "observer/observable_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "linear_algebra/matrix_functions.h"
#include "support/matrix_functions.h"

namespace sampled_data_observers {
namespace {

std::vector<double> sorted_real_eigenvalues(const Eigen::MatrixXd& M) {
  std::vector<double> result;
  const Eigen::VectorXcd values = eigenvalues_of(M);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(0.0, values(i).imag(), 1e-6);
    result.push_back(values(i).real());
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// The blocks 𝐀 and 𝐇 for these indices.
Eigen::MatrixXd shift(const std::vector<Eigen::Index>& indices, Eigen::Index n) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Eigen::Index first = 0;
  for (const Eigen::Index d : indices) {
    for (Eigen::Index k = 1; k < d; ++k) A(first + k, first + k - 1) = 1.0;
    first += d;
  }
  return A;
}
Eigen::MatrixXd ends(const std::vector<Eigen::Index>& indices, Eigen::Index n) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(indices.size()), n);
  Eigen::Index last = -1;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    last += indices[i];
    H(static_cast<Eigen::Index>(i), last) = 1.0;
  }
  return H;
}

void expect_form(const Eigen::MatrixXd& A, const Eigen::MatrixXd& H, const ObservableForm& form) {
  const Eigen::MatrixXd bold_A = shift(form.indices, A.rows());
  const Eigen::MatrixXd bold_H = ends(form.indices, A.rows());
  EXPECT_LT((A * form.basis - form.basis * (bold_A + form.D * bold_H)).norm(), 1e-10);
  EXPECT_LT((H * form.basis - form.M * bold_H).norm(), 1e-10);
  EXPECT_TRUE(form.M.isLowerTriangular(1e-10));
  EXPECT_LT((form.M.diagonal().array() - 1.0).abs().maxCoeff(), 1e-10);
}

struct Pair {
  Eigen::MatrixXd A = Eigen::MatrixXd(3, 3);
  Eigen::MatrixXd H;
};

Pair one_output() {
  Pair pair;
  pair.A << 0.0, 1.0, 0.3, -4.0, -0.2, 1.0, 0.5, 0.0, 0.1;
  pair.H.resize(1, 3);
  pair.H << 1.0, 0.0, 0.5;
  return pair;
}

/// Observability indices 1 and 2, in this order, and an M that is not the identity in the other.
Pair two_outputs() {
  Pair pair;
  pair.A << -1.0, 0.4, 0.2, 0.0, 0.0, 1.0, 0.7, -2.0, -0.3;
  pair.H.resize(2, 3);
  pair.H << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  return pair;
}

std::string message(const Eigen::MatrixXd& A, const Eigen::MatrixXd& H, double ell,
                    const std::vector<Eigen::VectorXd>& K) {
  try {
    high_gain(A, H, observable_form(A, H), ell, K);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "no fault";
}

TEST(ObservableFormTest, OfOneOutputIsThePapers) {
  const Pair pair = one_output();
  const ObservableForm form = observable_form(pair.A, pair.H);
  EXPECT_EQ(std::vector<Eigen::Index>{3}, form.indices);
  EXPECT_NEAR(1.0, form.M(0, 0), 1e-12);
  expect_form(pair.A, pair.H, form);
}

TEST(ObservableFormTest, OfOutputsWithUnequalIndices) {
  // y1 = x1 and y2 = x2: h1 A = (-1, 0.4, 0.2) tells x3 already, so d = (2, 1).
  const Pair pair = two_outputs();
  const ObservableForm form = observable_form(pair.A, pair.H);
  EXPECT_EQ((std::vector<Eigen::Index>{2, 1}), form.indices);
  expect_form(pair.A, pair.H, form);
  // h2 A w1, where w1 is the column of the inverse that belongs to h1 A: (0, 0, 5).
  EXPECT_NEAR(5.0, form.M(1, 0), 1e-12);
}

TEST(ObservableFormTest, OfTwoDoubleIntegratorsInOtherCoordinates) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
  A(0, 1) = A(2, 3) = 1.0;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, 4);
  H(0, 0) = H(1, 2) = 1.0;
  Eigen::MatrixXd S(4, 4);
  S << 1.0, 0.2, 0.0, 0.1, 0.0, 1.0, 0.3, 0.0, 0.5, 0.0, 1.0, 0.0, 0.0, 0.1, 0.0, 2.0;
  const Eigen::MatrixXd inverse = test::inverse(S);
  const ObservableForm form = observable_form(S * A * inverse, H * inverse);
  EXPECT_EQ((std::vector<Eigen::Index>{2, 2}), form.indices);
  EXPECT_LT(form.D.norm(), 1e-12);
  expect_form(S * A * inverse, H * inverse, form);
}

TEST(ObservableFormTest, AnUnobservablePairIsRefused) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(3, 3);
  A(0, 1) = 1.0;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, 3);
  H(0, 0) = 1.0;
  EXPECT_NE(std::string::npos, message(A, H, 1.0, {}).find("2 of 3 states"))
      << message(A, H, 1.0, {});
}

TEST(ObservableFormTest, AnOutputThatAddsNothingIsRefused) {
  Pair pair = two_outputs();
  pair.H.row(1) = 3.0 * pair.H.row(0);
  EXPECT_NE(std::string::npos, message(pair.A, pair.H, 1.0, {}).find("output 2"));
}

TEST(HighGainTest, PlacesTheEigenvaluesOfOneOutput) {
  // (s + 1)(s + 2)(s + 3) = s^3 + 6 s^2 + 11 s + 6
  const Pair pair = one_output();
  for (const double ell : {0.5, 1.0, 7.0, 40.0}) {
    const Eigen::MatrixXd L_c = high_gain(pair.A, pair.H, observable_form(pair.A, pair.H), ell,
                                          {Eigen::Vector3d(6.0, 11.0, 6.0)});
    const std::vector<double> found = sorted_real_eigenvalues(pair.A - L_c * pair.H);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(-ell * static_cast<double>(3 - i), found[i], 1e-7 * ell) << ell;
    }
  }
}

TEST(HighGainTest, PlacesTheEigenvaluesOfTwoOutputsWithUnequalIndices) {
  // d = (2, 1): (s + 1)(s + 2) and s + 5
  const Pair pair = two_outputs();
  const Eigen::MatrixXd L_c =
      high_gain(pair.A, pair.H, observable_form(pair.A, pair.H), 4.0,
                {Eigen::Vector2d(2.0, 3.0), Eigen::VectorXd::Constant(1, 5.0)});
  const std::vector<double> found = sorted_real_eigenvalues(pair.A - L_c * pair.H);
  EXPECT_NEAR(-20.0, found[0], 1e-9);
  EXPECT_NEAR(-8.0, found[1], 1e-9);
  EXPECT_NEAR(-4.0, found[2], 1e-9);
}

TEST(HighGainTest, RefusesGainsThatDoNotFit) {
  const Pair pair = one_output();
  const auto fault = [&](double ell, const std::vector<Eigen::VectorXd>& K) {
    return message(pair.A, pair.H, ell, K);
  };
  EXPECT_EQ("no fault", fault(2.0, {Eigen::Vector3d(6.0, 11.0, 6.0)}));
  EXPECT_NE(std::string::npos, fault(0.0, {Eigen::Vector3d(6.0, 11.0, 6.0)}).find("ell"));
  EXPECT_NE(std::string::npos, fault(2.0, {}).find("one list per continuous output"));
  EXPECT_NE(std::string::npos, fault(2.0, {Eigen::Vector2d(2.0, 3.0)}).find("3 numbers"));
  // s^3 + s^2 + s + 6 has two zeros in the right half plane.
  EXPECT_NE(std::string::npos, fault(2.0, {Eigen::Vector3d(6.0, 1.0, 1.0)}).find("not Hurwitz"));
}

TEST(HighGainTest, RefusesAPairThatIsAlmostUnobservable) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = 1.0;
  A(1, 2) = 1e-8;
  A(2, 0) = 0.3;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, 3);
  H << 1.0, 0.0, 1e-9;
  const std::string found = message(A, H, 1e12, {Eigen::Vector3d(6.0, 11.0, 6.0)});
  EXPECT_NE(std::string::npos, found.find("can not be placed")) << found;
}

TEST(HurwitzTest, TellsStablePolynomialsFromOthers) {
  EXPECT_TRUE(is_hurwitz(Eigen::VectorXd::Constant(1, 0.1)));
  EXPECT_FALSE(is_hurwitz(Eigen::VectorXd::Constant(1, 0.0)));
  EXPECT_TRUE(is_hurwitz(Eigen::Vector2d(0.1, 4.0)));
  EXPECT_FALSE(is_hurwitz(Eigen::Vector2d(0.0, 4.0)));
  EXPECT_TRUE(is_hurwitz(Eigen::Vector3d(1.0, 2.0, 1.9)));
  EXPECT_FALSE(is_hurwitz(Eigen::Vector3d(1.0, 2.0, 2.1)));
  EXPECT_TRUE(is_hurwitz(Eigen::Vector4d(3.0777, 4.2361, 3.0777, 1.0)));
}

}  // namespace
}  // namespace sampled_data_observers

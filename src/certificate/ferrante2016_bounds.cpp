#include "certificate/ferrante2016_bounds.h"

#include <algorithm>
#include <cmath>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kPoints = 513;

double least_eigenvalue(const MatrixExpression& matrix, const NamedMatrices& values, double low,
                        double high) {
  return least_eigenvalue(matrix, values, {low, high}, kPoints);
}

}  // namespace

Ferrante2016Bounds ferrante2016_bounds(const CertificateSubject& subject,
                                       const NamedMatrices& values) {
  const Eigen::Index n = subject.plant.states();
  const MatrixExpression E = exponential(time_tau() * MatrixExpression(subject.plant.A()));
  const MatrixExpression P = symbol("P", n, n);
  const MatrixExpression I_LC =
      identity(n) - symbol("L", n, subject.plant.C().rows()) * MatrixExpression(subject.plant.C());
  const MatrixExpression weight = transpose(E) * P * E;

  Ferrante2016Bounds bounds;
  // By the inverse, whose largest eigenvalue has no rounding error that could hide it.
  const MatrixExpression back = exponential(-(time_tau() * MatrixExpression(subject.plant.A())));
  bounds.alpha_1 =
      -1.0 / least_eigenvalue(-(back * inverse(P) * transpose(back)), values, 0.0, subject.T2);
  bounds.alpha_2 = -least_eigenvalue(-weight, values, 0.0, subject.T2);
  bounds.beta =
      least_eigenvalue(P - transpose(I_LC) * weight * I_LC, values, subject.T1, subject.T2);
  bounds.theta = std::log1p(-bounds.beta / bounds.alpha_2);
  bounds.gamma = -bounds.theta / (1.0 + subject.T2);
  bounds.R = subject.T2 * bounds.gamma;

  const double norm_P = norm2(values.at("P"));
  const double growth_squared =
      -least_eigenvalue(-(transpose(E) * E), values, subject.T1, subject.T2);
  const double rho = norm_P * (1.0 + 2.0 * norm_P / bounds.beta) * growth_squared;
  // e^{−θ}/(e^{−θ} − 1) = 1/(1 − e^θ), with 1 − e^θ = β/(2 α2).
  bounds.noise_gain = norm2(values.at("L")) *
                      std::sqrt(2.0 * rho * 2.0 * bounds.alpha_2 / (bounds.beta * bounds.alpha_1));
  return bounds;
}

}  // namespace sampled_data_observers

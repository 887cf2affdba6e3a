#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

namespace sampled_data_observers {

/// An eigenvalue of A [1/s], not of a decaying mode, that y = C x does not show; none where the
/// pair is detectable.
std::optional<std::complex<double>> undetectable_eigenvalue(const Eigen::MatrixXd& A,
                                                            const Eigen::MatrixXd& C);

/// A time τ in [T1, T2] [s] for which samples τ apart do not show a mode that does not decay,
/// though a continuous output would: the difference of two eigenvalues is a multiple of 2πi/τ. None
/// where (e^{Aτ}, C) is detectable for all of them, or (A, C) is not.
std::optional<double> undetectable_time(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C,
                                        double T1, double T2);

}  // namespace sampled_data_observers

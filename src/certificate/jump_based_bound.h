#pragma once

#include <memory>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// By how much |x − x̂|_P = √((x − x̂)ᵀ P (x − x̂)) falls from just after a jump to just after the
/// next, τ later: by the factor e^{offset + slope τ}.
struct JumpContraction {
  double offset = 0.0;
  double slope = 0.0;  ///< 1/s
};

/// The bound of an observer that is corrected at jumps alone. For times between jumps in [T1, T2]
/// it falls as the contraction says, after longer ones and at the first jump it is what flow and
/// reset make of it at most; a jump sooner than T1 after another makes it infinite. Each jump must
/// come with its outputs, and no jump may be missed.
/// @param P       n x n
/// @param reset   n x n: A_d − L_d H_d, from before a jump to after it
/// @param L_d     n x m
std::unique_ptr<const ErrorBound> jump_based_bound(const CertificateSubject& subject,
                                                   const Eigen::MatrixXd& P,
                                                   const Eigen::MatrixXd& reset,
                                                   const Eigen::MatrixXd& L_d,
                                                   const JumpContraction& contraction,
                                                   const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers

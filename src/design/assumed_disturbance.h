#pragma once

#include <Eigen/Core>
#include <optional>

#include "design/design_method.h"

namespace sampled_data_observers {

/// The weights of the subject, or what each entry of the error makes of the outputs within five
/// times T2: what a level weighs it by, so that gains do not depend on units and serve the outputs,
/// too. At least 0.001 of the largest.
Eigen::VectorXd weights_of_design(const CertificateSubject& subject);

/// Where a state's derivative says more than that it is a multiple of another state, forces and
/// faults enter: a column for each of these, so long that w = 1 alone moves the outputs by 1 within
/// five times T2.
/// @return n x n_w; without columns where the outputs show nothing of any
Eigen::MatrixXd default_disturbance_input(const CertificateSubject& subject);

/// The |w| that moves the outputs by `noise` within five times T2, for the subject's N; 0 where
/// the outputs show nothing of it.
double default_disturbance(const CertificateSubject& subject, double noise);

/// What a user says of noise and disturbance, if anything.
struct DeclaredAssumptions {
  std::optional<double> noise;
  std::optional<double> disturbance;
};

/// Sets what the final error is due to: as declared, or a noise of 1 and a disturbance that shows
/// as much within five times T2, which enters where default_disturbance_input() says if the
/// problem has no N. A performance output plays no part: it is dropped.
void assume(const DeclaredAssumptions& declared, DesignProblem& problem);

}  // namespace sampled_data_observers

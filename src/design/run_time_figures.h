#pragma once

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// T1, or time_scale() where the times between samples have no lower bound [s].
double shortest_interval(const CertificateSubject& subject);

/// What the bound at run time does under the assumptions on noise and disturbance, over samples
/// that all come after T1, all after T2, or after both in turn, whichever is worst; over jumps with
/// a reverse average dwell time that come evenly, or after as long a pause as there may be.
struct RunTimeFigures {
  /// Of the bound in the end, units of the state.
  double final_error = 0.0;
  /// The largest bound over an initial error, without noise and disturbance.
  double factor_on_start = 0.0;
  /// When the bound has fallen to a hundredth of the initial error for good, without noise and
  /// disturbance [s]; infinite where it has not in a million samples.
  double time_to_hundredth = 0.0;
};

/// @pre the conditions hold
/// @throws std::invalid_argument where the theorem has no bound for such assumptions
RunTimeFigures run_time_figures(const Theorem& theorem, const CertificateSubject& subject,
                                const NamedMatrices& values, const ErrorAssumptions& assumptions);

/// Only the first of the figures; of the weighted norm where the subject has weights of errors.
double final_error(const Theorem& theorem, const CertificateSubject& subject,
                   const NamedMatrices& values, const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers

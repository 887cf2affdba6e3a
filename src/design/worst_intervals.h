#pragma once

#include <optional>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// The largest bound that a search finds in the end over events of one source at any intervals in
/// [T1, T2], units of the state. Of nine equidistant intervals that one comes after each event
/// which leaves the largest bound at the next event, until that makes no difference; then the
/// longest one. Regular intervals, as of run_time_figures(), may leave less: noise of many short
/// ones adds up, and the error then grows over a long one.
/// @return nothing where events have several sources, one interval, or none that is shortest or
///     longest
/// @pre as for run_time_figures()
std::optional<double> worst_intervals_final_error(const Theorem& theorem,
                                                  const CertificateSubject& subject,
                                                  const NamedMatrices& values,
                                                  const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers

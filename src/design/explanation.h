#pragma once

#include <string>
#include <vector>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// Why designs for a plant can or can't exist, in words: its modes, what its outputs show of them,
/// in flow, at samples and at jumps, what that asks of the times between events, which methods are
/// about the plant, and what to try. Lines of at most 96 columns.
/// @param subject  T1 and T2 may be 0: then nothing is said of them; where T2 is infinite, times up
/// to
///                 longest_looked_at() are looked at
std::string explain(const CertificateSubject& subject);

/// T2, or, where there is none, ten times what is typical of the plant (time_scale()) [s].
double longest_looked_at(const CertificateSubject& subject);

/// A measure of observability over the time τ between events.
struct ObservabilityCurve {
  std::string label;
  std::vector<double> tau;    ///< increasing [s]
  std::vector<double> value;  ///< zero where something is unseen
};

/// Of each mode of the plant: the least singular value for samples τ apart (sferlazza2019, Fig. 2),
/// where an output is sampled, of several sensors also for each alone, and the detectability margin
/// of the pair at jumps, where one is measured at jumps. The last τ is beyond T2 and, where it is
/// not too far, beyond the first pathological interval.
std::vector<ObservabilityCurve> observability_curves(const CertificateSubject& subject);

/// Pathological intervals of all modes of the plant in the range of the curves [s].
std::vector<double> pathological_times(const CertificateSubject& subject);

}  // namespace sampled_data_observers

#pragma once

#include <string>

#include "design/synthesis.h"

namespace sampled_data_observers {

/// What the final error is least for one value of, where the Lyapunov function depends on timers:
/// the rate, or the factor at events.
std::string searched_parameter(const DesignMethod& method, const CertificateSubject& subject);

/// A design for the least final error, by a method whose Lyapunov function depends on timers: with
/// the rate of another design, say on fewer cells, and from that up or down, as long as the final
/// error becomes less. Of a function that falls at events the factor is searched for so.
/// @throws DesignError  where there is none with the rate to begin with
Design search_rate_near(const Design& start, const DesignMethod& method, DesignProblem problem,
                        const SynthesisOptions& options);

}  // namespace sampled_data_observers

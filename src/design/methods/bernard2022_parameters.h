#pragma once

#include "certificate/bernard2022.h"
#include "design/design_method.h"

namespace sampled_data_observers {

// The parameters that the methods of bernard2022 share.

inline DesignParameter jump_decay_parameter() {
  return {"jump_decay", "by how much the logarithm of the error falls from jump to jump, at least",
          0.01, std::nullopt};
}

/// The rate of convergence of a subject with a dwell time.
inline DesignParameter decay_parameter_of(const CertificateSubject& subject) {
  return {"decay", "rate at which the error falls on average, at least [1/s]",
          0.01 / time_scale(subject), std::nullopt};
}

/// a_c and a_d of Theorem 3.1 for the parameters of an attempt.
struct NumericRates {
  double a_c = 0.0;
  double a_d = 0.0;
};
inline NumericRates rates_of(const CertificateSubject& subject, FlowOfError kind,
                             const Parameters& parameters) {
  NamedMatrices values;
  for (const auto& [name, value] : parameters) values[name] = scalar_matrix(value);
  const LyapunovRates rates = lyapunov_rates(subject, kind);
  return {evaluate(rates.a_c, values)(0, 0), evaluate(rates.a_d, values)(0, 0)};
}

inline DesignParameter flow_growth_parameter(const CertificateSubject& subject) {
  return {"flow_growth", "rate at which V may grow in flow, a_c [1/s]", std::nullopt,
          flow_growth_range(subject)};
}

inline DesignParameter flow_decay_parameter(const CertificateSubject& subject,
                                            const Theorem& theorem) {
  return {"flow_decay", "rate at which V falls in flow, -a_c [1/s]", std::nullopt,
          theorem.search_ranges(subject).front().range};
}

inline DesignParameter gain_bound_parameter() {
  return {"gain_bound", "bound on the norm of L_c", 1000.0, std::nullopt};
}

}  // namespace sampled_data_observers

#pragma once

#include "design/design_method.h"

namespace sampled_data_observers {

// The parameters that the methods of bernard2022 share.

inline DesignParameter jump_decay_parameter() {
  return {"jump_decay", "by how much the logarithm of the error falls from jump to jump, at least",
          0.01, std::nullopt};
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

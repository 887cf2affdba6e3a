#pragma once

#include <vector>

#include "design/methods/bernard2022_parameters.h"

namespace sampled_data_observers {

/// What the designs of jump-based gains L_d ask for and can optimize.
class JumpBasedDesign : public LmiDesignMethod {
 public:
  std::vector<DesignParameter> parameters(const CertificateSubject&) const override {
    return {jump_decay_parameter()};
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay};
  }
};

}  // namespace sampled_data_observers

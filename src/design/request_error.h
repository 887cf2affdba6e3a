#pragma once

#include "design/design_method.h"

namespace sampled_data_observers {

/// A request that no search could serve: a method that is not about the plant or the objective, or
/// a parameter that it does not have. Where it is none, the search found nothing.
class RequestError : public DesignError {
 public:
  using DesignError::DesignError;
};

/// What to say of a method that can't serve an objective: those that it can.
RequestError cannot_serve(const DesignMethod& method, const CertificateSubject& subject,
                          Objective objective);

}  // namespace sampled_data_observers

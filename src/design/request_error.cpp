#include "sampled_data_observers/design/request_error.h"

#include <string>

namespace sampled_data_observers {

RequestError cannot_serve(const DesignMethod& method, const CertificateSubject& subject,
                          Objective objective) {
  std::string names;
  for (const Objective other : method.objectives(subject)) {
    names += (names.empty() ? "" : ", ") + std::string(to_string(other));
  }
  return RequestError(method.name() + " can't serve the objective " + to_string(objective) +
                      " for this plant; it can serve " + names);
}

}  // namespace sampled_data_observers

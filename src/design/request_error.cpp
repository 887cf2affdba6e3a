#include "design/request_error.h"

#include <string>

namespace sampled_data_observers {

RequestError cannot_serve(const DesignMethod& method, const CertificateSubject& subject,
                          Objective objective) {
  std::string names;
  for (const Objective other : method.objectives(subject)) {
    names += (names.empty() ? "" : ", ") + std::string(to_string(other));
  }
  const PlantMatrices& plant = subject.plant;
  const bool lacks_channel = plant.N.cols() == 0 || plant.C_p.rows() == 0;
  return RequestError(method.name() + " can't serve the objective " + to_string(objective) +
                      " for this plant; it can serve " + names +
                      (objective == Objective::kMinGamma && lacks_channel
                           ? "; a gain needs design/N, where the disturbance enters, and "
                             "design/C_p, what of the error counts"
                           : ""));
}

}  // namespace sampled_data_observers

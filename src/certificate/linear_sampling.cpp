#include "certificate/linear_sampling.h"

#include <stdexcept>

namespace sampled_data_observers {

void require_linear_sampling(const std::string& paper, const CertificateSubject& subject) {
  const PlantMatrices& plant = subject.plant;
  if (plant.modes.size() > 1 || plant.jumps()) {
    throw std::invalid_argument(paper + " is about plants of one mode that do not jump");
  }
  if (!plant.is_linear()) {
    throw std::invalid_argument(paper + " is about linear flows, x' = A x + B u");
  }
  if (plant.C().rows() == 0) throw std::invalid_argument(paper + " needs a sampled sensor");
  if (!(0.0 < subject.T1 && subject.T1 <= subject.T2)) {
    throw std::invalid_argument(
        paper + " needs times between samples with 0 < T1 <= T2 [s], found " +
        "T1 = " + std::to_string(subject.T1) + ", T2 = " + std::to_string(subject.T2));
  }
}

void require_no_disturbance(const std::string& paper, const ErrorAssumptions& assumptions) {
  if (assumptions.disturbance == 0.0) return;
  throw std::invalid_argument(paper + " bounds the error without disturbances only");
}

}  // namespace sampled_data_observers

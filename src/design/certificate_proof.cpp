#include "design/certificate_proof.h"

#include "design/plant_scaling.h"

namespace sampled_data_observers {
namespace {

/// Of the largest unit over the smallest.
constexpr double kMostUnlike = 65536.0;

/// Those of a file, but for powers of two. Times stay in seconds.
PlantScaling balanced_units(const Certificate& certificate) {
  KeptNorms kept;
  kept.of_each_sensor = has_norm_of_noise(*certificate.theorem);
  PlantScaling units =
      rounded_to_powers_of_two(scaling_of(*certificate.theorem, certificate.subject, kept));
  units.time = 1.0;
  return units;
}

}  // namespace

std::vector<ConditionProof> prove(const Certificate& certificate, const ProofOptions& options) {
  const Theorem& theorem = *certificate.theorem;
  const CertificateSubject& subject = certificate.subject;
  if (!has_conditions_for_units(theorem)) {
    const PlantScaling units = balanced_units(certificate);
    if (units.state.maxCoeff() > kMostUnlike * units.state.minCoeff()) {
      ProofOptions in_units = options;
      in_units.rounded = RoundedNumbers::kAllButZero;
      std::vector<ConditionProof> proofs =
          prove(theorem.conditions(scaled(subject, units)),
                scaled(theorem, certificate.values, units), in_units);
      if (first_unproved(proofs).empty()) return proofs;
    }
  }
  return prove(theorem.conditions(subject), certificate.values, options);
}

}  // namespace sampled_data_observers

#include "certificate/modal_norms.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "certificate/held_output.h"
#include "certificate/outward.h"
#include "certificate/weighted_norm.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {

ModalNorms::ModalNorms(const CertificateSubject& subject, const std::vector<ModalProof>& modes,
                       const ErrorAssumptions& assumptions) {
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const ModeMatrices& plant = subject.plant.modes[i];
    const ModalProof& proof = modes[i];
    OfMode& norms = modes_.emplace_back();
    norms.per_error = std::sqrt(largest_eigenvalue_above(proof.P));
    const double least = positive_least_eigenvalue(
        proof.P, modes.size() > 1 ? of_mode("P", plant) : std::string("P"));
    norms.least = std::sqrt(least);
    norms.set = SublevelSet(proof.P, least);
    norms.growth = growth_above(proof.P, plant.A);
    norms.push = norm_into(proof.P, subject.plant.N) * assumptions.disturbance;
    const double injected = injection_gain(proof.P, assumptions);
    norms.injection = norm_into(proof.P, proof.L_c) + injected;
    norms.free_injection = raised(injected / norms.least);
    norms.output = plant.C_c.rows() == 0 ? 0.0 : raised(norm2(plant.C_c));
    if (subject.plant.lipschitz_jump && !plant.A_d) {
      const LipschitzJump& jump = *subject.plant.lipschitz_jump;
      const double into = norm_into(proof.P, inverse_of(jump.J));
      norms.reset = {raised(into * jump.constant * norm2(jump.J) / norms.least)};
      norms.uncorrected = norms.reset;
      continue;
    }
    const Eigen::MatrixXd A_d = jump_of(plant);
    MatrixExpression reset = A_d;
    if (proof.L_d.cols() > 0) reset = reset - MatrixExpression(proof.L_d) * plant.C_d;
    for (const ModalProof& next : modes) {
      norms.reset.push_back(norm_between(proof.P, next.P, reset));
      norms.uncorrected.push_back(norm_between(proof.P, next.P, A_d));
      norms.noise = std::max(norms.noise, norm_into(next.P, proof.L_d) * assumptions.noise);
    }
  }
}

}  // namespace sampled_data_observers

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "certificate/modal_bound.h"
#include "certificate/outward.h"
#include "certificate/theorems.h"
#include "certificate/weighted_norm.h"
#include "linear_algebra/matrix_functions.h"
#include "observer/switched_gains.h"

namespace sampled_data_observers {
namespace {

/// bernard2022, section 7.3.1: flow-based gains, and the projection that makes V fall at switches.
///
/// The paper has V = eᵀ P_q e, projects along P_q, and asks for P_q' − P_q = dᵀ H + Hᵀ d. No
/// rounded numbers do that, and V grows where they do not. Here instead V_q is made of the
/// projection that the observer computes with: with M_q its metric, of which nothing else is asked,
///
///   Π_q = I − M_q⁻¹ Hᵀ (H M_q⁻¹ Hᵀ)⁻¹ H,  P_q = Π_qᵀ Q Π_q + Hᵀ S_q H
///
/// for one Q and an S_q for each mode. A switch makes Π_q e of e. Since H Π_q = 0, Π_q' Π_q = Π_q,
/// so that V_q'(Π_q e) = (Π_q e)ᵀ Q (Π_q e) = V_q(e) − (H e)ᵀ S_q (H e) <= V_q(e), whatever the
/// numbers. All P of the paper are of this form, with M_q = Q + … = P_q.
class Section731 : public Theorem {
 public:
  std::string name() const override { return "bernard2022_section7_3_1"; }

  std::string guarantee() const override {
    return "the error falls at the rate decay, in the norms of the P = Pi' Q Pi + H' S H of their "
           "modes, for any times between switches, with the continuous output known at all times, "
           "and with the output that is projected on known at each switch";
  }

  TheoremTimes times() const override { return TheoremTimes::kFromT1; }
  std::vector<std::string> observer_types() const override { return {"SwitchedObserver"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    const std::vector<ModeMatrices>& modes = subject.plant.modes;
    if (modes.size() < 2) {
      throw std::invalid_argument("it is about switched plants: plant/modes with two or more");
    }
    const ModeMatrices& first = modes.front();
    if (first.C_c.rows() == 0) {
      throw std::invalid_argument("L_c needs a sensor that is `measured: continuous`");
    }
    for (const ModeMatrices& mode : modes) {
      if (!jump_of(mode).isIdentity(0.0)) {
        throw std::invalid_argument("a projection is for modes whose jump map is the identity");
      }
      if (output_at_switches(mode) != output_at_switches(first)) {
        throw std::invalid_argument("it is about an output at switches that all modes have alike");
      }
    }
  }

  std::vector<NamedShape> gains(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all;
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(matrix_shape(of_mode("L_c", mode), mode.A.rows(), mode.C_c.rows()));
    }
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(symmetric_shape(of_mode("projection", mode), mode.A.rows()));
    }
    return all;
  }

  std::vector<NamedShape> multipliers(const CertificateSubject& subject) const override {
    std::vector<NamedShape> all = {symmetric_shape("Q", subject.plant.states())};
    for (const ModeMatrices& mode : subject.plant.modes) {
      all.push_back(symmetric_shape(of_mode("S", mode), output_at_switches(mode).rows()));
    }
    return all;
  }

  std::vector<NamedShape> parameters(const CertificateSubject&) const override {
    return {scalar_shape("decay")};
  }
  std::string decay_parameter() const override { return "decay"; }

  bool is_homogeneous(const CertificateSubject&) const override { return true; }

  std::vector<Condition> conditions(const CertificateSubject& subject) const override {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression a_c = -2.0 * symbol("decay");
    const MatrixExpression Q = symbol("Q", n, n);
    std::vector<Condition> all = domain_of_times(subject.T1, subject.T2);
    all.push_back(positive("decay"));
    // As large across H as it likes, since V has none of that.
    all.push_back({"Q > 0", Q, std::nullopt});
    for (const ModeMatrices& mode : subject.plant.modes) {
      const std::string label = std::to_string(mode.label);
      const MatrixExpression H = output_at_switches(mode);
      const MatrixExpression lifted =
          inverse(symbol(of_mode("projection", mode), n, n)) * transpose(H);
      const MatrixExpression projector = identity(n) - lifted * inverse(H * lifted) * H;
      const MatrixExpression P = transpose(projector) * Q * projector +
                                 transpose(H) * symbol(of_mode("S", mode), H.rows(), H.rows()) * H;
      const MatrixExpression L = symbol(of_mode("L_c", mode), n, mode.C_c.rows());
      all.push_back({"P > 0 in mode " + label, P, std::nullopt});
      all.push_back({"flow in mode " + label + ", bernard2022 (47b)",
                     a_c * P - He(P * (mode.A - L * mode.C_c)), std::nullopt});
    }
    return all;
  }

  std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const override {
    if (subject.plant.mode().C_d.rows() == 0) {
      throw std::invalid_argument(
          "no sensor that is `measured: at_jumps`: the estimate is projected on a continuous "
          "output "
          "that was measured before the switch");
    }
    // The P that are computed are not quite those of the proof: their own rates count.
    std::vector<ModalProof> proofs;
    double rate = -std::numeric_limits<double>::infinity();
    for (const ModeMatrices& mode : subject.plant.modes) {
      const Eigen::MatrixXd& H = mode.C_d;
      const Eigen::MatrixXd& L_c = values.at(of_mode("L_c", mode));
      const Eigen::MatrixXd gain = projection_gain(values.at(of_mode("projection", mode)), H,
                                                   " of " + of_mode("mode", mode));
      const Eigen::MatrixXd projector = Eigen::MatrixXd::Identity(H.cols(), H.cols()) - gain * H;
      const Eigen::MatrixXd P = projector.transpose() * values.at("Q") * projector +
                                H.transpose() * values.at(of_mode("S", mode)) * H;
      proofs.push_back({0.5 * (P + P.transpose()), L_c, gain});
      rate = std::max(rate, growth_under(proofs.back(), mode));
    }
    return held_output_bound(subject, proofs, -2.0 * rate, assumptions);
  }

 private:
  /// Of |e|_P along ė = (A − L_c C_c) e at most.
  static double growth_under(const ModalProof& proof, const ModeMatrices& mode) {
    const double least = std::sqrt(positive_least_eigenvalue(proof.P, of_mode("P", mode)));
    const double injected = norm_into(proof.P, proof.L_c) * norm2(mode.C_c) / least;
    return growth_above(proof.P, mode.A - proof.L_c * mode.C_c) + 1e-13 * injected;
  }
};

}  // namespace

const Theorem& bernard2022_section7_3_1() {
  static const Section731 theorem;
  return theorem;
}

}  // namespace sampled_data_observers

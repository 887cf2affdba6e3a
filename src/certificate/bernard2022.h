#pragma once

#include <string>
#include <vector>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// @throws std::invalid_argument saying why, for a plant that is switched, has no linear flow or
/// does not jump.
void require_linear_jumping_plant(const CertificateSubject& subject);

/// Which of the conditions (C) of bernard2022 are used: (C1), a_c < 0, or (C2), a_d < 0.
enum class FlowOfError { kDecays, kMayGrow };

/// The rates of bernard2022, Theorem 3.1: V̇ <= a_c V and V⁺ <= e^{a_d} V.
///
/// For times τ between jumps in [T1, T2], the symbols are flow_decay = −a_c > 0 or
/// flow_growth = a_c > 0, and jump_decay > 0, with which a_d = −a_c T − 2 jump_decay, T = T1 for a
/// decay and T2 for a growth: then a_c τ + a_d <= −2 jump_decay. Any a_c and a_d that satisfy (C1a)
/// or (C2a) strictly do so for some jump_decay; in (C2a), a_c <= 0 may be replaced by a small
/// growth.
///
/// For a dwell time, decay > 0 [1/s] takes the place of jump_decay. With N <= t/tau + N0 jumps and
/// a_d = (flow_decay − 2 decay) tau >= 0 (C1b), or N >= t/tau − N0 jumps and
/// a_d = −(flow_growth + 2 decay) tau < 0 (C2b), V(t) <= e^{a_c t + a_d N} V(0) is at most
/// e^{|a_d| N0 − 2 decay t} V(0).
struct LyapunovRates {
  MatrixExpression a_c;
  MatrixExpression a_d;
  /// Of the rates and the times.
  std::vector<Condition> domains;
};
LyapunovRates lyapunov_rates(const CertificateSubject& subject, FlowOfError kind);

/// What the theorems with lyapunov_rates() have in common.
class LyapunovTheorem : public Theorem {
 public:
  LyapunovTheorem(FlowOfError kind, TheoremTimes times) : kind_(kind), times_(times) {}

  TheoremTimes times() const override { return times_; }
  /// "flow_decay" or "flow_growth", and the rate of convergence.
  std::vector<NamedShape> parameters(const CertificateSubject& subject) const override;
  /// "jump_decay" or, with a dwell time, "decay".
  std::string decay_parameter() const override;
  GuaranteedFigure decay_figure(const NamedMatrices& values) const override;
  /// With a dwell time e^{|a_d| N0 / 2}.
  std::vector<GuaranteedFigure> guaranteed_figures(const CertificateSubject& subject,
                                                   const NamedMatrices& values) const override;

 protected:
  FlowOfError kind() const { return kind_; }

 private:
  FlowOfError kind_;
  TheoremTimes times_;
};

/// bernard2022, Theorem 3.1 for V = eᵀ P e, ė = flow e, e⁺ = reset e, with lyapunov_rates().
/// @param source  where its inequalities stand, without the closing "a)" and "b)"
std::vector<Condition> quadratic_conditions(const CertificateSubject& subject, FlowOfError kind,
                                            const MatrixExpression& flow,
                                            const MatrixExpression& reset,
                                            const std::string& source);

/// What jump_decay guarantees: of the error, from jump to jump.
GuaranteedFigure jump_decay_figure(const NamedMatrices& values);

/// How the condition of a metric on its outputs at jumps is called, which no design solves for: it
/// is about P⁻¹, and holds unless outputs are all but the same.
constexpr const char* kIndependentOutputs = "independent outputs";

// Values of flow_decay and flow_growth [1/s] among which to search.
SearchRange flow_decay_range(const CertificateSubject& subject);
SearchRange flow_growth_range(const CertificateSubject& subject);

}  // namespace sampled_data_observers

#pragma once

#include <string>
#include <vector>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// @throws std::invalid_argument saying why, for a plant that is switched, has no linear flow or
/// does not jump.
void require_linear_jumping_plant(const CertificateSubject& subject);

/// Which of the conditions (C) of bernard2022 are used: (C1a), a_c < 0, or (C2a), a_d < 0.
enum class FlowOfError { kDecays, kMayGrow };

/// bernard2022, Theorem 3.1 for V = eᵀ P e, ė = flow e, e⁺ = reset e: V̇ <= a_c V and
/// V⁺ <= e^{a_d} V. The symbols are P, flow_decay = −a_c > 0 or flow_growth = a_c > 0, and
/// jump_decay > 0, with which a_d = −a_c T − 2 jump_decay, T = T1 for a decay and T2 for a growth:
/// then a_c τ + a_d <= −2 jump_decay for all times τ between jumps. Any a_c and a_d that satisfy
/// (C1a) or (C2a) strictly do so for some jump_decay; in (C2a), a_c <= 0 may be replaced by a
/// small growth.
/// @param source  where its inequalities stand, without the closing "a)" and "b)"
std::vector<Condition> quadratic_conditions(const CertificateSubject& subject, FlowOfError kind,
                                            const MatrixExpression& flow,
                                            const MatrixExpression& reset,
                                            const std::string& source);

/// What its theorems guarantee as decay: of the error, from jump to jump.
GuaranteedFigure jump_decay_figure(const NamedMatrices& values);

/// Values of flow_decay [1/s] among which to search.
SearchRange flow_decay_range(const CertificateSubject& subject);

}  // namespace sampled_data_observers

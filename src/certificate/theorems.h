#pragma once

#include <string>
#include <vector>

#include "sampled_data_observers/certificate/certificate.h"

namespace sampled_data_observers {

// One source file each, or each family.
const Theorem& bernard2022_corollary5_2();
const Theorem& bernard2022_equation14();
const Theorem& bernard2022_equation22();
const Theorem& bernard2022_equation26();
const Theorem& bernard2022_example4_2();
const Theorem& bernard2022_example7_1();
const Theorem& bernard2022_section7_3_2();
const Theorem& etienne2019_proposition1();
const Theorem& etienne2019_proposition2();
const Theorem& ferrante2019_theorem2();

// What those of bernard2022 share.

/// @throws std::invalid_argument saying why, for a plant that is switched, has no linear flow or
/// does not jump.
void require_linear_jumping_plant(const CertificateSubject& subject);

/// bernard2022, Theorem 3.1 for V = eᵀ P e, ė = flow e, e⁺ = reset e, with the symbols P, a_c, a_d.
/// @param source  where its inequalities stand, without the closing "a)" and "b)"
std::vector<Condition> quadratic_conditions(const CertificateSubject& subject,
                                            const MatrixExpression& flow,
                                            const MatrixExpression& reset,
                                            const std::string& source);

}  // namespace sampled_data_observers

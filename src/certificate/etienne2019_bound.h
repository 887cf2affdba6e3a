#pragma once

#include <memory>
#include <vector>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// R_i = A + Ψ_i, between which the flow of the error lies, or A alone for a linear plant; n x n.
std::vector<Eigen::MatrixXd> etienne2019_flows(const PlantMatrices& plant);

/// The bound by V(z) = zᵀ P z of etienne2019, Theorem 1: from a sample on, V̇ = −α V + level² at
/// worst.
/// @param values  P, L and alpha
/// @param level  bound on γ |Γ|; 0 for Proposition 1, which is about Γ = 0
std::unique_ptr<const ErrorBound> etienne2019_bound(const CertificateSubject& subject,
                                                    const NamedMatrices& values, double level,
                                                    const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers

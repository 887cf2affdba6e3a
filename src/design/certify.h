#pragma once

#include "design/design_method.h"
#include "design/final_error.h"

namespace sampled_data_observers {

/// By how much a least gamma is enlarged, so that its proof does not lie on the edge.
constexpr double kGammaInflation = 1.001;
/// The same where gamma is neither given nor asked for: without an end, it would say nothing.
constexpr double kUnaskedGammaInflation = 1.01;

/// A candidate of these values, checked by the theorem's own conditions.
/// @param values  of all that the theorem names, or of fewer, which is no proof
DesignCandidate judged(const Theorem& theorem, const CertificateSubject& subject,
                       NamedMatrices values, Objective objective, DesignCandidate candidate);

/// Proves given gains: looks for the theorem's multipliers with everything else fixed, where its
/// conditions are linear matrix inequalities, and checks the conditions themselves.
///
/// With Objective::kMinGamma, or where `fixed` has no gamma, the least gamma is found first, and
/// then a proof as far inside as possible for a gamma enlarged by kGammaInflation or
/// kUnaskedGammaInflation.
///
/// @param fixed  gains and parameters of the theorem; multipliers among them are left as they are
DesignCandidate certify_here(const Theorem& theorem, const CertificateSubject& subject,
                             const NamedMatrices& fixed, Objective objective);

/// Proves given gains for the least bound on the final error (final_error.h) with everything else
/// fixed: first the least level, then a proof as far inside as possible for a slightly larger one.
/// @param weights  of each entry of the error, whose weighted norm the level is about
DesignCandidate certify_final_error(const Theorem& theorem, const CertificateSubject& subject,
                                    const NamedMatrices& fixed, const Eigen::VectorXd& weights,
                                    const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers

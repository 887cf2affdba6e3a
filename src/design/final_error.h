#pragma once

#include "certificate/error_system.h"
#include "certificate/timer_dependent_conditions.h"
#include "design/design_method.h"

namespace sampled_data_observers {

// The objective min-final-error: the least bound on the error that noise and disturbance leave in
// the end, as the theorem's own ErrorBound gives it at run time.

/// Names of the assumptions among the parameters of an attempt, and of the level that is minimized:
/// the square of the final bound, or what it grows with.
constexpr const char* kNoise = "noise";
constexpr const char* kDisturbance = "disturbance";
constexpr const char* kFinalErrorLevel = "final_error_level";
/// By how much a least level is enlarged, so that what is found does not lie on the edge.
constexpr double kFinalErrorRoom = 1.01;

/// What bounds the final error at such a level, but for a factor that is common to all gains.
double final_error_of_level(const Theorem& theorem, const CertificateSubject& subject,
                            const NamedMatrices& fixed, double level);

/// Noise and disturbance of an attempt's parameters.
ErrorAssumptions final_error_assumptions(const Parameters& parameters);

/// Rates of convergence among which the one of the least final error is searched for [1/s]. Without
/// disturbance the slowest gains are the best: unless that is accepted, the error shall fall by e
/// in at most twenty times T2 then.
SearchRange final_error_rates(const CertificateSubject& subject,
                              const ErrorAssumptions& assumptions, bool accepts_slow);

/// Factors by which V falls at events among which the one of the least final error is searched for,
/// where the function falls at them: likewise.
SearchRange final_error_falls(bool accepts_slow);

/// Whether the certificate gives a bound at run time under such assumptions.
bool has_bound_for(const Certificate& certificate, const ErrorAssumptions& assumptions);

/// Whether the theorem says what disturbances do to the error.
bool bounds_disturbances(const Theorem& theorem);

/// Whether the theorem's final error has a level that semidefinite programs can minimize.
bool has_final_error_level(const Theorem& theorem, const CertificateSubject& subject);

/// Minimizes the level in a program with the theorem's multipliers as variables, and its gains and
/// parameters fixed; or keeps it below parameters[kFinalErrorLevel], where there is one.
/// @param weights  of each entry of the error, whose weighted norm the level is about
void minimize_final_error(LmiProgram& program, const Theorem& theorem,
                          const CertificateSubject& subject, const NamedMatrices& fixed,
                          const Eigen::VectorXd& weights, const Parameters& parameters);

/// The same for any program that has the symbols of a function of timers as variables, or its
/// matrices fixed.
/// @param matrices    which P(τ) is never less than the least of, where they are variables
/// @param parameters  with lambda_t, and mu where the function falls at events
void minimize_timer_dependent_level(LmiProgram& program, const ErrorSystem& system,
                                    const std::vector<MatrixExpression>& matrices,
                                    const CertificateSubject& subject,
                                    const Eigen::VectorXd& weights, const Parameters& parameters);

/// P at all nodes.
std::vector<MatrixExpression> matrices_of(const TimerDependentFunction& function);

/// The same for any program that has P1, P2 and gamma of ferrante2019 as variables.
void minimize_ferrante2019_level(LmiProgram& program, const CertificateSubject& subject,
                                 const Eigen::VectorXd& weights, const Parameters& parameters);

}  // namespace sampled_data_observers

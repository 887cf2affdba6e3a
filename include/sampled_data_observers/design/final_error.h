#pragma once

#include <optional>

#include "sampled_data_observers/design/design_method.h"

namespace sampled_data_observers {

// The objective min-final-error: the least bound on the error that noise and disturbance leave in
// the end, as the theorem's own ErrorBound gives it at run time.

/// Names of the assumptions among the parameters of an attempt, and of the level that is minimized:
/// the square of the final bound, or what it grows with.
constexpr const char* kNoise = "noise";
constexpr const char* kDisturbance = "disturbance";
constexpr const char* kFinalErrorLevel = "final_error_level";
/// By how much a least level is enlarged, so that what is found does not lie on the edge.
constexpr double kFinalErrorRoom = 1.02;

/// What each entry of the error makes of the outputs within ten times T2: what a level weighs it
/// by, so that gains do not depend on units and serve the outputs, too.
Eigen::VectorXd weights_of_design(const CertificateSubject& subject);

/// What bounds the final error at such a level, but for a factor that is common to all gains.
double final_error_of_level(const Theorem& theorem, const CertificateSubject& subject,
                            const NamedMatrices& fixed, double level);

/// Noise and disturbance of an attempt's parameters.
ErrorAssumptions final_error_assumptions(const Parameters& parameters);

/// Rates of convergence among which the one of the least final error is searched for [1/s]. Without
/// disturbance the slowest is best: then the error shall fall by e in at most twenty times T2.
SearchRange final_error_rates(const CertificateSubject& subject,
                              const ErrorAssumptions& assumptions);

/// Where a state's derivative says more than that it is a multiple of another state, forces and
/// faults enter: a column for each of these, so long that w = 1 alone moves the outputs by 1 within
/// ten times T2.
/// @return n x n_w; without columns where the outputs show nothing of any
Eigen::MatrixXd default_disturbance_input(const CertificateSubject& subject);

/// The |w| that moves the outputs by `noise` within ten times T2, for the subject's N; 0 where
/// the outputs show nothing of it.
double default_disturbance(const CertificateSubject& subject, double noise);

/// What a user says of noise and disturbance, if anything.
struct DeclaredAssumptions {
  std::optional<double> noise;
  std::optional<double> disturbance;
};

/// Sets what the final error is due to: as declared, or a noise of 1 and a disturbance that shows
/// as much within ten times T2, which enters where default_disturbance_input() says if the
/// problem has no N. A performance output plays no part: it is dropped.
void assume(const DeclaredAssumptions& declared, DesignProblem& problem);

/// Whether the certificate gives a bound at run time under such assumptions.
bool has_bound_for(const Certificate& certificate, const ErrorAssumptions& assumptions);

/// Whether the theorem says what disturbances do to the error.
bool bounds_disturbances(const Theorem& theorem);

/// Whether the theorem's final error has a level that semidefinite programs can minimize.
bool has_final_error_level(const Theorem& theorem);

/// Minimizes the level in a program with the theorem's multipliers as variables, and its gains and
/// parameters fixed; or keeps it below parameters[kFinalErrorLevel], where there is one.
/// @param weights  of each entry of the error, whose weighted norm the level is about
void minimize_final_error(LmiProgram& program, const Theorem& theorem,
                          const CertificateSubject& subject, const NamedMatrices& fixed,
                          const Eigen::VectorXd& weights, const Parameters& parameters);

/// The same for any program that has P1, P2 and gamma of ferrante2019 as variables.
void minimize_ferrante2019_level(LmiProgram& program, const CertificateSubject& subject,
                                 const Eigen::VectorXd& weights, const Parameters& parameters);

/// What the bound at run time does under the assumptions on noise and disturbance, over samples
/// that all come after T1, all after T2, or after both in turn, whichever is worst.
struct RunTimeFigures {
  /// Of the bound in the end, units of the state.
  double final_error = 0.0;
  /// The largest bound over an initial error, without noise and disturbance.
  double factor_on_start = 0.0;
  /// When the bound has fallen to a hundredth of the initial error for good, without noise and
  /// disturbance [s]; infinite where it has not in a million samples.
  double time_to_hundredth = 0.0;
};

/// @pre the conditions hold
/// @throws std::invalid_argument where the theorem has no bound for such assumptions
RunTimeFigures run_time_figures(const Theorem& theorem, const CertificateSubject& subject,
                                const NamedMatrices& values, const ErrorAssumptions& assumptions);

/// Only the first of the figures.
double final_error(const Theorem& theorem, const CertificateSubject& subject,
                   const NamedMatrices& values, const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers

#include "tools/design/run_time_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "design/final_error.h"
#include "design/run_time_figures.h"
#include "design/worst_intervals.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Above these, a figure is worth a note.
constexpr double kManyIntervals = 1000.0;
constexpr double kLargeAmplification = 100.0;
constexpr double kLargeFactor = 1e4;

/// By how much the bound after irregular times must be larger than after regular ones to be told.
constexpr double kWorthALine = 1.001;

std::string columns_of(const Eigen::MatrixXd& N) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < N.rows(); ++i) {
    text += i == 0 ? "[" : ", [";
    for (Eigen::Index j = 0; j < N.cols(); ++j) {
      char number[32];
      std::snprintf(number, sizeof number, "%s%.4g", j == 0 ? "" : ", ", N(i, j));
      text += number;
    }
    text += "]";
  }
  return text + "]";
}

void note_what_is_of_little_use(const Certificate& certificate, const RunTimeFigures& figures,
                                const ErrorAssumptions& assumptions) {
  const double T2 = certificate.subject.T2;
  if (!(figures.time_to_hundredth < kManyIntervals * T2)) {
    std::printf(
        "note: these gains hardly correct: by its bound the error falls to a hundredth in more "
        "than %g times T2.\nA larger rate of convergence (--set %s=NUMBER), or a shorter T2, makes "
        "them correct more.\n",
        std::floor(std::min(figures.time_to_hundredth / T2, 1e6)),
        certificate.theorem->decay_parameter().empty()
            ? "lambda"
            : certificate.theorem->decay_parameter().c_str());
  }
  if (figures.factor_on_start > kLargeFactor) {
    std::printf(
        "note: the bound begins at %.3g times the initial error: it says little until it has "
        "fallen.\n",
        figures.factor_on_start);
  }
  const double seen = norm2(certificate.subject.plant.C()) * figures.final_error;
  if (assumptions.disturbance == 0.0 && seen > kLargeAmplification * assumptions.noise) {
    std::printf(
        "note: the bound in the end is %.3g times the noise: these gains, or their proof, amplify "
        "noise.\n--objective min-final-error looks for the least.\n",
        seen / assumptions.noise);
  }
}

/// Whether events have no shortest interval: the figures are then about such that come after T2.
bool may_follow_at_once(const CertificateSubject& subject) {
  if (subject.dwell_time) return false;
  const auto& times = subject.sensor_times;
  if (times.empty()) return !(subject.T1 > 0.0);
  return std::any_of(times.begin(), times.end(),
                     [](const SamplingTimes& sensor) { return !(sensor.T1 > 0.0); });
}

}  // namespace

void print_assumptions(const DeclaredAssumptions& declared, const DesignProblem& problem,
                       const std::vector<std::string>& states) {
  const ErrorAssumptions& assumptions = problem.assumptions;
  std::printf("Designed for |noise| <= %.6g%s", assumptions.noise,
              declared.noise ? "" : " (assumed: error_assumptions/noise is not given)");
  if (assumptions.disturbance == 0.0) {
    std::printf(" and no disturbance.\n");
    return;
  }
  std::printf("\nand |disturbance| <= %.6g, with N = %s%s.\n", assumptions.disturbance,
              columns_of(problem.subject.plant.N).c_str(),
              declared.disturbance ? ""
                                   : "\n(assumed: what moves the outputs by as much as the noise "
                                     "within five times T2; design/N and\n"
                                     "error_assumptions/disturbance say it otherwise)");
  const Eigen::MatrixXd& N = problem.subject.plant.N;
  std::printf("The guarantee is for plants that are not off by more than that:\n");
  for (Eigen::Index i = 0; i < N.rows(); ++i) {
    const double off = N.row(i).norm() * assumptions.disturbance;
    if (off > 0.0) {
      std::printf("  the derivative of %s by up to %.3g\n",
                  states[static_cast<std::size_t>(i)].c_str(), off);
    }
  }
}

void print_run_time_figures(const Design& main, const ErrorAssumptions& assumptions) {
  const Design& design = main.for_run_time ? *main.for_run_time : main;
  const Certificate& certificate = design.certificate;
  ErrorAssumptions bounded = assumptions;
  // A proof without N is about plants without disturbance.
  if (certificate.subject.plant.N.cols() == 0) bounded.disturbance = 0.0;
  if (!has_bound_for(certificate, bounded)) bounded.disturbance = 0.0;
  if (!has_bound_for(certificate, bounded)) bounded.noise = 0.0;
  if (!has_bound_for(certificate, bounded)) return;
  const RunTimeFigures figures =
      run_time_figures(*certificate.theorem, certificate.subject, certificate.values, bounded);
  std::printf("The bound on the error at run time, by the proof for %s:\n",
              to_string(design.objective));
  std::printf("  in the end, for |noise| <= %.6g", bounded.noise);
  if (bounded.disturbance > 0.0) std::printf(" and |disturbance| <= %.6g", bounded.disturbance);
  std::printf(": %.6g\n", figures.final_error);
  const std::optional<double> irregular = worst_intervals_final_error(
      *certificate.theorem, certificate.subject, certificate.values, bounded);
  if (irregular && *irregular > kWorthALine * figures.final_error) {
    std::printf("    after the worst irregular times that were found: %.6g\n", *irregular);
  }
  if (bounded.noise > 0.0 && may_follow_at_once(certificate.subject)) {
    std::printf("    of events T2 apart: T1 is 0, and of denser ones noise may leave more\n");
  }
  if (certificate.subject.error_weights.size() > 0) {
    std::printf(
        "  the same, weighted by design/weights: %.6g\n",
        final_error(*certificate.theorem, certificate.subject, certificate.values, bounded));
  }
  std::printf("  largest, over the initial error: %.6g\n", figures.factor_on_start);
  if (std::isfinite(figures.time_to_hundredth)) {
    std::printf("  time until it has fallen to 1/100 of the initial error: %.6g s\n",
                figures.time_to_hundredth);
  } else {
    std::printf("  it does not fall to 1/100 of the initial error\n");
  }
  note_what_is_of_little_use(certificate, figures, bounded);
}

}  // namespace sampled_data_observers

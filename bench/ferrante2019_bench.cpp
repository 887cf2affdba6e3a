// Designs over the grid of Table II of ferrante2019, 100 values of delta times 20 of T2 on the
// flexible link: time on the clock and of the processors, and how many gains Theorem 2 accepts,
// beside the paper's times.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "config/design_config.h"
#include "design/design_method.h"
#include "design/threads.h"
#include "design/workers.h"

namespace sdo = sampled_data_observers;

namespace {

constexpr char kVerified = 'v';
constexpr char kViolated = 'x';

struct Row {
  const char* method;
  /// Whether each design is analysed further by Theorem 2, as in the paper.
  bool is_analysed;
  const char* seconds_in_paper;
};

/// `steps` equidistant values.
double value(double low, double high, std::size_t i, std::size_t steps) {
  return low + (high - low) * static_cast<double>(i) / static_cast<double>(steps - 1);
}

/// Processor time of this process, and of the other solver's, which have ended [s].
double worked_seconds() {
  double seconds = 0.0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    ::getrusage(who, &usage);
    seconds += static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
               1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  }
  return seconds;
}

void run(const Row& row, const sdo::DesignConfig& config, unsigned jobs) {
  constexpr std::size_t kDeltas = 100;
  constexpr std::size_t kTimes = 20;
  const auto& method =
      dynamic_cast<const sdo::LmiDesignMethod&>(*sdo::find_design_method(row.method));
  /// Gains for all times between samples up to T2 are some for all up to less: what the solver
  /// calls infeasible is so for each larger T2 at the same delta, too, and is not tried.
  std::vector<std::string> found(kDeltas);
  const auto task = [&](std::size_t i) {
    for (std::size_t j = 0; j < kTimes; ++j) {
      sdo::CertificateSubject subject = config.subject;
      subject.T2 = value(0.01, 0.3, j, kTimes);
      subject.T1 = 0.0;
      const sdo::Parameters parameters = {{"lambda_t", 0.01},
                                          {"gain_bound", 1000.0},
                                          {"a", 1.0},
                                          {"delta", value(1.0, 100.0, i, kDeltas)}};
      const auto objective = sdo::Objective::kMinGamma;
      const sdo::DesignCandidate candidate = row.is_analysed
                                                 ? method.attempt(subject, parameters, objective)
                                                 : method.solve(subject, parameters, objective);
      if (candidate.values.empty()) break;
      found[i] += candidate.is_verified() ? kVerified : kViolated;
    }
  };
  sdo::ThreadOptions options;
  options.jobs = jobs;
  const double worked = worked_seconds();
  const auto start = std::chrono::steady_clock::now();
  const auto outcomes = sdo::run_in_threads(kDeltas, task, options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::size_t verified = 0;
  std::size_t violated = 0;
  for (const std::string& of_delta : found) {
    for (const char one : of_delta) ++(one == kVerified ? verified : violated);
  }
  const auto lost = static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(), [](const sdo::ThreadOutcome& outcome) {
        return outcome.status != sdo::ThreadOutcome::Status::kDone;
      }));
  std::printf("%-26s %-10s %9.2f %9.2f %9s %9zu %9zu %9zu\n", row.method,
              row.is_analysed ? "and proof" : "", seconds, worked_seconds() - worked,
              row.seconds_in_paper, verified, violated, lost);
  std::fflush(stdout);
}

}  // namespace

int main() {
  const sdo::DesignConfig config = sdo::read_design_config(
      {std::string(SDO_SOURCE_DIR) + "/config/examples/ferrante2019_flexible_link/plant.yaml"},
      nullptr);
  const unsigned jobs = sdo::default_jobs();
  std::printf("2000 designs each, %u at a time\n%-37s %9s %9s %9s %9s %9s %9s\n", jobs, "",
              "time [s]", "CPU [s]", "paper [s]", "verified", "violated", "lost");
  const std::vector<Row> rows = {
      {"ferrante2019_proposition2", false, "716.6"}, {"ferrante2019_proposition3", false, "866.4"},
      {"ferrante2019_proposition4", false, "-"},     {"ferrante2019_proposition5", false, "1192.2"},
      {"ferrante2019_proposition5", true, "1199.2"},
  };
  for (const Row& row : rows) run(row, config, jobs);
  return 0;
}

// Time of a design by a Lyapunov function that depends on timers, and of its proof in ball
// arithmetic, over the number of states, sensors and cells: for chains of two integrators, whose
// first states one sensor measures, or several, each in intervals of its own. One attempt each, at
// one rate, for the least gamma. Compare within one run: machines differ.
#include <Eigen/Core>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "certificate/timer_grid.h"
#include "design/certificate_proof.h"
#include "design/design_method.h"
#include "design/workers.h"

namespace sdo = sampled_data_observers;

namespace {

sdo::CertificateSubject chains(Eigen::Index n, Eigen::Index sensors, int cells) {
  const Eigen::Index outputs = n / 2;
  sdo::ModeMatrices mode;
  mode.A = Eigen::MatrixXd::Zero(n, n);
  mode.A.topRightCorner(outputs, outputs).setIdentity();
  mode.C = Eigen::MatrixXd::Identity(outputs, n);
  mode.C_c.resize(0, n);
  mode.C_d.resize(0, n);
  sdo::CertificateSubject subject;
  subject.plant.modes = {mode};
  for (Eigen::Index i = 0; i < n; ++i) {
    subject.plant.state_names.push_back("x" + std::to_string(i));
  }
  subject.plant.G.resize(n, 0);
  subject.plant.S.resize(0, n);
  subject.plant.N = Eigen::MatrixXd::Identity(n, n).rightCols(outputs);
  subject.plant.C_p = mode.C;
  const Eigen::Index rows = outputs / sensors;
  std::vector<sdo::SamplingTimes> times;
  for (Eigen::Index i = 0; i < sensors; ++i) {
    subject.plant.sampled.push_back(
        {"sensor" + std::to_string(i), static_cast<std::size_t>(i), i * rows, rows});
    times.push_back({0.05, 0.2 + 0.05 * static_cast<double>(i)});
  }
  subject.T1 = times.front().T1;
  subject.T2 = times.front().T2;
  if (sensors > 1) sdo::set_sensor_times(subject, times);
  return sdo::with_cells(subject, cells);
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Row {
  Eigen::Index n;
  Eigen::Index sensors;
  int cells;
};

/// Times and figures, or why there are none.
std::string measured(const Row& row) {
  const sdo::CertificateSubject subject = chains(row.n, row.sensors, row.cells);
  const sdo::DesignMethod& method = *sdo::find_design_method(
      row.sensors == 1 ? "timer_dependent_constant_gain" : "timer_dependent_scheduled_gain");
  sdo::DesignCandidate found;
  const double design = seconds_of([&] {
    found = method.attempt(subject, {{"lambda_t", 0.05}}, sdo::Objective::kMinGamma);
  });
  if (!found.is_verified()) return "no design: " + found.message;
  std::size_t proved = 0;
  const double proof = seconds_of([&] {
    for (const sdo::ConditionProof& condition :
         sdo::prove({&method.theorem(), subject, found.values}, {})) {
      if (condition.status == sdo::ProofStatus::kProved) ++proved;
    }
  });
  char text[100];
  std::snprintf(text, sizeof text, "%9.3f %9.4f %7zu %8.4g", design, proof, proved,
                found.values.at("gamma")(0, 0));
  return text;
}

}  // namespace

int main() {
  const std::vector<Row> rows = {{2, 1, 4},  {2, 1, 8}, {2, 1, 16}, {4, 1, 4}, {4, 1, 8},
                                 {4, 1, 16}, {6, 1, 4}, {6, 1, 8},  {8, 1, 4}, {10, 1, 4},
                                 {2, 1, 2},  {4, 2, 2}, {4, 2, 4},  {6, 3, 2}};
  std::printf("%2s %7s %5s %9s %9s %7s %8s\n", "n", "sensors", "cells", "design[s]", "proof [s]",
              "proved", "gamma");
  sdo::WorkerOptions options;
  options.jobs = 1;
  options.on_outcome = [&](std::size_t i, const sdo::WorkerOutcome& outcome) {
    std::printf("%2td %7td %5d %s\n", rows[i].n, rows[i].sensors, rows[i].cells,
                outcome.result.c_str());
    std::fflush(stdout);
  };
  sdo::run_in_workers(
      rows.size(), [&](std::size_t i) { return measured(rows[i]); }, options);
  return 0;
}

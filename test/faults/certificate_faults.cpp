// What an observer's certificate rests on does not hold for a while.
#include <cmath>

#include "faults/fault.h"
#include "faults/messages.h"

namespace sampled_data_observers::test {
namespace {

void go_on_until_certificate(FaultBench& bench, const std::string& says) {
  for (int i = 0; bench.diagnosis("certificate").find(says) != 0; ++i) {
    if (i == 1500) throw std::runtime_error("certificate: " + bench.diagnosis("certificate"));
    bench.go_on(0.15);
    spin_until([&] { return bench.diagnosis("certificate").find(says) == 0; }, 0.02);
  }
}

/// Diagnostics come each second of wall time.
void silence(FaultBench& bench) {
  bench.let_pass(1.0);
  go_on_until_certificate(bench, "suspended since");
  go_on_until_certificate(bench, "restored at");
}

double error_bound(FaultBench& bench) {
  bench.await_estimates();
  return bench.estimates.back().error_bound;
}

/// The guaranteed bound on the error must grow in a gap, and fall again with the samples after it.
void growing_bound(FaultBench& bench) {
  bench.go_on(3.0);
  const double before = error_bound(bench);
  if (!std::isfinite(before)) throw std::runtime_error("no bound");
  bench.let_pass(0.6);
  const double gap = error_bound(bench);
  if (!std::isfinite(gap) || gap < 1.1 * before) throw std::runtime_error("it does not grow");
  bench.go_on(3.0);
  if (error_bound(bench) > 0.95 * gap) throw std::runtime_error("it does not fall again");
}

}  // namespace

std::vector<Fault> certificate_faults() {
  return {
      {"Suspended",
       "certified",
       "1 s without samples, where the certificate is for 0.2 s: it is "
       "suspended, and restored",
       silence,
       {},
       Meanwhile::kRight,
       3.0},
      {"BoundGrows",
       "bounded",
       "0.6 s without samples, where the certificate is for 0.2 s: the error bound grows, and "
       "falls "
       "again with the samples after",
       growing_bound,
       {},
       Meanwhile::kRight,
       3.0},
  };
}

}  // namespace sampled_data_observers::test

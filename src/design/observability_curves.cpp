#include <algorithm>
#include <cmath>

#include "design/explanation.h"
#include "design/observability.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr int kPoints = 400;
/// A pathological interval is drawn where it is not farther than this many times T2.
constexpr double kFar = 10.0;

double first_pathological(const ModeMatrices& mode) {
  const auto all = pathological_intervals(mode.A, mode.C, longest_beat(mode.A));
  return all.empty() ? 0.0 : all.front().tau;
}

double longest_drawn(const CertificateSubject& subject) {
  const double T2 = longest_looked_at(subject);
  double longest = 1.5 * T2;
  for (const ModeMatrices& mode : subject.plant.modes) {
    const double first = mode.C.rows() > 0 ? 1.1 * first_pathological(mode) : 0.0;
    if (T2 == 0.0 || first <= kFar * T2) longest = std::max(longest, first);
  }
  if (longest > 0.0) return longest;
  const double scale = norm2(subject.plant.A());
  return scale > 0.0 ? 5.0 / scale : 1.0;
}

}  // namespace

std::vector<ObservabilityCurve> observability_curves(const CertificateSubject& subject) {
  std::vector<double> times;
  const double longest = longest_drawn(subject);
  for (int i = 1; i <= kPoints; ++i) times.push_back(longest * i / kPoints);
  const std::vector<double> dips = pathological_times(subject);
  times.insert(times.end(), dips.begin(), dips.end());
  std::sort(times.begin(), times.end());
  std::vector<ObservabilityCurve> curves;
  for (const ModeMatrices& mode : subject.plant.modes) {
    const std::string name =
        subject.plant.modes.size() > 1 ? ", mode " + std::to_string(mode.label) : "";
    const auto add_sampled = [&](const Eigen::MatrixXd& C, const std::string& of) {
      ObservabilityCurve curve{
          "samples" + of + " tau apart: least singular value" + name, times, {}};
      for (const double tau : times) {
        curve.value.push_back(sampled_observability(mode.A, C, tau));
      }
      curves.push_back(std::move(curve));
    };
    const std::vector<SampledOutputs>& sensors = subject.plant.sampled;
    if (mode.C.rows() > 0) add_sampled(mode.C, sensors.size() > 1 ? " of all sensors" : "");
    for (std::size_t i = 0; sensors.size() > 1 && i < sensors.size(); ++i) {
      add_sampled(mode.C.middleRows(sensors[i].first, sensors[i].rows),
                  " of " + sensors[i].sensor + " alone");
    }
    if (mode.A_d && mode.C_d.rows() > 0) {
      ObservabilityCurve curve{"jumps tau apart: detectability margin" + name, {}, {}};
      for (const double tau : times) {
        const DiscretePair pair = pair_at_jumps(mode.A, *mode.A_d, mode.C_d, tau);
        const double margin = detectability_margin(pair.F, pair.H, TimeDomain::kDiscrete);
        if (!std::isfinite(margin)) continue;  // all decays: nothing need be seen
        curve.tau.push_back(tau);
        curve.value.push_back(margin);
      }
      if (!curve.tau.empty()) curves.push_back(std::move(curve));
    }
  }
  return curves;
}

std::vector<double> pathological_times(const CertificateSubject& subject) {
  std::vector<double> times;
  for (const ModeMatrices& mode : subject.plant.modes) {
    if (mode.C.rows() == 0) continue;
    for (const PathologicalInterval& interval :
         pathological_intervals(mode.A, mode.C, longest_drawn(subject))) {
      times.push_back(interval.tau);
    }
  }
  return times;
}

}  // namespace sampled_data_observers

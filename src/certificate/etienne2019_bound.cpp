#include "certificate/etienne2019_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "certificate/bound_flow.h"
#include "certificate/interval_bound.h"
#include "certificate/outward.h"
#include "certificate/sublevel_set.h"
#include "certificate/weighted_norm.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Until the first sample nothing is injected and the error flows as the plant does; later than T2
/// after a sample it flows so, too, and is driven by what is held of that sample, L (C z + σ). The
/// theorem goes on from the next sample, whatever z is there: what it adds to V is zero at samples.
class IssBound : public SampledErrorBound {
 public:
  IssBound(const CertificateSubject& subject, const NamedMatrices& values, double level,
           const ErrorAssumptions& assumptions)
      : SampledErrorBound(subject, assumptions, kEntries), rate_(scalar_value(values, "alpha")) {
    const Eigen::MatrixXd& P = values.at("P");
    const Eigen::MatrixXd& N = subject.plant.N;
    const Eigen::MatrixXd& L = values.at("L");
    final_ = raised(level * level / rate_);
    per_error_ = std::sqrt(largest_eigenvalue_above(P));
    least_ = positive_least_eigenvalue(P, "P");
    set_ = SublevelSet(P, least_);
    growth_ = -std::numeric_limits<double>::infinity();
    for (const Eigen::MatrixXd& flow : etienne2019_flows(subject.plant)) {
      growth_ = std::max(growth_, growth_above(P, flow));
    }
    push_ = norm_into(P, N) * assumptions.disturbance;
    held_ = norm_between(P, P, MatrixExpression(L) * subject.plant.C());
    held_noise_ = norm_into(P, L) * assumptions.noise;
  }

  bool injects_between_samples() const override { return true; }

 protected:
  void begin_numbers(double error, double* numbers) const override {
    numbers[kRootOfV] = per_error_ * error;
    numbers[kAtSample] = 0.0;
  }
  void narrow_numbers(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* numbers) const override {
    numbers[kRootOfV] = std::min(numbers[kRootOfV], set_.radius_around(Q));
  }
  void flow_numbers(double duration, const Interval& from, double* numbers) const override {
    double& root = numbers[kRootOfV];
    if (from.is_first) {
      root = flowed_linearly(root, growth_, push_, duration);
      return;
    }
    const double foreseen = foreseen_part(duration, from.tau);
    root = std::sqrt(decayed(root * root, final_, rate_, foreseen));
    if (is_late(from.tau + duration)) {
      root = flowed_linearly(root, growth_, push_ + held_ * numbers[kAtSample] + held_noise_,
                             duration - foreseen);
    }
  }
  void sample_numbers(const Interval&, double* numbers, double*) const override {
    numbers[kAtSample] = numbers[kRootOfV];
  }
  double error(const Interval&, const double* numbers) const override {
    return numbers[kRootOfV] / std::sqrt(least_);
  }
  void errors(const Interval&, const double* numbers, double*,
              Eigen::Ref<Eigen::VectorXd> bounds) const override {
    set_.bounds(numbers[kRootOfV], bounds);
  }
  void error_ellipsoid(const Interval&, const double* numbers, double*,
                       Eigen::Ref<Eigen::MatrixXd> Q) const override {
    set_.ellipsoid(numbers[kRootOfV], Q);
  }

 private:
  enum Entry { kRootOfV, kAtSample, kEntries };  // √V now, and just after the last sample

  double rate_;
  double final_ = 0.0;  // of V
  double per_error_ = 0.0;
  double least_ = 0.0;
  SublevelSet set_;  // of V
  double growth_ = 0.0;
  double push_ = 0.0;
  double held_ = 0.0;        // ‖L C‖ in the norm of P
  double held_noise_ = 0.0;  // |L σ| in it
};

}  // namespace

std::vector<Eigen::MatrixXd> etienne2019_flows(const PlantMatrices& plant) {
  if (plant.is_linear()) return {plant.A()};
  std::vector<Eigen::MatrixXd> R;
  for (const Eigen::MatrixXd& vertex : plant.vertices) R.emplace_back(plant.A() + vertex);
  return R;
}

std::unique_ptr<const ErrorBound> etienne2019_bound(const CertificateSubject& subject,
                                                    const NamedMatrices& values, double level,
                                                    const ErrorAssumptions& assumptions) {
  return std::make_unique<const IssBound>(subject, values, level, assumptions);
}

}  // namespace sampled_data_observers

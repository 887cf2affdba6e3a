#include "design/run_time_norm.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "design/certificate_proof.h"
#include "linear_algebra/matrix_functions.h"
#include "observer/time_varying_gain.h"

namespace sampled_data_observers {
namespace {

constexpr int kTimesFollowed = 25;
constexpr int kTries = 8000;
constexpr double kFirstStep = 0.3;
constexpr int kTriesOfRound = 1000;

/// How large |e| gets in the end by noise of norm 1, bounded as Theorem2Bound does in the norm of
/// Q = Rᵀ R, at many times between samples.
class FollowedError {
 public:
  FollowedError(const CertificateSubject& subject, const NamedMatrices& values) {
    const Eigen::MatrixXd& A = subject.plant.A();
    const Eigen::MatrixXd& C = subject.plant.C();
    const Eigen::MatrixXd P = (values.at("P") + values.at("P").transpose()) / 2.0;
    const CertificateGain gain(C, P, scalar_value(values, "lambda"));
    std::vector<double> workspace(static_cast<std::size_t>(gain.workspace_size()));
    for (int i = 0; i < kTimesFollowed; ++i) {
      const double share = static_cast<double>(i) / (kTimesFollowed - 1);
      flows_.push_back(exponential_of(A * (share * subject.T2)));
      const double tau = subject.T1 + share * (subject.T2 - subject.T1);
      Eigen::MatrixXd K(A.rows(), C.rows());
      const Eigen::MatrixXd backward = exponential_of(-A * tau);
      gain.evaluate(backward.data(), K.data(), workspace.data());
      steps_.push_back(
          {(Eigen::MatrixXd::Identity(A.rows(), A.rows()) - K * C) * exponential_of(A * tau), K});
    }
  }

  /// Infinite where a sample may leave as much as there was.
  double in_norm_of(const Eigen::MatrixXd& R) const {
    const Eigen::MatrixXd inverse_R = inverse_of(R);
    double level = 0.0;
    for (const Step& step : steps_) {
      const double kept = norm2(R * step.kept * inverse_R);
      if (!(kept < 1.0)) return std::numeric_limits<double>::infinity();
      level = std::max(level, norm2(R * step.K) / (1.0 - kept));
    }
    double growth = 0.0;
    for (const Eigen::MatrixXd& flow : flows_) growth = std::max(growth, norm2(flow * inverse_R));
    return level * growth;
  }

 private:
  struct Step {
    Eigen::MatrixXd kept;  ///< (I − K(τ) C) e^{Aτ}
    Eigen::MatrixXd K;
  };
  std::vector<Step> steps_;
  std::vector<Eigen::MatrixXd> flows_;
};

/// In [-1, 1], the same on all machines.
double any(std::mt19937_64& generator) {
  return std::ldexp(static_cast<double>(generator() >> 11U), -52) - 1.0;
}

/// R with entries changed at random, the logarithms of those on the diagonal.
Eigen::MatrixXd changed(Eigen::MatrixXd R, double step, std::mt19937_64& generator) {
  for (Eigen::Index j = 0; j < R.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      const double change = step * any(generator);
      if (any(generator) < 0.0) continue;
      R(i, j) = i == j ? R(i, j) * std::exp(change) : R(i, j) + change * R(i, i);
    }
  }
  return R;
}

Eigen::MatrixXd best_root(const FollowedError& error, Eigen::MatrixXd R) {
  std::mt19937_64 generator(1);
  double least = error.in_norm_of(R);
  double step = kFirstStep;
  for (int i = 0; i < kTries; ++i) {
    if (i % kTriesOfRound == 0) step = kFirstStep;
    const Eigen::MatrixXd next = changed(R, step, generator);
    const double value = error.in_norm_of(next);
    if (value < least) {
      least = value;
      R = next;
      step = std::min(0.5, 1.3 * step);
    } else {
      step = std::max(1e-4, 0.995 * step);
    }
  }
  return R;
}

}  // namespace

std::shared_ptr<const Design> in_better_norm(const Design& design) {
  const Certificate& certificate = design.certificate;
  if (certificate.theorem->name().rfind("sferlazza2019_theorem2", 0) != 0) return nullptr;
  auto found = std::make_shared<Design>(design);
  found->for_run_time = nullptr;
  found->method = "analysis";
  found->objective = Objective::kMinFinalError;
  found->solver = "random search";
  found->parameters.clear();
  Certificate& own = found->certificate;
  own.theorem = find_theorem("sferlazza2019_theorem2_norm");
  own.values.erase("decay");
  const Eigen::MatrixXd& P = certificate.values.at("P");
  const Eigen::MatrixXd R =
      best_root(FollowedError(own.subject, own.values), cholesky_root((P + P.transpose()) / 2.0));
  const Eigen::MatrixXd Q = R.transpose() * R;
  own.values["Q"] = (Q + Q.transpose()) / 2.0;
  found->margin = least_margin(check(own));
  const std::vector<ConditionProof> proofs = prove(own, {});
  const bool is_proved = std::all_of(proofs.begin(), proofs.end(), [](const ConditionProof& proof) {
    return proof.status == ProofStatus::kProved;
  });
  if (!(found->margin > 0.0) || !is_proved) return nullptr;
  found->proved_conditions = proofs.size();
  return found;
}

}  // namespace sampled_data_observers

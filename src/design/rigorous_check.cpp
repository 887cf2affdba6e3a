#include "sampled_data_observers/design/rigorous_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <queue>

#include "ball_matrix.h"
#include "sampled_data_observers/certificate/evaluate_expression.h"
#include "sampled_data_observers/certificate/matrix_functions.h"
#include "taylor_matrix.h"

namespace sampled_data_observers {
namespace {

/// Bits; the next one where the rounding of the one before hides the answer.
constexpr slong kPrecisions[] = {128, 256, 1024};
constexpr std::size_t kMaxIntervals = 4096;
constexpr int kMaxBisections = 44;
/// Looked at for a violation after it is known that there is no proof.
constexpr std::size_t kMaxIntervalsWithoutProof = 256;

/// Of τ. The one with the least eigenvalue comes first, since there a violation is to be expected.
struct Interval {
  double low = 0.0;
  double high = 0.0;
  int bisections = 0;
  /// At the centre of the interval that it is a half of.
  double least_eigenvalue = 0.0;

  double centre() const { return low + (high - low) / 2.0; }
  bool operator<(const Interval& other) const { return least_eigenvalue > other.least_eigenvalue; }

  /// Around the centre, with the decimals of which low and high are the nearest doubles.
  double radius() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double reach = std::max(std::nextafter(high, kInfinity) - centre(),
                                  centre() - std::nextafter(low, -kInfinity));
    return std::nextafter(reach, kInfinity);
  }
};

BallMatrix symmetric_part(const BallMatrix& a, slong precision) {
  BallMatrix result = sum(a, transpose(a), precision);
  arb_mat_scalar_mul_2exp_si(result.get(), result.get(), -1);
  return result;
}

/// Not less than vᵀ a v / vᵀ v.
double quotient_bound(const BallMatrix& a, const Eigen::VectorXd& v, slong precision) {
  const BallMatrix vector = exact_balls(v);
  const BallMatrix row = transpose(vector);
  BallMatrix value = product(product(row, a, precision), vector, precision);
  const BallMatrix square = product(row, vector, precision);
  arb_div(value.entry(0, 0), value.entry(0, 0), square.entry(0, 0), precision);
  Ball bound;
  arb_get_ubound_arf(arb_midref(bound.get()), value.entry(0, 0), precision);
  return arf_get_d(arb_midref(bound.get()), ARF_RND_CEIL);
}

std::string text_of(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

class Prover {
 public:
  Prover(const Condition& condition, const NamedMatrices& values)
      : condition_(condition), values_(values) {}

  ConditionProof run() {
    const ConditionCheck guess = check({condition_}, values_).front();
    proof_.name = condition_.name;
    proof_.value = guess.min_eigenvalue;
    proof_.tau = guess.tau;
    if (!std::isfinite(guess.min_eigenvalue)) {
      proof_.reason = "its matrix is not finite";
    } else if (!condition_.tau) {
      const Finding finding = look_at({});
      if (finding == Finding::kPositive) proof_.status = ProofStatus::kProved;
      if (finding == Finding::kUndecidable) leave_undecided({});
    } else if (guess.holds() || look_at({*guess.tau, *guess.tau, 0, 0.0}) != Finding::kNegative) {
      search();
    }
    return proof_;
  }

 private:
  enum class Finding {
    kPositive,    ///< definite on all of the interval
    kNegative,    ///< not even semidefinite at the centre
    kUnclear,     ///< definite at the centre
    kUndecidable  ///< too close to singular there
  };

  void search() {
    std::priority_queue<Interval> open;
    open.push({condition_.tau->low, condition_.tau->high, 0, 0.0});
    bool may_be_proved = true;
    std::size_t limit = kMaxIntervals;
    while (!open.empty()) {
      const Interval interval = open.top();
      open.pop();
      const Finding finding = look_at(interval);
      if (finding == Finding::kNegative) return;
      if (finding == Finding::kPositive) continue;
      const bool is_short = interval.bisections == kMaxBisections;
      const bool is_last = proof_.intervals >= limit;
      if (may_be_proved && (finding == Finding::kUndecidable || is_short || is_last)) {
        leave_undecided(interval);
        may_be_proved = false;
        limit = std::min(limit, proof_.intervals + kMaxIntervalsWithoutProof);
      }
      if (is_last) return;
      if (is_short) continue;
      const double centre = interval.centre();
      open.push({interval.low, centre, interval.bisections + 1, least_eigenvalue_});
      open.push({centre, interval.high, interval.bisections + 1, least_eigenvalue_});
    }
    if (may_be_proved) {
      proof_.status = ProofStatus::kProved;
      proof_.tau.reset();
    }
  }

  Finding look_at(const Interval& interval) {
    ++proof_.intervals;
    for (const slong precision : kPrecisions) {
      TaylorAlgebra algebra(values_, interval.centre(), condition_.tau ? interval.radius() : 0.0,
                            precision);
      std::vector<BallMatrix> F = ExpressionEvaluator<TaylorAlgebra>(algebra)
                                      .evaluate(condition_.positive_definite)
                                      .coefficients;
      for (BallMatrix& coefficient : F) coefficient = symmetric_part(coefficient, precision);
      const Eigen::MatrixXd centre = midpoints(F.front());
      if (!centre.allFinite()) continue;
      least_eigenvalue_ = min_eigenvalue(centre);
      if (least_eigenvalue_ < 0.0) {
        const double bound = quotient_bound(F.front(), least_eigenvector(centre), precision);
        if (bound < 0.0) {
          disprove(interval.centre(), bound);
          return Finding::kNegative;
        }
      }
      // Along the interval F is nearly F_0 + h F_1; where both are diagonal, few entries of the
      // enclosure are wider than the matrix's own change.
      Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(centre.rows(), centre.cols());
      if (F.size() > 1) slope = midpoints(F[1]);
      const auto congruence = diagonalizing_congruence(centre, slope);
      if (!congruence) continue;
      const BallMatrix W = exact_balls(*congruence);
      const BallMatrix W_transposed = transpose(W);
      for (BallMatrix& coefficient : F) {
        coefficient = symmetric_part(
            product(product(W_transposed, coefficient, precision), W, precision), precision);
      }
      // Where Wᵀ F W is positive definite, so is F.
      if (is_positive_definite(algebra.range(F), precision)) return Finding::kPositive;
      if (is_positive_definite(F.front(), precision)) return Finding::kUnclear;
    }
    return Finding::kUndecidable;
  }

  void disprove(double tau, double value) {
    proof_.status = ProofStatus::kDisproved;
    proof_.value = value;
    if (condition_.tau) proof_.tau = tau;
    proof_.reason.clear();
  }

  void leave_undecided(const Interval& interval) {
    proof_.value = least_eigenvalue_;
    proof_.reason = "the least eigenvalue, about " + text_of("%.2g", least_eigenvalue_);
    if (condition_.tau) {
      proof_.tau = interval.centre();
      proof_.reason += " at tau = " + text_of("%.9g", interval.centre()) + " s";
    }
    proof_.reason += ", is too close to zero to tell its sign";
    if (condition_.tau) {
      proof_.reason += " on an interval of " + text_of("%.2g", interval.high - interval.low) + " s";
    }
  }

  const Condition& condition_;
  const NamedMatrices& values_;
  ConditionProof proof_;
  /// At the centre of the last interval looked at.
  double least_eigenvalue_ = 0.0;
};

}  // namespace

const char* to_string(ProofStatus status) {
  switch (status) {
    case ProofStatus::kProved:
      return "proved";
    case ProofStatus::kDisproved:
      return "disproved";
    case ProofStatus::kUndecided:
      break;
  }
  return "undecided";
}

std::vector<ConditionProof> prove(const std::vector<Condition>& conditions,
                                  const NamedMatrices& values) {
  std::vector<ConditionProof> proofs;
  proofs.reserve(conditions.size());
  for (const Condition& condition : conditions) proofs.push_back(Prover(condition, values).run());
  return proofs;
}

}  // namespace sampled_data_observers

#include "design/rigorous_check.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <queue>

#include "certificate/evaluate_expression.h"
#include "design/ball_matrix.h"
#include "design/taylor_matrix.h"
#include "design/work_limit.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Bits; the next one where the rounding of the one before hides the answer.
constexpr slong kPrecisions[] = {128, 256, 1024};
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

/// Powers of two d with which the diagonal of diag(d) a diag(d) lies in [1/2, 2), or (−2, −1/2], as
/// their exponents: multiplying by them rounds nothing.
std::vector<slong> balancing_exponents(const BallMatrix& a) {
  std::vector<slong> exponents;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const auto* middle = arb_midref(a.entry(i, i));
    const bool is_usable = arf_is_finite(middle) != 0 && arf_is_zero(middle) == 0;
    const slong exponent = is_usable ? arf_abs_bound_lt_2exp_si(middle) : 0;
    exponents.push_back(-(exponent >= 0 ? exponent / 2 : (exponent - 1) / 2));
  }
  return exponents;
}

void balance(BallMatrix& a, const std::vector<slong>& exponents) {
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      arb_mul_2exp_si(
          a.entry(i, j), a.entry(i, j),
          exponents[static_cast<std::size_t>(i)] + exponents[static_cast<std::size_t>(j)]);
    }
  }
}

/// The time that is left, and what of the work is done.
class Budget {
 public:
  Budget(const ProofOptions& options, std::size_t conditions)
      : options_(options), conditions_(conditions) {}

  bool is_spent() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return spent.count() > options_.time_limit;
  }
  double time_limit() const { return options_.time_limit; }
  RoundedNumbers rounded() const { return options_.rounded; }

  /// @param share  of the condition that is being proved
  void report(double share) const {
    if (!options_.on_progress) return;
    options_.on_progress((static_cast<double>(done_) + share) / static_cast<double>(conditions_));
  }
  void finish_condition() {
    ++done_;
    report(0.0);
  }

 private:
  const ProofOptions& options_;
  std::size_t conditions_;
  std::size_t done_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class Prover {
 public:
  Prover(const Condition& condition, const NamedMatrices& values, const Budget& budget)
      : condition_(condition), values_(values), budget_(budget) {}

  ConditionProof run() {
    proof_.name = condition_.name;
    if (condition_.is_domain()) {
      decide_domain();
      return proof_;
    }
    const ConditionCheck guess = check({condition_}, values_).front();
    proof_.value = guess.min_eigenvalue;
    proof_.tau = guess.tau;
    if (!std::isfinite(guess.min_eigenvalue)) {
      proof_.reason = "its matrix is not finite" + at_tau();
    } else if (!condition_.tau) {
      const Finding finding = look_at({});
      if (finding == Finding::kPositive) proof_.status = ProofStatus::kProved;
      if (finding == Finding::kUndecidable) leave_singular({});
    } else if (guess.holds() || !is_disproved_at({worst_time(), *guess.tau})) {
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

  void decide_domain() {
    TaylorAlgebra algebra(values_, 0.0, 0.0, kPrecisions[0], budget_.rounded());
    const BallMatrix number = ExpressionEvaluator<TaylorAlgebra>(algebra)
                                  .evaluate(condition_.positive_definite)
                                  .coefficients.front();
    arb_srcptr ball = number.entry(0, 0);
    proof_.value = arf_get_d(arb_midref(ball), ARF_RND_NEAR);
    const bool may_be_zero = condition_.kind == Condition::Kind::kNonNegative;
    if ((may_be_zero ? arb_is_nonnegative(ball) : arb_is_positive(ball)) != 0) {
      proof_.status = ProofStatus::kProved;
    } else if ((may_be_zero ? arb_is_negative(ball) : arb_is_nonpositive(ball)) != 0) {
      proof_.status = ProofStatus::kDisproved;
    } else {
      proof_.reason = "the number, about " + text_of("%.2g", proof_.value) +
                      ", is not finite or too close to zero to tell its sign";
    }
  }

  /// Where the matrix as it is, not scaled, has its least eigenvalue, about [s].
  double worst_time() const {
    constexpr int kPoints = 65;
    const auto [low, high] = *condition_.tau;
    double worst = low;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kPoints; ++i) {
      const double tau = i + 1 == kPoints ? high : low + (high - low) * i / (kPoints - 1);
      const double here = least_eigenvalue(condition_.positive_definite, values_, {tau, tau}, 1);
      if (!(here < least)) continue;
      least = here;
      worst = tau;
    }
    return worst;
  }

  bool is_disproved_at(const std::vector<double>& times) {
    return std::any_of(times.begin(), times.end(), [this](double tau) {
      return look_at({tau, tau, 0, 0.0}) == Finding::kNegative;
    });
  }

  void search() {
    const double whole = condition_.tau->high - condition_.tau->low;
    std::priority_queue<Interval> open;
    open.push({condition_.tau->low, condition_.tau->high, 0, 0.0});
    bool may_be_proved = true;
    double proved = 0.0;
    std::size_t limit = std::numeric_limits<std::size_t>::max();
    while (!open.empty() && proof_.intervals < limit) {
      const Interval interval = open.top();
      open.pop();
      if (budget_.is_spent()) {
        if (may_be_proved) leave_for_want_of_time(interval, whole > 0.0 ? proved / whole : 0.0);
        return;
      }
      const Finding finding = look_at(interval);
      if (finding == Finding::kNegative) return;
      if (finding == Finding::kPositive) {
        proved += interval.high - interval.low;
        if (whole > 0.0) budget_.report(std::min(1.0, proved / whole));
        continue;
      }
      const bool is_short = interval.bisections == kMaxBisections;
      if (may_be_proved && (finding == Finding::kUndecidable || is_short)) {
        leave_singular(interval);
        may_be_proved = false;
        limit = proof_.intervals + kMaxIntervalsWithoutProof;
      }
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
    require_time_left();
    ++proof_.intervals;
    for (const slong precision : kPrecisions) {
      TaylorAlgebra algebra(values_, interval.centre(), condition_.tau ? interval.radius() : 0.0,
                            precision, budget_.rounded());
      std::vector<BallMatrix> F = ExpressionEvaluator<TaylorAlgebra>(algebra)
                                      .evaluate(condition_.positive_definite)
                                      .coefficients;
      for (BallMatrix& coefficient : F) coefficient = symmetric_part(coefficient, precision);
      const BallMatrix as_it_is = F.front();
      const std::vector<slong> exponents = balancing_exponents(as_it_is);
      for (BallMatrix& coefficient : F) balance(coefficient, exponents);
      const Eigen::MatrixXd centre = midpoints(F.front());
      if (!centre.allFinite()) continue;
      least_eigenvalue_ = min_eigenvalue(centre);
      if (least_eigenvalue_ < 0.0 && refutes(as_it_is, F.front(), centre, precision)) {
        if (condition_.tau) proof_.tau = interval.centre();
        return Finding::kNegative;
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

  /// Whether a vector shows that the matrix is not positive semidefinite: of it as it is, or where
  /// rounding hides that, of it balanced.
  bool refutes(const BallMatrix& as_it_is, const BallMatrix& balanced,
               const Eigen::MatrixXd& centre, slong precision) {
    const Eigen::MatrixXd middle = midpoints(as_it_is);
    double bound = 0.0;
    if (middle.allFinite()) bound = quotient_bound(as_it_is, least_eigenvector(middle), precision);
    if (!(bound < 0.0)) bound = quotient_bound(balanced, least_eigenvector(centre), precision);
    if (!(bound < 0.0)) return false;
    proof_.status = ProofStatus::kDisproved;
    proof_.value = bound;
    proof_.reason.clear();
    return true;
  }

  std::string at_tau() const {
    return proof_.tau ? " at tau = " + text_of("%.9g", *proof_.tau) + " s" : "";
  }

  void leave_undecided(const Interval& interval) {
    proof_.value = least_eigenvalue_;
    if (condition_.tau) proof_.tau = interval.centre();
    proof_.reason = "the least eigenvalue (scaled), about " + text_of("%.2g", least_eigenvalue_) +
                    at_tau() + ", ";
  }

  void leave_singular(const Interval& interval) {
    leave_undecided(interval);
    proof_.reason += "is too close to zero to tell its sign";
    if (condition_.tau) {
      proof_.reason += " on an interval of " + text_of("%.2g", interval.high - interval.low) + " s";
    }
  }

  void leave_for_want_of_time(const Interval& interval, double share) {
    leave_undecided(interval);
    proof_.reason += "was not enclosed in the time limit of " +
                     text_of("%g", budget_.time_limit()) + " s: " + text_of("%.3g", 100.0 * share) +
                     " % of the times are proved, on " + std::to_string(proof_.intervals) +
                     " intervals";
  }

  const Condition& condition_;
  const NamedMatrices& values_;
  const Budget& budget_;
  ConditionProof proof_;
  /// At the centre of the last interval looked at, of the balanced matrix.
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
                                  const NamedMatrices& values, const ProofOptions& options) {
  std::vector<ConditionProof> proofs;
  proofs.reserve(conditions.size());
  Budget budget(options, conditions.size());
  for (const Condition& condition : conditions) {
    proofs.push_back(Prover(condition, values, budget).run());
    budget.finish_condition();
  }
  return proofs;
}

std::string first_unproved(const std::vector<ConditionProof>& proofs) {
  for (const ConditionProof& proof : proofs) {
    if (proof.status == ProofStatus::kProved) continue;
    if (proof.status == ProofStatus::kUndecided) return proof.name + ": " + proof.reason;
    std::string text = proof.name + ": disproved, " + text_of("%.3g", proof.value);
    if (proof.tau) text += " at tau = " + text_of("%.9g", *proof.tau) + " s";
    return text;
  }
  return "";
}

}  // namespace sampled_data_observers

#include "design/methods/timer_dependent_start.h"

#include <string>
#include <utility>
#include <vector>

namespace sampled_data_observers {
namespace {

constexpr int kMaxTurns = 12;
constexpr int kMaxRetreats = 8;
/// Of rates, in the least interval between samples.
constexpr double kLeastRise = 1e-3;
/// By how much of its gain a largest rate is lessened, so that what was found is not at the edge.
constexpr double kRoomForRate = 0.1;
constexpr double kLargestScalar = 1e6;

class RateSearch {
 public:
  RateSearch(const Theorem& theorem, const CertificateSubject& subject)
      : theorem_(theorem), subject_(subject), unit_(1.0 / subject.T2) {}

  std::optional<NamedMatrices> run(NamedMatrices gains, double goal) const {
    double rate = goal;
    NamedMatrices P;
    for (int i = 0; i < kMaxRetreats && P.empty(); ++i) {
      P = matrices_at(rate, gains);
      if (!P.empty() && i == 0) return gains;
      if (P.empty()) rate = goal - unit_ * static_cast<double>(1 << i);
    }
    for (int round = 0; round < kMaxTurns && !P.empty(); ++round) {
      const double before = rate;
      const auto better = gains_for(P, rate);
      if (!better) return std::nullopt;
      gains = better->first;
      rate = better->second;
      // With these gains, other matrices may reach further.
      for (double step = unit_; step > kLeastRise * unit_ && rate < goal; step /= 2.0) {
        const double next = rate + step < goal ? rate + step : goal;
        NamedMatrices further = matrices_at(next, gains);
        if (further.empty()) continue;
        P = std::move(further);
        rate = next;
        step *= 4.0;
      }
      if (rate >= goal) return gains;
      if (rate - before < kLeastRise * unit_) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  void require_conditions(LmiProgram& program) const {
    for (const Condition& condition : theorem_.conditions(subject_)) {
      if (condition.is_domain()) continue;
      program.require(condition, 1);
    }
  }

  void add_scalars(LmiProgram& program) const {
    for (const NamedShape& shape : theorem_.multipliers(subject_)) {
      if (shape.form != NamedShape::Form::kScalar) continue;
      const MatrixExpression value = program.scalar(shape.name);
      program.require_positive(shape.name, value);
      program.bound_above(shape.name, value, kLargestScalar);
    }
  }

  /// The multipliers that prove gains at a rate; none where there are none.
  NamedMatrices matrices_at(double rate, const NamedMatrices& gains) const {
    LmiProgram program;
    for (const auto& [name, value] : gains) program.fix(name, value);
    program.fix("lambda_t", scalar_matrix(rate));
    for (const NamedShape& shape : theorem_.multipliers(subject_)) {
      if (shape.form == NamedShape::Form::kScalar) continue;
      program.bound_above(shape.name, program.symmetric(shape.name, shape.rows),
                          identity(shape.rows));
    }
    add_scalars(program);
    require_conditions(program);
    const LmiSolution solution = solve_here(program, SolverOptions());
    return solution.satisfies_all() ? solution.values : NamedMatrices();
  }

  /// Gains of a larger rate for given matrices, with that rate.
  std::optional<std::pair<NamedMatrices, double>> gains_for(const NamedMatrices& P,
                                                            double from) const {
    const auto program_for = [&](std::optional<double> rate) {
      LmiProgram program;
      for (const NamedShape& shape : theorem_.multipliers(subject_)) {
        if (shape.form != NamedShape::Form::kScalar) program.fix(shape.name, P.at(shape.name));
      }
      for (const NamedShape& shape : theorem_.gains(subject_)) {
        program.matrix(shape.name, shape.rows, shape.cols);
      }
      add_scalars(program);
      if (rate) {
        program.fix("lambda_t", scalar_matrix(*rate));
      } else {
        program.minimize(-program.scalar("lambda_t"));
      }
      require_conditions(program);
      return program;
    };
    LmiSolution solution = solve_here(program_for(std::nullopt), SolverOptions());
    if (solution.values.empty()) return std::nullopt;
    const double largest = scalar_value(solution.values, "lambda_t");
    const double rate = from + (1.0 - kRoomForRate) * (largest - from);
    solution = solve_here(program_for(rate), SolverOptions());
    if (!solution.satisfies_all()) return std::nullopt;
    NamedMatrices gains;
    for (const NamedShape& shape : theorem_.gains(subject_)) {
      gains[shape.name] = solution.values.at(shape.name);
    }
    return std::make_pair(std::move(gains), rate);
  }

  const Theorem& theorem_;
  const CertificateSubject& subject_;
  double unit_;  // 1/s
};

}  // namespace

std::optional<NamedMatrices> gains_of_rate(const Theorem& theorem,
                                           const CertificateSubject& subject, NamedMatrices gains,
                                           double rate) {
  return RateSearch(theorem, subject).run(std::move(gains), rate);
}

}  // namespace sampled_data_observers

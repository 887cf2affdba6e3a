#include "sampled_data_observers/design/final_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/design/plant_scaling.h"

namespace sampled_data_observers {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// In which a disturbance is taken to show as much as noise does, in multiples of T2.
constexpr double kDefaultHorizon = 5.0;
/// Of the weight of the state that shows most: the least of any other.
constexpr double kLeastWeight = 1e-3;
constexpr std::size_t kNoisePoints = 9;

/// T1, or T2 where the times between samples have no lower bound.
double least_interval(const CertificateSubject& subject) {
  return subject.T1 > 0.0 ? subject.T1 : subject.T2;
}

/// Whether the derivative of state i is a multiple of that of one other state, which is not its own
/// derivative: position of speed, angle of rate.
bool is_kinematic(const Eigen::MatrixXd& A, const Eigen::MatrixXd& G, Eigen::Index i) {
  const auto only_entry = [&](Eigen::Index row) {
    Eigen::Index entry = -1;
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      if (A(row, j) == 0.0) continue;
      if (entry >= 0) return Eigen::Index{-1};
      entry = j;
    }
    return entry;
  };
  if (G.row(i).cwiseAbs().sum() > 0.0) return false;
  const Eigen::Index j = only_entry(i);
  return j >= 0 && j != i && (j > i || only_entry(j) != i);
}

/// The largest |C ∫_0^t e^{As} ds N| for t up to the horizon, column by column of N.
Eigen::VectorXd shown_within_horizon(const CertificateSubject& subject, const Eigen::MatrixXd& N) {
  constexpr int kSteps = 100;
  const Eigen::MatrixXd& A = subject.plant.A();
  const Eigen::Index n = A.rows();
  const double step = kDefaultHorizon * subject.T2 / kSteps;
  Eigen::MatrixXd augmented = Eigen::MatrixXd::Zero(n + N.cols(), n + N.cols());
  augmented.topLeftCorner(n, n) = A;
  augmented.topRightCorner(n, N.cols()) = N;
  const Eigen::MatrixXd flow = exponential_of(augmented * step);
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(n, N.cols());
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(N.cols());
  for (int i = 0; i < kSteps; ++i) {
    state = (flow.topLeftCorner(n, n) * state + flow.topRightCorner(n, N.cols())).eval();
    largest = largest.cwiseMax((subject.plant.C() * state).colwise().norm().transpose()).eval();
  }
  return largest;
}

/// A bound that samples, or jumps of the plant, drive at intervals in turn.
class Run {
 public:
  Run(const ErrorBound& bound, bool jumps, std::vector<double> intervals)
      : bound_(bound),
        jumps_(jumps),
        intervals_(std::move(intervals)),
        then_(static_cast<std::size_t>(bound.state_size())),
        workspace_(static_cast<std::size_t>(bound.workspace_size())) {
    bound.initialize(then_.data());
  }

  /// Over one interval and its sample. @return the largest bound
  double advance() {
    const double interval = intervals_[next_++ % intervals_.size()];
    double largest = bound_.bound(then_.data());
    for (const double fraction : {0.25, 0.5, 0.75, 1.0}) {
      now_ = then_;
      bound_.flow(fraction == 1.0 ? interval : fraction * interval, now_.data());
      largest = std::max(largest, bound_.bound(now_.data()));
    }
    if (jumps_) {
      bound_.jump(0.0, now_.data());  // none is told twice
    } else {
      bound_.sample(now_.data(), workspace_.data());
    }
    then_ = now_;
    time_ += interval;
    return std::max(largest, bound_.bound(then_.data()));
  }

  double time() const { return time_; }

 private:
  const ErrorBound& bound_;
  bool jumps_;
  std::vector<double> intervals_;
  std::vector<double> then_;
  std::vector<double> now_;
  std::vector<double> workspace_;
  std::size_t next_ = 0;
  double time_ = 0.0;
};

double final_bound(const ErrorBound& bound, bool jumps, const std::vector<double>& intervals) {
  constexpr int kMaxCycles = 200000;
  constexpr double kSettled = 1e-9;
  Run run(bound, jumps, intervals);
  double before = 0.0;
  for (int cycle = 0; cycle < kMaxCycles; ++cycle) {
    double largest = 0.0;
    for (std::size_t i = 0; i < intervals.size(); ++i) largest = std::max(largest, run.advance());
    if (!(largest < kInfinity) || std::abs(largest - before) <= kSettled * largest) return largest;
    before = largest;
  }
  return before;
}

void add_start(const ErrorBound& bound, bool jumps, const std::vector<double>& intervals,
               RunTimeFigures& figures) {
  constexpr int kMaxSamples = 1000000;
  Run run(bound, jumps, intervals);
  for (int i = 0; i < kMaxSamples; ++i) {
    const double largest = run.advance();
    if (std::isinf(largest)) break;
    figures.factor_on_start = std::max(figures.factor_on_start, largest);
    if (largest > 0.01) continue;
    figures.time_to_hundredth = std::max(figures.time_to_hundredth, run.time());
    return;
  }
  figures.time_to_hundredth = kInfinity;
}

std::vector<std::vector<double>> worst_intervals(const CertificateSubject& subject) {
  const double T1 = least_interval(subject);
  if (T1 == subject.T2) return {{T1}};
  return {{T1}, {subject.T2}, {T1, subject.T2}};
}

/// objective <= level, which is minimized or given.
void add_level(LmiProgram& program, const MatrixExpression& objective,
               const Parameters& parameters) {
  const auto given = parameters.find(kFinalErrorLevel);
  if (given != parameters.end()) {
    program.bound_above("final error", objective, given->second);
    return;
  }
  const MatrixExpression level = program.scalar(kFinalErrorLevel);
  program.bound_above("final error", objective, level);
  program.minimize(level);
}

/// P >= W² with the weights W, and Lᵀ e^{Aᵀτ} P e^{Aτ} L <= level: what a sample's noise adds to V
/// until the next one.
void minimize_ferrante2016_level(LmiProgram& program, const CertificateSubject& subject,
                                 const Eigen::MatrixXd& L, const Eigen::VectorXd& weights,
                                 const Parameters& parameters) {
  const Eigen::Index n = subject.plant.states();
  const MatrixExpression P = symbol("P", n, n);
  program.bound_above("least P", Eigen::MatrixXd(weights.cwiseAbs2().asDiagonal()), P);
  const MatrixExpression level = program.scalar("noise_level");
  for (std::size_t i = 0; i < kNoisePoints; ++i) {
    const double tau = subject.T1 + (subject.T2 - subject.T1) * static_cast<double>(i) /
                                        static_cast<double>(kNoisePoints - 1);
    const MatrixExpression flown = Eigen::MatrixXd(exponential_of(subject.plant.A() * tau) * L);
    program.bound_above("noise", transpose(flown) * P * flown, level * identity(L.cols()));
  }
  add_level(program, level, parameters);
}

}  // namespace

Eigen::VectorXd weights_of_design(const CertificateSubject& subject) {
  constexpr int kSteps = 100;
  const Eigen::MatrixXd flow =
      exponential_of(subject.plant.A() * (kDefaultHorizon * subject.T2 / kSteps));
  Eigen::MatrixXd outputs = subject.plant.C();
  Eigen::VectorXd weights = outputs.colwise().norm().transpose();
  for (int i = 0; i < kSteps; ++i) {
    outputs = (outputs * flow).eval();
    weights = weights.cwiseMax(outputs.colwise().norm().transpose()).eval();
  }
  return weights.cwiseMax(kLeastWeight * weights.maxCoeff());
}

double final_error_of_level(const Theorem& theorem, const CertificateSubject& subject,
                            const NamedMatrices& fixed, double level) {
  const double root = std::sqrt(level);
  if (theorem.name() != "ferrante2016_theorem1") return root;
  return root / -std::expm1(-scalar_value(fixed, "decay") * subject.T1);
}

ErrorAssumptions final_error_assumptions(const Parameters& parameters) {
  ErrorAssumptions assumptions;
  assumptions.noise = parameters.at(kNoise);
  assumptions.disturbance = parameters.at(kDisturbance);
  return assumptions;
}

SearchRange final_error_rates(const CertificateSubject& subject,
                              const ErrorAssumptions& assumptions) {
  return {(assumptions.disturbance > 0.0 ? 3e-4 : 0.05) / subject.T2, 3.0 / subject.T2, true};
}

Eigen::MatrixXd default_disturbance_input(const CertificateSubject& subject) {
  const Eigen::MatrixXd& A = subject.plant.A();
  const Eigen::Index n = A.rows();
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd shown = shown_within_horizon(subject, unit);
  const Eigen::VectorXd in_any_units = shown_within_horizon(balanced(subject), unit);
  Eigen::MatrixXd N(n, 0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool is_shown = in_any_units(i) > 1e-12 * in_any_units.maxCoeff();
    if (is_kinematic(A, subject.plant.G, i) || !is_shown) continue;
    N.conservativeResize(n, N.cols() + 1);
    N.rightCols(1) = unit.col(i) / shown(i);
  }
  return N;
}

double default_disturbance(const CertificateSubject& subject, double noise) {
  if (subject.plant.N.cols() == 0) return 0.0;
  const double shown = shown_within_horizon(subject, subject.plant.N).maxCoeff();
  return shown > 0.0 ? noise / shown : 0.0;
}

void assume(const DeclaredAssumptions& declared, DesignProblem& problem) {
  PlantMatrices& plant = problem.subject.plant;
  ErrorAssumptions& assumptions = problem.assumptions;
  plant.C_p.resize(0, plant.states());
  assumptions.noise = declared.noise.value_or(1.0);
  const bool has_disturbance = declared.disturbance.value_or(1.0) > 0.0;
  if (has_disturbance && plant.N.cols() == 0) plant.N = default_disturbance_input(problem.subject);
  assumptions.disturbance = declared.disturbance
                                ? *declared.disturbance
                                : default_disturbance(problem.subject, assumptions.noise);
  if (assumptions.disturbance == 0.0) plant.N.resize(plant.states(), 0);
  // Of nothing at all no gains are the best.
  if (assumptions.noise == 0.0 && assumptions.disturbance == 0.0) assumptions.noise = 1.0;
}

bool has_bound_for(const Certificate& certificate, const ErrorAssumptions& assumptions) {
  try {
    return certificate.theorem->error_bound(certificate.subject, certificate.values, assumptions) !=
           nullptr;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

bool bounds_disturbances(const Theorem& theorem) {
  // The theorems of sferlazza2019, with a rate or not, are about plants without disturbance.
  const std::string name = theorem.name();
  return name != "ferrante2016_theorem1" && name.rfind("sferlazza2019", 0) != 0;
}

bool has_final_error_level(const Theorem& theorem) {
  return theorem.name() == "ferrante2019_theorem2" || theorem.name() == "ferrante2016_theorem1";
}

void minimize_final_error(LmiProgram& program, const Theorem& theorem,
                          const CertificateSubject& subject, const NamedMatrices& fixed,
                          const Eigen::VectorXd& weights, const Parameters& parameters) {
  if (theorem.name() == "ferrante2016_theorem1") {
    minimize_ferrante2016_level(program, subject, fixed.at("L"), weights, parameters);
  } else if (theorem.name() == "ferrante2019_theorem2") {
    Parameters all = parameters;
    for (const char* name : {"delta", "lambda_t"}) all[name] = scalar_value(fixed, name);
    minimize_ferrante2019_level(program, subject, weights, all);
  }
}

void minimize_ferrante2019_level(LmiProgram& program, const CertificateSubject& subject,
                                 const Eigen::VectorXd& weights, const Parameters& parameters) {
  const ErrorAssumptions assumptions = final_error_assumptions(parameters);
  const double rate = 2.0 * parameters.at("lambda_t");
  const Eigen::Index n = subject.plant.states();
  const Eigen::Index m = subject.plant.C().rows();
  program.bound_above("least P1", Eigen::MatrixXd(weights.cwiseAbs2().asDiagonal()),
                      symbol("P1", n, n));
  // W of the bound ends at ω2 |η|² / (1 − e^{−2 λ T1}) + γ² |w|² / (2 λ); here over |η|² or |w|².
  const double unit = assumptions.noise > 0.0 ? assumptions.noise : assumptions.disturbance;
  const auto squared = [](double x) { return x * x; };
  const double noise_weight = squared(assumptions.noise / unit) *
                              std::exp(parameters.at("delta") * subject.T2) /
                              -std::expm1(-rate * least_interval(subject));
  const MatrixExpression omega = program.scalar("P2_level");
  program.bound_above("P2 <= P2_level I", symbol("P2", m, m), omega * identity(m));
  MatrixExpression level = noise_weight * omega;
  if (subject.plant.N.cols() > 0) {
    level = level + (squared(assumptions.disturbance / unit) / rate) * square("gamma");
  }
  add_level(program, level, parameters);
}

RunTimeFigures run_time_figures(const Theorem& theorem, const CertificateSubject& subject,
                                const NamedMatrices& values, const ErrorAssumptions& assumptions) {
  RunTimeFigures figures;
  figures.final_error = final_error(theorem, subject, values, assumptions);
  ErrorAssumptions start;
  start.initial_error = 1.0;
  const auto bound = theorem.error_bound(subject, values, start);
  for (const auto& intervals : worst_intervals(subject))
    add_start(*bound, subject.plant.jumps(), intervals, figures);
  return figures;
}

double final_error(const Theorem& theorem, const CertificateSubject& subject,
                   const NamedMatrices& values, const ErrorAssumptions& assumptions) {
  ErrorAssumptions in_the_end = assumptions;
  in_the_end.initial_error = 0.0;
  const auto bound = theorem.error_bound(subject, values, in_the_end);
  if (!bound) throw std::invalid_argument(theorem.name() + " gives no bound on the error");
  double largest = 0.0;
  for (const auto& intervals : worst_intervals(subject)) {
    largest = std::max(largest, final_bound(*bound, subject.plant.jumps(), intervals));
  }
  return largest;
}

}  // namespace sampled_data_observers

// The bare command on plants of textbooks: its observer is better than an open-loop copy and, but
// for seven plants where it is known not to be, than holding the last sample; its bound holds and
// is of use.
#include "textbook_plants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "certified.h"
#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/design/best_design.h"
#include "sampled_data_observers/design/final_error.h"

namespace sampled_data_observers::test {
namespace {

constexpr double kUsefulBound = 20.0;  ///< over the worst error seen
constexpr double kDrive = 10.0;        ///< of a known input, over the disturbance
constexpr int kSubsteps = 4;           ///< between two samples
constexpr int kSamples = 6000;

/// What a run showed.
struct Seen {
  double largest_excess = 0.0;    ///< error over bound, at any time
  double worst_error = 0.0;       ///< in the second half
  double largest_bound = 0.0;     ///< there
  double output_square = 0.0;     ///< of C ε, all along
  double held_square = 0.0;       ///< the same for the last sample held
  double error_square = 0.0;      ///< of ε, all along
  double open_loop_square = 0.0;  ///< the same for a copy that is not corrected
};

/// How noise and disturbance move: against the observer as far as simple signals do that.
enum class Signals { kRandom, kConstant, kSwitching };

/// The plant with gains of ferrante2019, exactly: ε flows by A ε − L θ + N w, θ by H θ.
class SimulatedRun {
 public:
  SimulatedRun(const Design& design, const ErrorAssumptions& assumptions, Signals signals,
               unsigned seed)
      : subject_(design.certificate.subject),
        L_(design.certificate.values.at("L")),
        H_(design.certificate.values.at("H")),
        assumptions_(assumptions),
        signals_(signals),
        random_(seed),
        bound_(design.certificate.theorem->error_bound(subject_, design.certificate.values,
                                                       assumptions)) {}

  Seen go() {
    const PlantMatrices& plant = subject_.plant;
    const Eigen::Index n = plant.states();
    error_ = direction(n) * assumptions_.initial_error;
    open_loop_ = error_;
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(plant.C().rows());
    // The plant moves by a known input, of which only a sample that is held knows nothing.
    state_ = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd held = Eigen::VectorXd::Zero(plant.C().rows());
    for (int k = 0; k < kSamples; ++k) {
      const double interval = next_interval(k);
      if (k % 30 == 0) drive_ = -drive_;
      const Eigen::VectorXd w = signal(plant.N.cols(), assumptions_.disturbance, k / 7);
      for (int i = 1; i <= kSubsteps; ++i) {
        flow(interval / kSubsteps, w, theta);
        bound_.flow_to(i == kSubsteps ? interval : interval * i / kSubsteps);
        look(held, k);
      }
      const Eigen::VectorXd noise = signal(plant.C().rows(), assumptions_.noise, k);
      theta = plant.C() * error_ + noise;
      held = plant.C() * state_ + noise;
      bound_.sample();
      look(held, k);
    }
    return seen_;
  }

 private:
  double next_interval(int k) {
    if (signals_ == Signals::kConstant) return k % 400 < 200 ? subject_.T1 : subject_.T2;
    const double nanoseconds =
        std::round(1e9 * std::uniform_real_distribution<double>(subject_.T1, subject_.T2)(random_));
    return std::clamp(nanoseconds / 1e9, subject_.T1, subject_.T2);
  }

  Eigen::VectorXd direction(Eigen::Index size) {
    std::normal_distribution<double> normal;
    const Eigen::VectorXd any = Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random_); });
    return any / any.norm();
  }

  Eigen::VectorXd signal(Eigen::Index size, double bound, int step) {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(size) /
                                 std::sqrt(static_cast<double>(std::max<Eigen::Index>(size, 1)));
    switch (signals_) {
      case Signals::kRandom:
        return direction(size) * bound;
      case Signals::kConstant:
        return ones * bound;
      case Signals::kSwitching:
        break;
    }
    return ones * ((step / 20) % 2 == 0 ? bound : -bound);
  }

  void flow(double duration, const Eigen::VectorXd& w, Eigen::VectorXd& theta) {
    const PlantMatrices& plant = subject_.plant;
    const Eigen::Index n = plant.states();
    const Eigen::Index m = plant.C().rows();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + m + 1, n + m + 1);
    all.topLeftCorner(n, n) = plant.A();
    all.block(0, n, n, m) = -L_;
    all.block(n, n, m, m) = H_;
    all.block(0, n + m, n, 1) = plant.N * w;
    const Eigen::MatrixXd step = exponential_of(all * duration);
    Eigen::VectorXd now(n + m + 1);
    now << error_, theta, 1.0;
    now = (step * now).eval();
    error_ = now.head(n);
    theta = now.segment(n, m);
    const Eigen::MatrixXd own = step.topLeftCorner(n, n);
    all.block(0, n, n, m).setZero();
    const Eigen::VectorXd pushed = exponential_of(all * duration).block(0, n + m, n, 1);
    open_loop_ = (own * open_loop_ + pushed).eval();
    state_ = (own * state_ + pushed + kDrive * drive_ * pushed_by_one(all, duration)).eval();
  }

  /// What an input that enters as all of w at its bound does meanwhile.
  Eigen::VectorXd pushed_by_one(Eigen::MatrixXd all, double duration) const {
    const Eigen::Index n = subject_.plant.states();
    const Eigen::Index last = all.cols() - 1;
    const Eigen::MatrixXd& N = subject_.plant.N;
    all.block(0, last, n, 1) = N * Eigen::VectorXd::Constant(N.cols(), assumptions_.disturbance);
    return exponential_of(all * duration).block(0, last, n, 1);
  }

  void look(const Eigen::VectorXd& held, int k) {
    const Eigen::MatrixXd& C = subject_.plant.C();
    const double error = error_.norm();
    seen_.largest_excess = std::max(seen_.largest_excess, error / bound_.value());
    if (k > kSamples / 2) {
      seen_.worst_error = std::max(seen_.worst_error, error);
      seen_.largest_bound = std::max(seen_.largest_bound, bound_.value());
    }
    seen_.output_square += (C * error_).squaredNorm();
    seen_.held_square += (C * state_ - held).squaredNorm();
    seen_.open_loop_square += (C * open_loop_).squaredNorm();
  }

  CertificateSubject subject_;
  Eigen::MatrixXd L_;
  Eigen::MatrixXd H_;
  ErrorAssumptions assumptions_;
  Signals signals_;
  std::mt19937 random_;
  DrivenBound bound_;
  Eigen::VectorXd error_;
  Eigen::VectorXd open_loop_;
  Eigen::VectorXd state_;
  double drive_ = 1.0;
  Seen seen_;
};

class TextbookPlantsTest : public ::testing::TestWithParam<TextbookPlant> {};

TEST_P(TextbookPlantsTest, TheBareCommandGivesGainsOfUse) {
  const TextbookPlant& plant = GetParam();
  DesignProblem problem;
  problem.subject = plant.subject;
  problem.objective = Objective::kMinFinalError;
  assume({plant.noise, std::nullopt}, problem);
  const auto outcomes = synthesize_by_all(methods_that_apply(problem), problem, SynthesisOptions());
  const MethodOutcome* best = best_of(outcomes);
  ASSERT_NE(best, nullptr) << outcomes.front().message;
  const Design& design = *best->design;

  ErrorAssumptions assumptions = problem.assumptions;
  assumptions.initial_error = 3.0 * best->final_error;
  double worst = 0.0;
  double bound = 0.0;
  for (const Signals signals : {Signals::kRandom, Signals::kConstant, Signals::kSwitching}) {
    const Seen seen = SimulatedRun(design, assumptions, signals, 5).go();
    EXPECT_LE(seen.largest_excess, 1.0 + 1e-9);
    worst = std::max(worst, seen.worst_error);
    bound = std::max(bound, seen.largest_bound);
    if (signals != Signals::kRandom) continue;
    if (!plant.is_held_better) {
      EXPECT_LT(seen.output_square, seen.held_square);
    }
    EXPECT_LT(seen.output_square, seen.open_loop_square);
  }
  EXPECT_LE(bound, kUsefulBound * worst);
  RecordProperty("bound_over_worst_error", std::to_string(bound / worst));
}

INSTANTIATE_TEST_SUITE_P(All, TextbookPlantsTest, ::testing::ValuesIn(textbook_plants()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace sampled_data_observers::test

// Guaranteed bounds that rest on what the law does (continuous outputs held between messages, modes
// of a switched plant, outputs that the flow takes in place of a state, jumps whose resets wait)
// beside true plants that do their worst: greedy disturbances and noise, random times, jumps that
// are told without their outputs, too soon, or twice, and resets amid what is held.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "certificate/certified_gains.h"
#include "certificate/disturbed_flow.h"
#include "certificate/state_shares.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "support/long_tests.h"

namespace sampled_data_observers::test {
namespace {

constexpr double kFollowedStep = 0.01;  // s
constexpr double kFollowedDuration = 12.0;
constexpr double kFollowedError = 1.0;
constexpr int kSettled = 20;  // comparisons

constexpr double kLongestDelay = 0.4;  // s
/// ‖∂f/∂x‖ of the plants that are given by formulas, at most.
constexpr double kSteepest = 3.5;  // 1/s

/// A gain file, the sizes of noise and disturbance, and what else the observer is configured with.
struct FollowedClaim {
  const char* gains;
  double noise;
  double disturbance;
  const char* with = "{}";
  const char* assumptions = "";  ///< beside the others
  /// That the error comes to, so that a bound of another size would be noticed.
  double share = 0.05;
};

const char kDelayed[] = "jumps: {late: delayed}";
const char kInjected[] = "gains: {output_injection: {x1: angle}}";

const FollowedClaim kFollowedClaims[] = {
    {"test/certificate/attack/held/bernard2022_equation22.yaml", 0.02, 0.1},
    {"test/certificate/attack/held/bernard2022_equation22.yaml", 0.0, 0.0},
    {"test/certificate/attack/held/bernard2022_equation14.yaml", 0.02, 0.1},
    {"test/certificate/attack/held/timer_dependent_synchronized.yaml", 0.02, 0.1},
    {"test/certificate/bernard2022_impulsive_timer_dependent.yaml", 0.02, 0.0},
    {"test/certificate/attack/kicked/timer_dependent_synchronized.yaml", 0.02, 0.1},
    {"test/certificate/attack/injected/timer_dependent_synchronized.yaml", 0.02, 0.1, kInjected,
     ", injection_lipschitz: {x1: 3, x2: 0.5}"},
    {"test/certificate/attack/kicked/bernard2022_example4_2.yaml", 0.02, 0.1},
    {"test/certificate/attack/kicked/bernard2022_corollary4_1.yaml", 0.02, 0.1},
    {"test/certificate/attack/switched/bernard2022_example7_1.yaml", 0.02, 0.1},
    {"config/examples/bernard2022_switched/gains.yaml", 0.02, 0.0},
    {"test/certificate/attack/switched/timer_dependent_switched.yaml", 0.02, 0.1},
    {"test/certificate/bernard2022_switched_timer_dependent.yaml", 0.02, 0.0},
    {"test/certificate/attack/switched/bernard2022_equation49_reverse_average_dwell_time.yaml",
     0.02, 0.1},
    {"test/certificate/attack/switched/bernard2022_section7_3_1.yaml", 0.02, 0.1},
    {"test/certificate/attack/switched/bernard2022_section7_3_1.yaml", 0.0, 0.0},
    {"test/certificate/attack/held/bernard2022_equation22.yaml", 0.02, 0.1, kDelayed},
    {"test/certificate/attack/held/bernard2022_equation14.yaml", 0.02, 0.1, kDelayed},
    {"test/certificate/attack/kicked/bernard2022_example4_2.yaml", 0.0, 0.0, kDelayed},
    {"config/examples/bernard2022_impulsive/gains.yaml", 0.02, 0.0, kDelayed},
    {"config/examples/bernard2022_bouncing_ball/gains.yaml", 0.0, 0.0, kDelayed},
    {"test/certificate/bernard2022_bouncing_ball_equation26.yaml", 0.01, 0.0, kDelayed},
    {"test/certificate/attack/injected/bernard2022_equation36.yaml", 0.02, 0.1, kInjected,
     ", injection_lipschitz: {x1: 3, x2: 0.5}"},
    {"test/certificate/attack/injected/bernard2022_equation36.yaml", 0.0, 0.0, kInjected,
     ", injection_lipschitz: {x1: 3, x2: 0.5}"},
    {"test/certificate/attack/injected/bernard2022_equation22.yaml", 0.02, 0.1, kInjected,
     ", injection_lipschitz: {x1: 3, x2: 0.5}"},
};

struct RunOutcome {
  double largest_speed = 0.0;  ///< of the continuous output [1/s]
  double largest_share = 0.0;  ///< of its bound that the error came to
  double settled_share = 0.0;  ///< likewise, later than just after a start
  double last_bound = 0.0;
  int finite = 0;
  int infinite = 0;
  int released = 0;
};

/// One run of plant and law; its estimates do not depend on what is assumed, so that it can be
/// played again with the output_rate that it had.
class FollowedRun {
 public:
  FollowedRun(const ObserverConfig& config, const CertificateSubject& subject,
              const FollowedClaim& claim, std::uint64_t seed)
      : law_(*config.law),
        plant_(*config.plant),
        subject_(subject),
        claim_(claim),
        flow_(plant_, disturbance_of(subject), kNanosecondsPerSecond),
        shares_(law_),
        generator_(seed),
        // Other times than those that are watched lose the bound.
        longest_(subject.dwell_time ? subject.dwell_time->tau : subject.T2),
        strays_(seed % 4 == 3),
        restarts_(seed % 4 == 2),
        state_(law_.state_size()),
        workspace_(law_.workspace_size()) {
    law_.initialize(state_.data());
    x_ = random_direction() * uniform(0.0, 2.0);
    start_from_error();
  }

  RunOutcome play() {
    const bool has_messages = plant_.outputs(SensorTiming::kContinuous) > 0;
    double next_message = uniform(0.0, 0.2);
    double next_jump = uniform(0.0, longest_);
    double restart = restarts_ ? uniform(0.3, 0.7) * kFollowedDuration : kFollowedDuration;
    compare();
    for (double now = 0.0; now < kFollowedDuration; now += kFollowedStep) {  // NOLINT(cert-flp30-c)
      if (waits_for_ > 0 && --waits_for_ == 0) release();
      if (now >= restart) {
        begin_anew();
        restart = kFollowedDuration;
      }
      if (now >= next_jump) {
        jump();
        // A step late where it is drawn so.
        next_jump = now + (strays_ && !subject_.dwell_time && in_one_of(4)
                               ? uniform(0.02, 2.0 * longest_)
                               : uniform(subject_.T1, longest_ - kFollowedStep));
      } else if (strays_ && in_one_of(300)) {
        tell_again();
      }
      if (has_messages && now >= next_message) {
        message();
        next_message = now + std::pow(10.0, uniform(-2.0, -0.3));
      }
      advance();
      compare();
    }
    return outcome_;
  }

 private:
  static Eigen::MatrixXd disturbance_of(const CertificateSubject& subject) {
    if (subject.plant.N.cols() > 0) return subject.plant.N;
    return Eigen::MatrixXd::Zero(subject.plant.states(), 1);
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  bool in_one_of(int cases) {
    return std::uniform_int_distribution<int>(0, cases - 1)(generator_) == 0;
  }
  Eigen::VectorXd random_direction() {
    std::normal_distribution<double> normal;
    Eigen::VectorXd direction(plant_.states());
    for (Eigen::Index i = 0; i < direction.size(); ++i) direction(i) = normal(generator_);
    return direction.normalized();
  }

  const ModeMatrices& matrices() const { return subject_.plant.modes[mode_]; }
  Eigen::VectorXd error() const { return x_ - state_.head(plant_.states()); }

  void start_from_error() {
    const Eigen::VectorXd estimate = x_ - kFollowedError * random_direction();
    law_.observer().start_from(estimate.data(), state_.data());
    since_start_ = 0;
  }

  /// As a service does: what is held goes on being held.
  void begin_anew() {
    waits_for_ = 0;
    const Eigen::VectorXd before = state_;
    law_.initialize(state_.data());
    law_.observer().keep_held(law_.observer().held_part(before.data()), state_.data());
    law_.observer().keep_mode(law_.observer().mode_of(before.data()), state_.data());
    start_from_error();
  }

  void advance() {
    Eigen::VectorXd w = Eigen::VectorXd::Zero(flow_inputs());
    if (claim_.disturbance > 0.0) {
      const double along = (subject_.plant.N.transpose() * error())(0);
      w(0) = along < 0.0 ? -claim_.disturbance : claim_.disturbance;
    }
    note_speed();
    flow_.apply(mode_, w, from_seconds(kFollowedStep), x_);
    note_speed();
    law_.flow(from_seconds(kFollowedStep), state_.data(), workspace_.data());
  }
  Eigen::Index flow_inputs() const { return std::max<Eigen::Index>(1, subject_.plant.N.cols()); }

  /// |C_c ẋ| within half a step, with what ẋ may change by.
  void note_speed() {
    if (plant_.outputs(SensorTiming::kContinuous) == 0) return;
    const VectorMap& field = *plant_.modes()[mode_].flow;
    Eigen::VectorXd speed(plant_.states());
    field.evaluate(x_.data(), nullptr, speed.data());
    const Eigen::MatrixXd& C = matrices().C_c;
    const double slope =
        field.affine() != nullptr ? (C * field.affine()->M()).norm() : C.norm() * kSteepest;
    const double change = slope * (speed.norm() * 1.2 + claim_.disturbance) * kFollowedStep;
    const double by_disturbance =
        subject_.plant.N.cols() == 0 ? 0.0 : (C * subject_.plant.N).norm() * claim_.disturbance;
    outcome_.largest_speed =
        std::max(outcome_.largest_speed, (C * speed).norm() + change + by_disturbance);
  }

  void message() {
    const double y = (matrices().C_c * x_)(0) + greedy_noise();
    take({0, EventKind::kOutput, sensor_of(SensorTiming::kContinuous), &y, 1, 0});
  }
  double greedy_noise() { return (in_one_of(2) ? 1.0 : -1.0) * claim_.noise; }
  int sensor_of(SensorTiming timing) const {
    std::size_t i = 0;
    while (plant_.sensors()[i].timing != timing) ++i;
    return static_cast<int>(i);
  }

  void jump() {
    const bool is_measured = plant_.outputs(SensorTiming::kAtJumps) > 0 && !in_one_of(6);
    const double y = is_measured ? (matrices().C_d * x_)(0) + greedy_noise() : 0.0;
    const VectorMap* map = plant_.modes()[mode_].jump.get();
    if (map != nullptr) {
      const Eigen::VectorXd before = x_;
      map->evaluate(before.data(), nullptr, x_.data());
    }
    Event event{0, EventKind::kJump, 0, is_measured ? &y : nullptr, is_measured ? 1 : 0, 0};
    if (plant_.switches()) {
      // 7.3.2 counts on a change at each; others may stay.
      const bool stays = in_one_of(4);
      if (!stays) mode_ = 1 - mode_;
      event.mode = plant_.modes()[mode_].label;
    }
    take(event);
  }

  /// The same jump once more, although the plant did not jump: recognised sooner than T1 after it.
  void tell_again() {
    if (plant_.switches()) return;
    const bool is_measured = plant_.outputs(SensorTiming::kAtJumps) > 0;
    const double y = is_measured ? (matrices().C_d * x_)(0) : 0.0;
    if (since_jump_ >= subject_.T1 - kFollowedStep) return;
    take({0, EventKind::kJump, 0, is_measured ? &y : nullptr, is_measured ? 1 : 0, 0});
  }

  void take(const Event& event) {
    ASSERT_TRUE(law_.accepts(event));
    law_.reset(event, state_.data(), workspace_.data());
    if (event.kind == EventKind::kJump) {
      since_jump_ = -kFollowedStep;
      if (law_.delays_jumps()) {
        delay_ = static_cast<int>(uniform(0.0, kLongestDelay) / kFollowedStep);
        waits_for_ = delay_;
        if (delay_ == 0) release();
      }
    }
    compare();
  }
  void release() {
    Event event;
    event.kind = EventKind::kRelease;
    event.delay = delay_ * from_seconds(kFollowedStep);
    ASSERT_TRUE(took_effect(law_.reset(event, state_.data(), workspace_.data())));
    ++outcome_.released;
    compare();
  }

  void compare() {
    since_jump_ += kFollowedStep;
    const double bound = law_.error_bound(state_.data());
    outcome_.last_bound = bound;
    if (!std::isfinite(bound)) {
      ++outcome_.infinite;
      return;
    }
    ++outcome_.finite;
    const double rounding = 1e-12 * x_.norm();
    const double share =
        std::max({error().norm() / bound, shares_.largest(state_, error(), rounding),
                  shares_.of_ellipsoid(state_, error(), rounding)});
    outcome_.largest_share = std::max(outcome_.largest_share, share);
    if (++since_start_ > kSettled) {
      outcome_.settled_share = std::max(outcome_.settled_share, share);
    }
  }

  const ObserverLaw& law_;
  const Plant& plant_;
  const CertificateSubject& subject_;
  FollowedClaim claim_;
  DisturbedFlow flow_;
  StateShares shares_;
  std::mt19937_64 generator_;
  double longest_;  ///< time between jumps [s]
  bool strays_;
  bool restarts_;
  Eigen::VectorXd state_;
  Eigen::VectorXd workspace_;
  Eigen::VectorXd x_;
  std::size_t mode_ = 0;
  double since_jump_ = 100.0;
  int delay_ = 0;        ///< of the last jump, in steps
  int waits_for_ = 0;    ///< its release: so many steps
  int since_start_ = 0;  ///< comparisons
  RunOutcome outcome_;
};

std::string followed_assumptions(const FollowedClaim& claim, bool has_disturbance,
                                 std::optional<double> output_rate) {
  std::string text = "{initial_error: " + std::to_string(kFollowedError) +
                     ", noise: " + std::to_string(claim.noise);
  if (has_disturbance) text += ", disturbance: " + std::to_string(claim.disturbance);
  if (output_rate) text += ", output_rate: " + std::to_string(*output_rate);
  return text + claim.assumptions + "}";
}

class FollowedLawBoundTest : public ::testing::TestWithParam<FollowedClaim> {};

TEST_P(FollowedLawBoundTest, NoErrorIsAboveItsBound) {
  const FollowedClaim& claim = GetParam();
  CertifiedGains gains(claim.gains);
  gains.with(claim.with);
  const CertificateSubject subject = gains.certificate().subject;
  const bool is_held = subject.plant.mode().C_c.rows() > 0;
  const bool has_disturbance = subject.plant.N.cols() > 0;
  const std::uint64_t runs = long_tests_are_wanted() ? 4000 : 40;
  double largest_share = 0.0;
  double smallest_end = 1e300;
  int finite = 0;
  int released = 0;
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    std::optional<double> rate;
    if (is_held) rate = 1.0;
    const ObserverConfig first =
        CertifiedGains(gains).assuming(followed_assumptions(claim, has_disturbance, rate)).config();
    if (is_held) rate = FollowedRun(first, subject, claim, seed).play().largest_speed + 1e-6;
    const ObserverConfig config =
        CertifiedGains(gains).assuming(followed_assumptions(claim, has_disturbance, rate)).config();
    const RunOutcome run = FollowedRun(config, subject, claim, seed).play();
    ASSERT_LE(run.largest_share, 1.0 + 1e-9) << claim.gains << ", seed " << seed;
    ASSERT_EQ(0, run.infinite) << claim.gains << ", seed " << seed;
    largest_share = std::max(largest_share, run.settled_share);
    smallest_end = std::min(smallest_end, run.last_bound);
    finite += run.finite;
    released += run.released;
  }
  // Otherwise it would not notice a bound of another size.
  EXPECT_GT(largest_share, claim.share);
  EXPECT_EQ(claim.with == kDelayed, released > 0);
  std::printf("%s: %d comparisons, the error came to %.3g of its bound, which came down to %.3g\n",
              claim.gains, finite, largest_share, smallest_end);
}

INSTANTIATE_TEST_SUITE_P(EveryFollowedClaim, FollowedLawBoundTest,
                         ::testing::ValuesIn(kFollowedClaims));

}  // namespace
}  // namespace sampled_data_observers::test

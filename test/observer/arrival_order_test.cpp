// The estimate is a function of the events taken in, to the bit, whatever the order in which they
// come: for every observer type and for bounds on the error, with random gates, limits on jumps,
// delays, times between jumps and lengths of the log around them, from a stated start or from the
// first event, and with events as they should not be and jumps that are taken back. The environment
// variable SDO_EVENT_SETS says how many sets of events it takes for all of them together.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>

#include "certificate/certified_gains.h"
#include "observer/delayed_jumps.h"
#include "observer/dwell_times_watch.h"
#include "observer/limited_jumps.h"
#include "observer/missing_jumps.h"
#include "observer/numbered_jumps.h"
#include "observer/possible_jumps.h"
#include "observer/resting_estimate.h"
#include "support/long_tests.h"
#include "support/stamps.h"
#include "support/type_examples.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

constexpr double kEventSets = 250.0;
constexpr double kEventSetsOfLongTests = 5000.0;
/// In which each set comes, to a log with place for all and to one without.
constexpr int kOrders = 4;
constexpr Duration kSpan = kSecond / 2;
/// Longer than any flow that is integrated.
constexpr Duration kBeyondHorizon = 2000 * kSecond;
constexpr Stamp kNow = kStart + 3 * kBeyondHorizon;
const Timeline::Limits kRoomy = {10 * kBeyondHorizon, 1000};

/// Observers with a bound on their error.
const char* const kCertified[] = {
    "config/examples/ferrante2016_mass_spring/gains.yaml",
    "test/certificate/ferrante2019_oscillator_0.41.yaml",
    "config/examples/sferlazza2019_aircraft_1_3/gains.yaml",
    "config/examples/etienne2019_dc_drive/gains.yaml",
    "config/examples/bernard2022_impulsive/gains.yaml",
    "test/certificate/bernard2022_bouncing_ball_equation26.yaml",
    "test/certificate/attack/impulsive/bernard2022_corollary5_2.yaml",
    "test/certificate/attack/held/bernard2022_equation14.yaml",
    "test/certificate/attack/switched/bernard2022_example7_1.yaml",
    "config/examples/bernard2022_switched/gains.yaml",
};

std::vector<std::string> subjects() {
  std::vector<std::string> result = test::type_examples();
  result.emplace_back("constant_gain_timeouts");
  result.emplace_back("constant_gain_roots");  // whose formulas have no value now and then
  result.insert(result.end(), std::begin(kCertified), std::end(kCertified));
  return result;
}

std::size_t sets_for_each_subject() {
  const char* text = std::getenv("SDO_EVENT_SETS");
  const double usual = test::long_tests_are_wanted() ? kEventSetsOfLongTests : kEventSets;
  const double sets = text == nullptr ? usual : std::strtod(text, nullptr);
  return static_cast<std::size_t>(std::ceil(sets / static_cast<double>(subjects().size())));
}

/// What became of the events, and of the estimates that were compared.
struct Tally {
  std::size_t orders = 0;
  std::size_t used = 0;
  std::size_t too_old = 0;
  std::size_t not_finite = 0;
  std::size_t gated = 0;
  std::size_t too_frequent = 0;
  std::size_t not_possible = 0;
  std::size_t repeated = 0;
  std::size_t taken_back = 0;
  std::size_t skipped = 0;
  std::size_t at_rest = 0;
  std::size_t ill_timed = 0;
  std::size_t made_up = 0;
  std::size_t overflowing = 0;
  std::size_t held = 0;
  std::size_t bounded = 0;

  void add(EventOutcome outcome) {
    if (outcome == EventOutcome::kUsed || outcome == EventOutcome::kUsedLate) ++used;
    if (outcome == EventOutcome::kTooOld) ++too_old;
    if (outcome == EventOutcome::kNotFinite) ++not_finite;
    if (outcome == EventOutcome::kGated) ++gated;
    if (outcome == EventOutcome::kTooFrequent) ++too_frequent;
    if (outcome == EventOutcome::kNotPossible) ++not_possible;
    if (outcome == EventOutcome::kRepeated) ++repeated;
    if (outcome == EventOutcome::kTakenBack || outcome == EventOutcome::kWithdrawn) ++taken_back;
    if (outcome == EventOutcome::kWouldOverflow) ++overflowing;
  }
};

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

class ArrivalOrderTest : public ::testing::TestWithParam<std::string> {
 protected:
  ArrivalOrderTest() : is_certified_(GetParam().find('/') != std::string::npos) {
    if (!is_certified_) {
      config_ = test::read_example(GetParam());
      return;
    }
    test::CertifiedGains gains(GetParam());
    gains.assuming("{initial_error: 1, noise: 0.1, disturbance: 0}");
    const bool is_held = gains.certificate().subject.plant.mode().C_c.rows() > 0;
    if (is_held) gains.with("error_assumptions: {output_rate: 2}");
    config_ = gains.config();
    if (!config_.plant->jumps()) return;
    limited_ = gains
                   .with(
                       "jumps: {min_separation: 0.02, max_per_second: 3, dwell_time: [0, 0.3], "
                       "average_dwell_time: {tau: 0.1, N0: 3}}")
                   .config()
                   .law;
  }

  int any(int below) { return std::uniform_int_distribution<int>(0, below - 1)(generator_); }
  bool in_one_of(int cases) { return any(cases) == 0; }

  /// The observer with anything around it that it may have.
  std::shared_ptr<const ObserverLaw> any_law() {
    std::shared_ptr<const ObserverLaw> law = config_.law;
    if (is_certified_) {
      if (limited_ && in_one_of(2)) law = limited_;
    } else {
      law = {config_.law, &config_.law->observer()};
      if (config_.plant->jumps()) {
        if (in_one_of(2)) law = std::make_shared<const DelayedJumps>(law);
        if (in_one_of(2) && config_.plant->outputs(SensorTiming::kContinuous) == 0) {
          law = std::make_shared<const RestingEstimate>(law, any_rest());
        }
        if (in_one_of(2)) law = std::make_shared<const MissingJumpsWatch>(law, any_watch(*law));
        const double most = any(3) == 0 ? 2.0 : 100.0;
        const JumpLimits limits{in_one_of(2) ? 0 : kSpan / 5, most};
        if (in_one_of(2)) law = std::make_shared<const LimitedJumps>(law, limits);
        if (in_one_of(2)) {
          law = std::make_shared<const PossibleJumps>(law, JumpGate{any_set(), kSpan / 4});
        }
        if (in_one_of(2)) law = std::make_shared<const NumberedJumps>(law);
        if (in_one_of(2)) law = std::make_shared<const DwellTimesWatch>(law, any_dwell_times());
      }
    }
    if (in_one_of(2))
      law = std::make_shared<const GatedMeasurements>(law, test::narrow_gates(config_));
    return law;
  }

  /// Where the first state, or the negative one, is at most as large as a margin.
  StateSet any_set() {
    Eigen::MatrixXd first = Eigen::MatrixXd::Zero(1, config_.plant->states());
    first(0, 0) = in_one_of(2) ? 1.0 : -1.0;
    const std::vector<std::shared_ptr<const VectorMap>> formulas(
        config_.plant->modes().size(), std::make_shared<const AffineMap>(first));
    return {formulas, Eigen::VectorXd::Constant(1, 0.1 * any(5))};
  }

  RestState any_rest() {
    const Eigen::MatrixXd half =
        0.5 * Eigen::MatrixXd::Identity(config_.plant->states(), config_.plant->states());
    return {any_set(), std::make_shared<const AffineMap>(half)};
  }

  DwellTimes any_dwell_times() {
    DwellTimes times;
    times.shortest = any(2) * kSpan / 50;
    if (in_one_of(2)) times.longest = kSpan / 3;
    const DwellTimes::Average average{kSpan / (1 + any(10)), 1.0 + any(3)};
    if (in_one_of(2)) times.average = average;
    if (in_one_of(2)) times.reverse_average = average;
    return times;
  }

  MissingJumps any_watch(const ObserverLaw& law) {
    const bool may_predict = !law.delays_jumps() && !config_.plant->switches();
    const Duration step = law.flow_step() == 0 ? kSpan / 500 : 2 * law.flow_step();
    return {any_set(),
            may_predict && !in_one_of(4) ? MissingJumps::Action::kPredict
                                         : MissingJumps::Action::kReport,
            step};
  }

  std::unique_ptr<Estimator> make(const Timeline::Limits& history) const {
    Estimator::Options options = config_.options;
    options.history = history;
    options.start = start_;
    return std::make_unique<Estimator>(law_, options);
  }

  /// A log that is full after some events, or reaches back for a short time.
  Timeline::Limits any_limits() {
    constexpr std::size_t kLengths[] = {1, 2, 3, 5, 10};
    const Duration history = in_one_of(3) ? kSpan / 4 : kRoomy.history;
    return {history, kLengths[any(5)]};
  }

  /// Events with signed zeros, with numbers that are too large or none, with a quiet time, and some
  /// of them twice.
  std::vector<OwnedEvent> any_events() {
    const std::size_t size = 2 + static_cast<std::size_t>(any(38));
    std::vector<OwnedEvent> events =
        test::random_events_for(*config_.law, generator_, size, kStart, kSpan);
    const Stamp quiet_from = in_one_of(3) ? kStart + any(static_cast<int>(kSpan)) : kNow;
    for (OwnedEvent& event : events) {
      if (event.stamp > quiet_from) event.stamp += kBeyondHorizon;
      for (double& value : event.values) {
        if (in_one_of(6)) value = in_one_of(2) ? 0.0 : -0.0;
        if (in_one_of(60)) value = in_one_of(2) ? 1e99 : -1e60;
        if (in_one_of(60)) value = std::numeric_limits<double>::quiet_NaN();
      }
    }
    for (std::size_t i = 0; i < size; ++i) {
      if (!in_one_of(6)) continue;
      events.push_back(events[i]);
      if (events[i].kind == EventKind::kJump && in_one_of(2)) take_back(events.back());
      for (double& value : events.back().values) {
        if (value == 0.0) value = -value;
      }
    }
    return events;
  }

  /// Makes an event that takes a jump back, or now and then one that was never told.
  void take_back(OwnedEvent& jump) {
    jump.kind = EventKind::kWithdrawal;
    if (in_one_of(4)) ++jump.index;
    if (in_one_of(4)) ++jump.stamp;
    if (in_one_of(2)) jump.values.clear();
  }

  /// When a jump takes effect where it is delayed: all of one stamp at once.
  static Stamp release_of(const OwnedEvent& jump) {
    constexpr Duration kDelays[] = {0, kSpan / 20, kSpan / 3, kBeyondHorizon};
    return jump.stamp + kDelays[jump.stamp % 4];
  }

  static EventReport take(Estimator& estimator, const OwnedEvent& event) {
    Event view = event.view();
    if (event.kind == EventKind::kJump) view.release = release_of(event);
    return estimator.submit(view, kNow);
  }

  /// Stamps at which estimates are compared: of events, just after them, and any.
  std::vector<Stamp> any_stamps(const std::vector<OwnedEvent>& events) {
    std::vector<Stamp> stamps = {kStart - 1};
    for (const OwnedEvent& event : events) {
      const Stamp near = in_one_of(2) ? event.stamp : event.stamp + 1;
      stamps.push_back(in_one_of(2) ? near : event.stamp + any(static_cast<int>(kSpan)));
    }
    return stamps;
  }

  /// Whether two estimators give the same from a stamp on, as far back as the first one reaches.
  bool agree(const Estimator& one, const Estimator& other, const std::vector<Stamp>& stamps) {
    Estimate found = one.make_estimate();
    Estimate expected = other.make_estimate();
    for (const Stamp stamp : stamps) {
      const Timeline::Query query = one.estimate_at(stamp, found);
      if (query == Timeline::Query::kBeforeWindow) continue;
      if (query != other.estimate_at(stamp, expected)) return false;
      if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) continue;
      if (query == Timeline::Query::kHeld) ++tally_.held;
      if (std::isfinite(law_->error_bound(found.state.data()))) ++tally_.bounded;
      if (law_->missing_jumps(found.state.data()) > 0.0) ++tally_.made_up;
      if (law_->is_at_rest(found.state.data())) ++tally_.at_rest;
      if (law_->skipped_jumps(found.state.data()) > 0.0) ++tally_.skipped;
      if (law_->dwell_violations(found.state.data()) > 0.0) ++tally_.ill_timed;
      if (!same_bits(expected.state, found.state) ||
          expected.counts.events != found.counts.events ||
          expected.counts.samples != found.counts.samples ||
          expected.counts.jumps != found.counts.jumps ||
          expected.counts.digest != found.counts.digest ||
          expected.counts.last_sample != found.counts.last_sample) {
        return false;
      }
    }
    return true;
  }

  /// Whether every order gives the same where nothing is forgotten.
  bool every_order_gives_the_same(std::vector<OwnedEvent> events,
                                  const std::vector<Stamp>& stamps) {
    const auto reference = make(kRoomy);
    for (const OwnedEvent& event : events) tally_.add(take(*reference, event).outcome);
    for (int order = 0; order < kOrders; ++order, ++tally_.orders) {
      std::shuffle(events.begin(), events.end(), generator_);
      const auto estimator = make(kRoomy);
      for (const OwnedEvent& event : events) take_and_ask(*estimator, event);
      if (!agree(*estimator, *reference, stamps)) return false;
    }
    return true;
  }

  /// Whether what a log in which little has place gives is what one in which all has place gives
  /// for the events that were taken in.
  bool is_function_of_events_taken_in(std::vector<OwnedEvent> events,
                                      const std::vector<Stamp>& stamps) {
    for (int order = 0; order < kOrders; ++order, ++tally_.orders) {
      std::shuffle(events.begin(), events.end(), generator_);
      const Timeline::Limits limits = any_limits();
      const auto estimator = make(limits);
      const auto reference = make(kRoomy);
      Stamp newest = 0;
      for (const OwnedEvent& event : events) {
        const std::optional<Stamp> before = forgotten_until(*estimator);
        const EventOutcome outcome = take_and_ask(*estimator, event).outcome;
        tally_.add(outcome);
        if (outcome == EventOutcome::kDuplicate) continue;
        if (outcome == EventOutcome::kTooOld || outcome == EventOutcome::kNotFinite) {
          Event refused = event.view();
          refused.stamp = std::max(refused.stamp, first_possible(before, newest, limits));
          reference->note_rejected(refused, kNow);
          // Samples that were refused are no event.
          const bool is_of_jump =
              event.kind == EventKind::kJump || event.kind == EventKind::kWithdrawal;
          if (event.kind != EventKind::kInput && !is_of_jump) continue;
          if (!minds_rejection_of(refused)) continue;
          newest = std::max(newest, refused.stamp);
          continue;
        }
        take(*reference, event);
        const bool is_released = event.kind == EventKind::kJump && law_->delays_jumps();
        newest = std::max(newest, is_released ? release_of(event) : event.stamp);
      }
      if (!agree(*estimator, *reference, stamps)) return false;
    }
    return true;
  }

  EventReport take_and_ask(Estimator& estimator, const OwnedEvent& event) {
    const EventReport report = take(estimator, event);
    Estimate estimate = estimator.make_estimate();
    if (in_one_of(4)) estimator.estimate_at(event.stamp + any(static_cast<int>(kSpan)), estimate);
    return report;
  }

  std::mt19937_64 generator_;
  bool is_certified_;
  ObserverConfig config_;
  std::shared_ptr<const ObserverLaw> limited_;
  std::shared_ptr<const ObserverLaw> law_;
  std::optional<Stamp> start_;
  Tally tally_;

 private:
  /// Whether the law looks at what was refused: else it does not come into the log.
  bool minds_rejection_of(const Event& refused) const {
    Event rejection;
    rejection.stamp = refused.stamp;
    rejection.kind = EventKind::kRejected;
    rejection.rejected = refused.kind == EventKind::kInput ? EventKind::kInput : EventKind::kJump;
    rejection.index = refused.index;
    return law_->accepts(rejection);
  }

  /// Stamp of the newest event forgotten.
  static std::optional<Stamp> forgotten_until(const Estimator& estimator) {
    Estimate estimate = estimator.make_estimate();
    const std::optional<Stamp> earliest = estimator.earliest();
    const bool forgot = earliest && estimator.estimate_at(*earliest - 1, estimate) ==
                                        Timeline::Query::kBeforeWindow;
    return forgot ? earliest : std::nullopt;
  }

  /// Where the log takes note of what came before it.
  Stamp first_possible(std::optional<Stamp> forgotten, Stamp newest,
                       const Timeline::Limits& limits) const {
    return std::max({newest - limits.history, forgotten ? *forgotten + 1 : 0, start_.value_or(0)});
  }
};

TEST_P(ArrivalOrderTest, GivesTheSameBits) {
  const std::size_t sets = sets_for_each_subject();
  for (std::size_t seed = 0; seed < sets; ++seed) {
    const std::string text = GetParam() + std::to_string(seed);
    std::seed_seq numbers(text.begin(), text.end());
    generator_.seed(numbers);
    law_ = any_law();
    start_.reset();
    if (in_one_of(2)) start_ = kStart - any(2) * kSpan / 10;
    const std::vector<OwnedEvent> events = any_events();
    const std::vector<Stamp> stamps = any_stamps(events);
    ASSERT_TRUE(every_order_gives_the_same(events, stamps)) << "seed " << seed;
    ASSERT_TRUE(is_function_of_events_taken_in(events, stamps)) << "seed " << seed;
  }
  std::printf(
      "%s: %zu sets of events in %zu orders; %zu events used, %zu too old, %zu not finite, "
      "%zu gated, %zu too frequent, %zu not possible, %zu repeated, %zu taken back, %zu would "
      "overflow; of the estimates compared %zu held, %zu with a bound, %zu with missing jumps, "
      "%zu with lost ones, %zu with some at other times, %zu at rest\n",
      GetParam().c_str(), sets, tally_.orders, tally_.used, tally_.too_old, tally_.not_finite,
      tally_.gated, tally_.too_frequent, tally_.not_possible, tally_.repeated, tally_.taken_back,
      tally_.overflowing, tally_.held, tally_.bounded, tally_.made_up, tally_.skipped,
      tally_.ill_timed, tally_.at_rest);
}

INSTANTIATE_TEST_SUITE_P(EverySubject, ArrivalOrderTest, ::testing::ValuesIn(subjects()),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& letter : name) {
                             const auto code = static_cast<unsigned char>(letter);
                             if (std::isalnum(code) == 0) letter = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace sampled_data_observers

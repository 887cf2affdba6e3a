// The fault campaign: a nodelet in a manager under a simulated clock, and all that may go wrong
// around it. Each row of doc/faults.md is a test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <set>

#include "faults/fault.h"
#include "messages/time_conversion.h"

namespace sampled_data_observers::test {

// What gtest shows of a parameter.
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.injected; }
void PrintTo(const StartFault& fault, std::ostream* out) { *out << fault.injected; }

namespace {

/// How long the estimate must stay right after it has recovered.
constexpr Duration kConfirmation = 500'000'000;

/// One bench, one roscore and one manager for all tests: no fault may harm what comes after it.
class Campaign : public testing::Environment {
 public:
  void SetUp() override { bench_ = std::make_unique<FaultBench>(); }
  void TearDown() override { bench_.reset(); }
  static FaultBench& bench() { return *bench_; }

 private:
  static inline std::unique_ptr<FaultBench> bench_;
};

double largest_error(const StateEstimate& estimate, const State& truth) {
  double largest = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    largest = std::max(largest, std::abs(estimate.state.at(i) - truth[i]));
  }
  return largest;
}

void expect_finite(const std::vector<StateEstimate>& estimates) {
  for (const StateEstimate& estimate : estimates) {
    for (const double value : estimate.state) {
      ASSERT_TRUE(std::isfinite(value)) << "at " << estimate.header.stamp;
    }
  }
}

/// The index of the first estimate after which the stamps increase.
std::size_t expect_increasing(const std::vector<StateEstimate>& estimates, std::size_t restarts) {
  std::size_t found = 0;
  std::size_t last = 0;
  for (std::size_t i = 1; i < estimates.size(); ++i) {
    if (estimates[i - 1].header.stamp < estimates[i].header.stamp) continue;
    ++found;
    last = i;
  }
  EXPECT_EQ(restarts, found) << "stamps went back";
  return last;
}

void expect_statuses(const std::map<std::uint8_t, int>& expected,
                     const std::vector<EventStatus>& statuses) {
  std::map<std::uint8_t, int> found;
  std::map<std::uint8_t, std::string> reasons;
  for (const EventStatus& status : statuses) {
    if (status.outcome == EventStatus::USED) continue;
    ++found[status.outcome];
    reasons[status.outcome] = status.reason;
  }
  for (const auto& [outcome, count] : expected) {
    if (count != kSome) {
      EXPECT_EQ(count, found[outcome]) << "of outcome " << int{outcome};
    }
    found.erase(outcome);
  }
  for (const auto& [outcome, count] : found) ADD_FAILURE() << count << " of: " << reasons[outcome];
}

class FaultTest : public testing::TestWithParam<Fault> {
 protected:
  /// So that a failure does not bring about others.
  void TearDown() override {
    if (HasFailure()) Campaign::bench().unload();
  }
};

TEST_P(FaultTest, Survives) {
  const Fault& fault = GetParam();
  FaultBench& bench = Campaign::bench();
  bench.use(configuration(fault.configuration));
  bench.settle();
  const double tolerance = bench.configuration().tolerance;

  fault.inject(bench);
  const Stamp end = bench.now();
  if (fault.meanwhile == Meanwhile::kRight) {
    bench.await_estimates();
    for (const StateEstimate& estimate : bench.estimates) {
      ASSERT_LE(largest_error(estimate, bench.truth(to_stamp(estimate.header.stamp))), tolerance)
          << "during the fault, at " << estimate.header.stamp;
    }
  }

  bench.push();
  const Stamp recovered = end + from_seconds(fault.recovery);
  bench.go_on(to_seconds(recovered + kConfirmation - end));
  bench.await_estimates();
  expect_finite(bench.estimates);
  EXPECT_EQ(bench.sent(), bench.statuses.size());
  expect_statuses(fault.statuses, bench.statuses);
  Stamp last_wrong = end;
  for (std::size_t i = expect_increasing(bench.estimates, fault.restarts);
       i < bench.estimates.size(); ++i) {
    const Stamp stamp = to_stamp(bench.estimates[i].header.stamp);
    if (stamp <= end) continue;
    const double error = largest_error(bench.estimates[i], bench.truth(stamp));
    if (error > tolerance) last_wrong = stamp;
    if (stamp > recovered) {
      ASSERT_LE(error, tolerance) << to_seconds(stamp - end) << " s after the fault";
    }
  }
  RecordProperty("recovered_after_ms", static_cast<int>((last_wrong - end) / 1'000'000));
}

class StartFaultTest : public testing::TestWithParam<StartFault> {
 protected:
  /// After all of them, a good configuration starts in the same manager.
  static void TearDownTestSuite() {
    Campaign::bench().use(configuration("oscillator"));
    Campaign::bench().settle();
  }
};

TEST_P(StartFaultTest, IsRefused) {
  FaultBench& bench = Campaign::bench();
  const Configuration good = configuration("oscillator");
  bench.unload();
  for (const StartFault::Change& change : GetParam().changes) {
    bench.observer().set_parameters(good.files);
    change(bench.observer());
    if (bench.observer().load(good.type)) {
      bench.observer().unload();
      FAIL() << "it starts";
    }
    FaultBench::require([&] { return !bench.observer().refusal().empty(); }, "nobody says why");
    EXPECT_NE(std::string::npos, bench.observer().refusal().find(GetParam().named))
        << bench.observer().refusal();
  }
}

template <class Row>
std::string name_of(const testing::TestParamInfo<Row>& info) {
  return info.param.name;
}

const std::map<std::string, std::vector<Fault>>& suites() {
  static const std::map<std::string, std::vector<Fault>> kSuites = {
      {"Value", value_faults()},
      {"Message", message_faults()},
      {"Stamp", stamp_faults()},
      {"Transport", transport_faults()},
      {"Jump", jump_faults()},
      {"Time", time_faults()},
      {"Transform", transform_faults()},
      {"Service", service_faults()},
      {"Certificate", certificate_faults()}};
  return kSuites;
}

INSTANTIATE_TEST_SUITE_P(Value, FaultTest, testing::ValuesIn(value_faults()), name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Message, FaultTest, testing::ValuesIn(message_faults()), name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Stamp, FaultTest, testing::ValuesIn(stamp_faults()), name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Transport, FaultTest, testing::ValuesIn(transport_faults()),
                         name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Jump, FaultTest, testing::ValuesIn(jump_faults()), name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Time, FaultTest, testing::ValuesIn(time_faults()), name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Transform, FaultTest, testing::ValuesIn(transform_faults()),
                         name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Service, FaultTest, testing::ValuesIn(service_faults()), name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Certificate, FaultTest, testing::ValuesIn(certificate_faults()),
                         name_of<Fault>);
INSTANTIATE_TEST_SUITE_P(Start, StartFaultTest, testing::ValuesIn(start_faults()),
                         name_of<StartFault>);

TEST(FaultDocument, HasARowForEachFaultAndNoOther) {
  std::set<std::string> rows;
  std::ifstream document(std::string(SDO_SOURCE_DIR) + "/doc/faults.md");
  for (std::string line; std::getline(document, line);) {
    if (line.rfind("| `", 0) == 0) rows.insert(line);
  }
  const auto expect_row = [&](const std::string& row) {
    if (rows.erase(row) == 0) ADD_FAILURE() << "doc/faults.md lacks\n" << row;
  };
  for (const auto& [suite, faults] : suites()) {
    for (const Fault& fault : faults) expect_row(document_row(suite, fault));
  }
  for (const StartFault& fault : start_faults()) expect_row(document_row(fault));
  for (const std::string& row : rows) ADD_FAILURE() << "doc/faults.md has no test for\n" << row;
}

}  // namespace
}  // namespace sampled_data_observers::test

int main(int argc, char** argv) {
  ros::init(argc, argv, "faults_test");
  const ros::NodeHandle alive;  // roscpp shuts down with the last handle
  testing::InitGoogleTest(&argc, argv);
  testing::AddGlobalTestEnvironment(new sampled_data_observers::test::Campaign);
  return RUN_ALL_TESTS();
}

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "faults/fault_bench.h"

namespace sampled_data_observers::test {

/// How the estimate is while the fault lasts. In all cases it is finite, with increasing stamps.
enum class Meanwhile : std::uint8_t {
  kRight,  ///< As if there were no fault: within the tolerance of the truth.
  kFinite  ///< Wrong, or not published.
};

/// Stands in Fault::statuses for a number that depends on how threads are scheduled.
constexpr int kSome = -1;

/// One fault, and what must hold. It begins with an observer that has the right estimate. When it
/// is over, the plant is pushed; samples are as they should be, and the observer must find it
/// again.
struct Fault {
  /// Of the test.
  std::string name;
  std::string configuration;
  /// What is injected, for the document.
  std::string injected;
  std::function<void(FaultBench&)> inject;
  /// How many events have each outcome. All others must be USED, and each message sent must have a
  /// status.
  std::map<std::uint8_t, int> statuses;
  Meanwhile meanwhile = Meanwhile::kRight;
  /// Simulated time after the fault, in seconds, from which on the estimate is right again.
  double recovery = 1.0;
  /// How often the stamps of the estimates go back: when time does.
  std::size_t restarts = 0;
};

std::vector<Fault> value_faults();
std::vector<Fault> message_faults();
std::vector<Fault> stamp_faults();
std::vector<Fault> transport_faults();
std::vector<Fault> jump_faults();
std::vector<Fault> time_faults();
std::vector<Fault> transform_faults();
std::vector<Fault> service_faults();
std::vector<Fault> certificate_faults();

/// A configuration with which no observer may start. Afterwards, in the same manager, a good one
/// must start.
struct StartFault {
  /// Of the test.
  std::string name;
  /// What is wrong, for the document.
  std::string injected;
  /// Changes the parameters of a good configuration.
  using Change = std::function<void(ObserverUnderTest&)>;
  /// Each of them does for itself.
  std::vector<Change> changes;
  /// What the refusal in the log names.
  std::string named;
};

std::vector<StartFault> start_faults();

/// The row of doc/faults.md that says what a test does.
std::string document_row(const std::string& suite, const Fault& fault);
std::string document_row(const StartFault& fault);

}  // namespace sampled_data_observers::test

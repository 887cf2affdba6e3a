// Calls of the services that ask for what cannot be, or come at a bad time.
#include <sampled_data_observers/EnableSensor.h>
#include <sampled_data_observers/Reset.h>

#include <filesystem>
#include <future>
#include <limits>

#include "faults/fault.h"
#include "faults/messages.h"
#include "messages/time_conversion.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

void require(bool condition, const std::string& complaint) {
  if (!condition) throw std::runtime_error(complaint);
}

std::function<void(FaultBench&)> reset_to(const std::vector<double>& state) {
  return [state](FaultBench& bench) {
    bench.go_on(0.1);
    require(!bench.observer().reset(state), "it was reset");
    bench.go_on(0.1);
  };
}

/// A file that must not be loaded.
std::function<void(FaultBench&)> reload(const std::string& file, const std::string& text = "") {
  return [file, text](FaultBench& bench) {
    if (!text.empty()) bench.observer().write_gains(file, text);
    bench.go_on(0.1);
    const ReloadGains::Response response = bench.observer().reload(file);
    require(response.success == 0, "it was loaded");
    require(!response.message.empty(), "it does not say why");
    bench.go_on(0.1);
  };
}

/// The covariances of the messages go on to be used, before and after.
void reload_other_covariance(FaultBench& bench) {
  reload("matrix.yaml",
         "gains: {P0: {diagonal: [1, 1]}, R: {imu: [[1]]}, Q: {diagonal: [0.1, 100]}}")(bench);
  const ReloadGains::Response refused = bench.observer().reload("matrix.yaml");
  require(refused.message.find("gains/R/imu") != std::string::npos, refused.message);
  bench.observer().write_gains(
      "same.yaml", "gains: {P0: {diagonal: [1, 1]}, R: message, Q: {diagonal: [0.1, 100]}}");
  const ReloadGains::Response loaded = bench.observer().reload("same.yaml");
  require(loaded.success != 0, loaded.message);
  bench.go_on(0.3);
  require(bench.statuses.back().outcome == EventStatus::USED, bench.statuses.back().reason);
}

void reload_link(FaultBench& bench) {
  const std::string link = bench.observer().gains_directory() + "/link.yaml";
  std::filesystem::remove(link);
  std::filesystem::create_symlink(std::string(SDO_SOURCE_DIR) + "/test/ros/gains/smaller.yaml",
                                  link);
  reload("link.yaml")(bench);
}

/// One that was loaded, and is gone the next time.
void reload_vanished(FaultBench& bench) {
  bench.observer().write_gains("same.yaml", "gains: {L: [[0.9], [7]]}");
  require(bench.observer().reload("same.yaml").success != 0, "it was not loaded");
  std::filesystem::remove(bench.observer().gains_directory() + "/same.yaml");
  reload("same.yaml")(bench);
}

/// 499 samples are on their way when the reset comes.
void reset_in_burst(FaultBench& bench) {
  bench.let_pass(0.5);
  for (int i = 499; i > 0; --i) bench.sample(bench.now() - i * kMillisecond);
  require(bench.observer().reset({}), "it was not reset");
  bench.await_statuses();
}

/// The next sample is no good: the estimate must wait for the one behind it.
void reset_at_bad_sample(FaultBench& bench) {
  Reset::Request request;
  request.at_next_sample = 1;
  require(bench.observer().call<Reset>("reset", request).success != 0, "it was not reset");
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  bench.go_on(0.3, [&](Stamp stamp) { bench.sample(stamp, not_a_number); });
  require(bench.get_estimate().success == 0, "there is an estimate");
}

void switched_off(FaultBench& bench) {
  bench.go_on(0.1);
  bench.observer().set_enabled(false);
  bench.go_on(1.0);
  bench.observer().set_enabled(true);
}

void sensor_off(FaultBench& bench) {
  require(!bench.observer().enable_sensor("nobody", false), "a sensor that is none");
  bench.observer().enable_sensor("position", false);
  bench.go_on(1.0);
  bench.observer().enable_sensor("position", true);
}

void odd_stamps(FaultBench& bench) {
  ros::Time garbage;
  garbage.sec = garbage.nsec = 4294967295u;
  for (const ros::Time& stamp : {garbage, ros::Time(0, 1), ros::Time(1, 0)}) {
    require(bench.get_estimate(stamp).success == 0, "an estimate of no time");
  }
  const GetEstimate::Response last = bench.get_estimate(ros::Time(4294967295u, 999999999u));
  require(last.success != 0, "no estimate of the far future");
  for (const double value : last.estimate.state) require(std::abs(value) < 10.0, "it diverges");
  bench.go_on(0.1);
}

/// Calls of one caller, over and over.
template <class Service>
std::future<void> keep_calling(const std::string& name, const typename Service::Request& request) {
  const bool persistent = true;
  ros::NodeHandle handle;
  const ros::ServiceClient made = handle.serviceClient<Service>(name, persistent);
  return std::async(std::launch::async, [made, request] {
    ros::ServiceClient client = made;
    Service call;
    call.request = request;
    for (int i = 0; i < 200; ++i) require(client.call(call), "no answer");
  });
}

/// Four callers at once, while samples come.
void many_callers(FaultBench& bench) {
  ReloadGains::Request missing;
  missing.file = "missing.yaml";
  EnableSensor::Request enable;
  enable.name = "position";
  enable.enabled = 1;
  std::vector<std::future<void>> callers;
  for (int i = 0; i < 2; ++i) {
    callers.push_back(keep_calling<ReloadGains>("reload_gains", missing));
    callers.push_back(keep_calling<EnableSensor>("enable_sensor", enable));
  }
  bench.go_on(1.0);
  for (std::future<void>& caller : callers) caller.get();
}

}  // namespace

std::vector<Fault> service_faults() {
  constexpr auto kFinite = Meanwhile::kFinite;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {
      {"ResetToNotANumber", "oscillator", "a reset to NaN: refused", reset_to({kNaN, 0.0}), {}},
      {"ResetToTooMuch", "oscillator", "a reset to 1e300: refused", reset_to({1e300, 0.0}), {}},
      {"ResetToWrongSize",
       "oscillator",
       "a reset to three values, of two states: refused",
       reset_to({1.0, 2.0, 3.0}),
       {}},
      {"ResetInABurst",
       "oscillator",
       "a reset while 499 samples are on their way",
       reset_in_burst,
       {{EventStatus::TOO_OLD, kSome}},
       kFinite,
       1.5},
      {"ResetAtABadSample",
       "oscillator",
       "a reset to the next sample, and the next are NaN",
       reset_at_bad_sample,
       {{EventStatus::NOT_FINITE, 3}},
       kFinite,
       1.5},
      {"ReloadOfBrokenFile",
       "oscillator",
       "gains in a file that is no YAML: refused",
       reload("broken.yaml", "gains: {L: [[0.9"),
       {}},
      {"ReloadOfWrongSize",
       "oscillator",
       "gains of the wrong size: refused",
       reload("size.yaml", "gains: {L: [[0.9]]}"),
       {}},
      {"ReloadOfNotANumber",
       "oscillator",
       "gains that are NaN: refused",
       reload("nan.yaml", "gains: {L: [[.nan], [7]]}"),
       {}},
      {"ReloadOfOtherKeys",
       "oscillator",
       "a gain file that would change the rate: refused",
       reload("rate.yaml", "gains: {L: [[0.9], [7]]}\nrate: 1"),
       {}},
      {"ReloadOfOtherCovariance",
       "filtered",
       "gains with a matrix R, where it comes with the messages: refused; those where it does are "
       "loaded",
       reload_other_covariance,
       {}},
      {"ReloadOfMissingFile",
       "oscillator",
       "a gain file that is not there: refused",
       reload("missing.yaml"),
       {}},
      {"ReloadOfVanishedFile",
       "oscillator",
       "a gain file that was loaded, and is gone: refused",
       reload_vanished,
       {},
       kFinite},
      {"ReloadOutside",
       "oscillator",
       "a path out of the directory of gains: refused",
       reload("../../../../../../etc/hostname"),
       {}},
      {"ReloadOfLink",
       "oscillator",
       "a link out of the directory of gains: refused",
       reload_link,
       {}},
      {"ReloadOfDirectory",
       "oscillator",
       "a directory instead of a gain file: refused",
       reload("."),
       {}},
      {"SwitchedOff",
       "oscillator",
       "switched off for 1 s",
       switched_off,
       {{EventStatus::DISABLED, 20}},
       kFinite},
      {"SensorOff",
       "oscillator",
       "its only sensor switched off for 1 s, and one that is none",
       sensor_off,
       {{EventStatus::DISABLED, 10}}},
      {"OddStamps", "oscillator", "get_estimate at garbage, at 1970 and at 2106", odd_stamps, {}},
      {"ManyCallers", "oscillator", "four callers of services at once", many_callers, {}},
  };
}

}  // namespace sampled_data_observers::test

#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>

#include <mutex>
#include <string>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/runtime/diagnosis.h"
#include "sampled_data_observers/runtime/run_statistics.h"

namespace sampled_data_observers {

/// What the diagnostics of an observer compare it with.
DiagnosisSubject diagnosis_subject(const ObserverConfig& config);

/// Publishes a Diagnosis on /diagnostics, once a second of wall time: also while simulated time
/// stands still.
class DiagnosticsReporter {
 public:
  /// @param handle          its callback queue reports: it must not be that of a thread in a hurry
  /// @param private_handle  where diagnostic_updater looks for its parameters
  /// @param log             of the node or nodelet, whose name it bears
  /// @param subject         what the observer is configured to do
  /// @param recorder        what it does; read by nobody else
  DiagnosticsReporter(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                      NodeLog log, DiagnosisSubject subject, StatisticsRecorder& recorder);

  /// Compares with what the observer does with other gains from now on. For any thread that is not
  /// in a hurry.
  void note_other_gains(const ObserverConfig& config);

  /// See Diagnosis::set_published_type(). For any thread that is not in a hurry.
  void note_published_type(std::size_t channel, const std::string& type);

  /// Takes the datum of the local plane.
  void note_datum(const std::string& datum);

 private:
  void report(const ros::SteadyTimerEvent&);
  void tell_of_guarantee();
  void tell_of_inputs();

  const NodeLog log_;
  StatisticsRecorder& recorder_;
  std::mutex mutex_;  ///< of the diagnosis
  Diagnosis diagnosis_;
  std::string datum_;  ///< of the local plane; empty without
  RunStatistics window_;
  Stamp last_now_ = 0;
  bool was_suspended_ = false;
  bool was_input_stale_ = false;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace sampled_data_observers

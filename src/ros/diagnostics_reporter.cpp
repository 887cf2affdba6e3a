#include "sampled_data_observers/ros/diagnostics_reporter.h"

#include <utility>

#include "messages/time_conversion.h"
#include "sampled_data_observers/config/event_channels.h"

namespace sampled_data_observers {
namespace {

constexpr double kReportPeriod = 1.0;  // s

void copy(const Finding& finding, diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(static_cast<std::uint8_t>(finding.level), finding.message);
  for (const auto& [key, value] : finding.values) status.add(key, value);
}

}  // namespace

DiagnosisSubject diagnosis_subject(const ObserverConfig& config) {
  DiagnosisSubject subject;
  for (const EventChannel& channel : event_channels(config)) {
    subject.channels.push_back({channel.name, channel.source.topic, channel.kind,
                                channel.source.type, static_cast<std::size_t>(channel.sensor)});
  }
  subject.period = config.period;
  subject.sampling = config.options.sampling;
  subject.history = config.options.history.history;
  subject.jump_back_tolerance = config.jump_back_tolerance;
  subject.guarantee = config.guarantee;
  subject.warning = config.warning;
  return subject;
}

DiagnosticsReporter::DiagnosticsReporter(const ros::NodeHandle& handle,
                                         const ros::NodeHandle& private_handle, NodeLog log,
                                         DiagnosisSubject subject, StatisticsRecorder& recorder)
    : log_(std::move(log)),
      recorder_(recorder),
      diagnosis_(std::move(subject)),
      window_(diagnosis_.subject().channels.size()),
      updater_(handle, private_handle, log_.name()) {
  updater_.setHardwareID("none");
  updater_.add("estimates", [this](auto& status) { copy(diagnosis_.estimates(), status); });
  updater_.add("certificate", [this](auto& status) { copy(diagnosis_.certificate(), status); });
  for (std::size_t i = 0; i < window_.channels.size(); ++i) {
    updater_.add("events from " + diagnosis_.subject().channels[i].name,
                 [this, i](auto& status) { copy(diagnosis_.channel(i), status); });
  }
  timer_ = ros::NodeHandle(handle).createSteadyTimer(ros::WallDuration(kReportPeriod),
                                                     &DiagnosticsReporter::report, this);
}

/// Once when the guarantee is suspended, and once when it is restored.
void DiagnosticsReporter::tell_of_guarantee() {
  const bool is_suspended = diagnosis_.is_suspended();
  if (is_suspended == was_suspended_) return;
  was_suspended_ = is_suspended;
  const std::string message = "guarantee " + diagnosis_.certificate().message;
  if (is_suspended) {
    log_.warn("%s", message.c_str());
  } else {
    log_.info("%s", message.c_str());
  }
}

void DiagnosticsReporter::note_other_gains(const ObserverConfig& config) {
  DiagnosisSubject subject = diagnosis_subject(config);
  const std::lock_guard<std::mutex> lock(mutex_);
  diagnosis_.set_subject(std::move(subject));
}

void DiagnosticsReporter::note_published_type(std::size_t channel, const std::string& type) {
  const std::lock_guard<std::mutex> lock(mutex_);
  diagnosis_.set_published_type(channel, type);
}

void DiagnosticsReporter::report(const ros::SteadyTimerEvent&) {
  const Stamp now = to_stamp(ros::Time::now());
  if (last_now_ == 0 && now > 0) {  // time begins: wait for the first second of it
    last_now_ = now;
    return;
  }
  recorder_.take(window_);
  const std::lock_guard<std::mutex> lock(mutex_);
  diagnosis_.update(window_, now, now - last_now_);
  tell_of_guarantee();
  last_now_ = now;
  updater_.force_update();
}

}  // namespace sampled_data_observers

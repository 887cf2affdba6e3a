#include "sampled_data_observers/ros/diagnostics_reporter.h"

#include <locale>
#include <sstream>
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

/// Of a channel of inputs.
void describe_timeout(const Plant& plant, DiagnosisSubject::Channel& channel) {
  const InputChannel& inputs = plant.input_channels()[channel.sensor];
  channel.timeout = inputs.timeout;
  for (std::size_t i = 0; i < inputs.after_timeout.size(); ++i) {
    std::ostringstream value;
    value.imbue(std::locale::classic());
    value << plant.input_names()[static_cast<std::size_t>(inputs.inputs[i])] << " = "
          << inputs.after_timeout[i];
    channel.after_timeout += (i > 0 ? ", " : "") + value.str();
  }
}

}  // namespace

DiagnosisSubject diagnosis_subject(const ObserverConfig& config) {
  DiagnosisSubject subject;
  for (const EventChannel& channel : event_channels(config)) {
    const auto sensor = static_cast<std::size_t>(channel.sensor);
    DiagnosisSubject::Channel described{channel.name,
                                        channel.source.topic,
                                        channel.kind,
                                        channel.source.type,
                                        sensor,
                                        channel.source.size,
                                        0,
                                        {}};
    if (channel.kind == EventKind::kInput) describe_timeout(*config.plant, described);
    subject.channels.push_back(std::move(described));
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
  updater_.add("estimates", [this](auto& status) {
    copy(diagnosis_.estimates(), status);
    if (!datum_.empty()) status.add("datum of the local plane", datum_);
  });
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

/// Once when estimates begin to rest on an input that is stale, and once when they don't any more.
void DiagnosticsReporter::tell_of_inputs() {
  if (window_.lateness.count == 0) return;
  const bool is_stale = window_.input_stale > 0;
  if (is_stale == was_input_stale_) return;
  was_input_stale_ = is_stale;
  if (is_stale) {
    log_.warn("estimates rest on an input older than its timeout: see /diagnostics");
  } else {
    log_.info("inputs come in time again");
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

void DiagnosticsReporter::note_datum(const std::string& datum) {
  const std::lock_guard<std::mutex> lock(mutex_);
  datum_ = datum;
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
  tell_of_inputs();
  last_now_ = now;
  updater_.force_update();
}

}  // namespace sampled_data_observers

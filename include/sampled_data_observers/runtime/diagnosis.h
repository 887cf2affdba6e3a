#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sampled_data_observers/hybrid/event.h"
#include "sampled_data_observers/runtime/clock_jumps.h"
#include "sampled_data_observers/runtime/run_statistics.h"

namespace sampled_data_observers {

/// The levels of diagnostic_msgs/DiagnosticStatus.
enum class HealthLevel : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

/// One line of diagnostics: what is the matter and what to do, and the figures behind it.
struct Finding {
  /// kOk where there is nothing to do.
  HealthLevel level = HealthLevel::kOk;
  /// For people: what is the matter, and the remedy.
  std::string message;
  /// Names and figures, in the order in which they are shown.
  std::vector<std::pair<std::string, std::string>> values;
};

/// What an observer is configured to do, as far as diagnostics compare it with what it does.
struct DiagnosisSubject {
  /// One of the places where events enter.
  struct Channel {
    /// As in EventStatus.
    std::string name;
    /// As configured.
    std::string topic;
    /// Of the events that its messages become.
    EventKind kind = EventKind::kSample;
    /// Of its messages, as "package/Type".
    std::string type;
    /// Index of the sensor, for samples.
    std::size_t sensor = 0;
    /// How many numbers it measures.
    std::size_t outputs = 0;
    /// Of inputs: how long they hold [ns]; 0: until the next ones.
    Duration timeout = 0;
    /// What they are then, in words; empty: they hold all the same.
    std::string after_timeout = {};
  };

  /// In the order of RunStatistics::channels.
  std::vector<Channel> channels;
  /// Of the estimates [ns].
  Duration period = 0;
  /// What intervals are compared with.
  SensorSampling sampling;
  /// The history window [ns].
  Duration history = 0;
  /// By how much time may go back and is taken for corrected [ns].
  Duration jump_back_tolerance = 0;
  /// As in ObserverConfig.
  std::string guarantee;
  /// As in ObserverConfig.
  std::string warning;

  /// The times between the events of a channel.
  const SamplingBounds& sampling_of(const Channel& channel) const;
};

/// Judges what an observer did in a time, for people who ask why there is no estimate, or why a
/// measurement was not used. It keeps what it needs to tell since when something is so.
class Diagnosis {
 public:
  /// Of an observer that did nothing yet.
  explicit Diagnosis(DiagnosisSubject subject);

  /// Takes in what was recorded since the last call.
  /// @param window   what was recorded, of as many channels as the subject has
  /// @param now      ROS time; 0 while there is none
  /// @param elapsed  ROS time since the last call [ns]; 0 where time stands still
  void update(const RunStatistics& window, Stamp now, Duration elapsed);

  /// Goes on with what the observer is configured to do from now on, as after a change of gains.
  /// @pre the channels are the same
  void set_subject(DiagnosisSubject subject) { subject_ = std::move(subject); }

  /// Takes in the type under which the topic of a channel is published; empty where nobody does.
  void set_published_type(std::size_t channel, std::string type);

  /// "estimates": whether they come at their rate and in time.
  Finding estimates() const;
  /// What becomes of the messages of one channel.
  Finding channel(std::size_t index) const;
  /// Whether what the certificate rests on holds.
  Finding certificate() const;

  /// Whether what the certificate rests on does not hold now.
  bool is_suspended() const { return suspension_.has_value(); }

  /// As given last.
  const DiagnosisSubject& subject() const { return subject_; }

 private:
  struct ChannelMemory {
    std::string published_type;
    /// When the last window with a message, and the last with a used one, ended; 0: never.
    Stamp received = 0;
    Stamp used = 0;
    /// The newest stamp of those used; 0: none was.
    Stamp newest = 0;
    /// How far all stamps of the last window with a message lie behind the clock, where that is
    /// more than the history window; 0: they do not.
    Duration behind = 0;

    void forget_events() { received = used = newest = behind = 0; }
  };
  /// What the certificate rests on and does not hold.
  struct Suspension {
    Stamp since = 0;
    std::string reason;
  };

  std::optional<Suspension> find_suspension() const;
  std::string why_bound_is_lost() const;
  std::string why_no_estimate() const;
  std::string why_it_diverges(InnovationTrend trend) const;
  std::string wrong_type(std::size_t channel) const;
  std::string why_stamps_are_old() const;
  std::string rejections(const ChannelStatistics& statistics) const;
  std::string why_input_is_stale(std::size_t index) const;
  void add_innovations(std::size_t index, Finding& finding) const;
  void add_times_between_samples(std::size_t index, Finding& finding) const;
  void add_bounds_of_all(Finding& finding) const;

  DiagnosisSubject subject_;
  ClockJumps clock_;
  RunStatistics window_;
  RunStatistics totals_;
  std::vector<ChannelMemory> memory_;
  Stamp now_ = 0;
  /// When the first window with an estimate ended; 0: none did.
  Stamp begun_ = 0;
  Duration elapsed_ = 0;
  std::uint64_t newly_missing_ = 0;
  std::uint64_t newly_skipped_ = 0;
  std::uint64_t new_dwell_violations_ = 0;
  std::optional<Suspension> suspension_;
  /// When the last suspension ended, and what it was.
  Stamp restored_ = 0;
  Suspension last_suspension_;
};

/// A hint where T1 and T2 are so far from the mean time between samples that their unit must be
/// another one than seconds; else empty.
/// @param mean  time between samples [s]
/// @param T1    as configured [s]
/// @param T2    likewise; may be infinite
std::string describe_unit_of_times(double mean, double T1, double T2);

/// What is said of a topic with another type of messages than what is configured.
std::string describe_wrong_type(const std::string& topic, const std::string& published,
                                const std::string& expected);

/// How far stamps lie ahead of the clock in the median, and what to do.
/// @param latency  time of arrival minus stamp, < 0 [ns]
std::string describe_stamps_ahead(Duration latency);

/// What is said of a topic whose stamps lie so far behind the clock.
std::string describe_old_stamps(const std::string& topic, Duration behind);

}  // namespace sampled_data_observers

#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "design/explanation.h"
#include "design/observability.h"
#include "design/paragraphs.h"

namespace sampled_data_observers {

/// Why no observer whatever can converge, and what would change that.
struct Obstacle {
  std::string name;
  std::string why;
  std::string remedy;
};

/// What the parts of an explanation share.
struct ExplanationContext {
  explicit ExplanationContext(const CertificateSubject& about)
      : subject(about), plant(about.plant) {}

  bool has_times() const { return subject.T2 > 0.0; }
  bool has_longest() const { return has_times() && std::isfinite(subject.T2); }
  std::string times() const {
    if (has_longest()) {
      return "[T1, T2] = [" + brief(subject.T1) + ", " + brief(subject.T2) + "] s";
    }
    return "[T1, T2] = [" + brief(subject.T1) + ", inf] s (looked at up to " + brief(longest()) +
           " s)";
  }
  /// Of times between events [s].
  double longest() const { return longest_looked_at(subject); }
  bool has_several_sensors() const { return plant.sampled.size() > 1; }
  bool has_times_of_sensors() const { return !subject.sensor_times.empty(); }
  /// Else jumps or other modes may show what one flow does not.
  bool only_flows() const { return !plant.jumps() && plant.modes.size() == 1; }
  std::string moved(const Mode& mode) const {
    return states_moved(mode.directions, plant.state_names);
  }

  const CertificateSubject& subject;
  const PlantMatrices& plant;
  /// For headings: empty, or which mode of a switched plant they are about.
  std::string mode_name;
  std::vector<Obstacle> obstacles;
  Paragraphs out;
};

std::string seconds(double value);

/// What a mode does by itself.
std::string fate(const Mode& mode, TimeDomain domain);

// The parts, one source file each, or each family.

void say_modes(ExplanationContext& c, const std::string& heading, const Eigen::MatrixXd& A,
               TimeDomain domain);
/// @return whether what is unseen decays
bool say_unseen(ExplanationContext& c, const std::vector<Mode>& unseen, TimeDomain domain);
void say_sampled_output(ExplanationContext& c, const ModeMatrices& mode);
/// Of several sensors, each sampled at times of its own.
void say_sampled_sensors(ExplanationContext& c, const ModeMatrices& mode);
/// "gps in [T1, T2] = [0.2, 1] s, …"
std::string times_of_sensors(const ExplanationContext& c);
void say_continuous_output(ExplanationContext& c, const ModeMatrices& mode);
void say_output_at_jumps(ExplanationContext& c, const ModeMatrices& mode);
/// Conditions (C) of bernard2022 with a quadratic Lyapunov function, in terms of the error, not
/// of its square.
void say_dwell_times(ExplanationContext& c, const ModeMatrices& mode);
/// What no time between samples can do by ferrante2019: Proposition 1, (31), and the gain of
/// Remark 3.
void say_least_gain(ExplanationContext& c);

}  // namespace sampled_data_observers

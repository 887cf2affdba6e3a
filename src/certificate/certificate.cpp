#include "certificate/certificate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <regex>
#include <stdexcept>
#include <utility>

#include "certificate/theorems.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {

namespace {

void require_times(TheoremTimes times, const CertificateSubject& subject) {
  const bool is_average = times == TheoremTimes::kAverageDwellTime;
  if (is_of_average(times)) {
    const auto kind = is_average ? DwellTime::Kind::kAverage : DwellTime::Kind::kReverseAverage;
    if (subject.dwell_time && subject.dwell_time->kind == kind) return;
    throw std::invalid_argument(is_average ? "it is about jumps with an average dwell time "
                                             "(design/average_dwell_time)"
                                           : "it is about jumps with a reverse average dwell time "
                                             "(design/reverse_average_dwell_time)");
  }
  if (subject.dwell_time) {
    throw std::invalid_argument(
        "it is about bounds on each time between events (T1, T2), not on their average");
  }
  if (times == TheoremTimes::kUpToT2 && std::isinf(subject.T2)) {
    throw std::invalid_argument("it is about times between events up to a longest one: T2 = inf");
  }
}

void require_one_sensor(const CertificateSubject& subject) {
  const std::size_t count = subject.plant.sampled.size();
  if (count <= 1) return;
  throw std::invalid_argument("it is about one sensor whose outputs are measured together, but " +
                              std::to_string(count) + " sensors are sampled");
}

}  // namespace

std::vector<SamplingTimes> times_of_timers(const CertificateSubject& subject) {
  if (!subject.sensor_times.empty()) return subject.sensor_times;
  return {{subject.T1, subject.T2}};
}

void set_sensor_times(CertificateSubject& subject, std::vector<SamplingTimes> times) {
  subject.T1 = times.front().T1;
  subject.T2 = times.front().T2;
  for (const SamplingTimes& of_sensor : times) {
    subject.T1 = std::min(subject.T1, of_sensor.T1);
    subject.T2 = std::max(subject.T2, of_sensor.T2);
  }
  subject.sensor_times = std::move(times);
}

double time_scale(const CertificateSubject& subject) {
  if (std::isfinite(subject.T2)) return subject.T2;
  if (subject.dwell_time) return subject.dwell_time->tau;
  if (subject.T1 > 0.0) return subject.T1;
  double fastest = 0.0;
  for (const ModeMatrices& mode : subject.plant.modes) {
    fastest = std::max(fastest, eigenvalues_of(mode.A).cwiseAbs().maxCoeff());
  }
  return std::isfinite(fastest) && fastest > 0.0 ? 1.0 / fastest : 1.0;
}

NamedShape scalar_shape(const std::string& name) { return {name, 1, 1, NamedShape::Form::kScalar}; }

NamedShape list_shape(const std::string& name, Eigen::Index size) {
  return {name, 1, size, NamedShape::Form::kList};
}

NamedShape matrix_shape(const std::string& name, Eigen::Index rows, Eigen::Index cols) {
  return {name, rows, cols, NamedShape::Form::kMatrix};
}

NamedShape symmetric_shape(const std::string& name, Eigen::Index n) {
  return {name, n, n, NamedShape::Form::kSymmetric};
}

GuaranteedFigure Theorem::gain_figure(const NamedMatrices& values) const {
  return {"L2 gain from the disturbance to the performance output", scalar_value(values, "gamma")};
}

GuaranteedFigure Theorem::decay_figure(const NamedMatrices& values) const {
  return {"guaranteed rate of convergence [1/s]", scalar_value(values, decay_parameter())};
}

void require_subject(const Theorem& theorem, const CertificateSubject& subject) {
  require_times(theorem.times(), subject);
  if (!theorem.takes_several_sensors()) require_one_sensor(subject);
  if (!theorem.takes_flow_vertices() && !subject.plant.flow_vertices.empty()) {
    throw std::invalid_argument(
        "it is about flows with one linear part A, not about plant/jacobian_vertices");
  }
  if (subject.falls_at_events &&
      (times_of_timers(subject).size() != 1 || !(times_of_timers(subject).front().T1 > 0.0))) {
    throw std::invalid_argument("a function that falls at events (mu) is one of one timer, T1 > 0");
  }
  theorem.require_applicable(subject);
}

const std::vector<const Theorem*>& theorems() {
  static const std::vector<const Theorem*> all = {
      &bernard2022_corollary4_1(),
      &bernard2022_corollary4_1_average_dwell_time(),
      &bernard2022_corollary5_2(),
      &bernard2022_corollary5_2_metric(),
      &bernard2022_equation14(),
      &bernard2022_equation14_average_dwell_time(),
      &bernard2022_equation22(),
      &bernard2022_equation22_average_dwell_time(),
      &bernard2022_equation26(),
      &bernard2022_equation26_reverse_average_dwell_time(),
      &bernard2022_example4_2(),
      &bernard2022_example4_2_average_dwell_time(),
      &bernard2022_example7_1(),
      &bernard2022_example7_1_average_dwell_time(),
      &bernard2022_equation49_reverse_average_dwell_time(),
      &bernard2022_section7_3_1(),
      &bernard2022_section7_3_2(),
      &bernard2022_section7_3_2_metric(),
      &etienne2019_proposition1(),
      &etienne2019_proposition2(),
      &etienne2019_proposition2_channels(),
      &etienne2019_theorem1(),
      &ferrante2016_theorem1(),
      &ferrante2019_theorem2(),
      &ferrante2019_corollary1(),
      &ferrante2019_corollary2(),
      &sferlazza2019_theorem2(),
      &sferlazza2019_theorem2_rate(),
      &sferlazza2019_equation17(),
      &sferlazza2019_theorem2_norm(),
      &timer_dependent_constant_gain(),
      &timer_dependent_intersample_injection(),
      &timer_dependent_sample_and_hold(),
      &timer_dependent_scheduled_gain(),
      &timer_dependent_sum_constant_gain(),
      &timer_dependent_sum_intersample_injection(),
      &timer_dependent_sum_sample_and_hold(),
      &timer_dependent_switched(),
      &timer_dependent_synchronized(),
  };
  return all;
}

const Theorem* find_theorem(const std::string& name) {
  const auto& all = theorems();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Theorem* theorem) { return theorem->name() == name; });
  return found == all.end() ? nullptr : *found;
}

std::vector<std::string> gains_beside(const Theorem& theorem, const CertificateSubject& subject,
                                      const LawGains& law) {
  const std::vector<NamedShape> known = theorem.gains(subject);
  std::vector<std::string> names;
  for (const LawGain& gain : law.all) {
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const NamedShape& shape) {
      return is_named(gain.name, shape.name);
    });
    const bool is_zero = gain.value.size() > 0 && gain.value.isZero(0.0);
    if (!is_known && !is_zero) names.push_back(gain.name);
  }
  return names;
}

std::vector<ConditionCheck> check(const Certificate& certificate) {
  return check(certificate.theorem->conditions(certificate.subject), certificate.values);
}

std::string statement(const Certificate& certificate) {
  const Theorem& theorem = *certificate.theorem;
  const CertificateSubject& subject = certificate.subject;
  std::string guarantee = theorem.guarantee();
  // Where an exponential rate is 0, the theorem proves that there is one without saying which.
  const std::string at_rate =
      ", at the rate " + theorem.decay_parameter() + " from sample to sample";
  const std::size_t rate = guarantee.find("exponentially" + at_rate);
  if (rate != std::string::npos && certificate.values.at(theorem.decay_parameter())(0, 0) == 0.0) {
    guarantee.erase(guarantee.find(at_rate, rate), at_rate.size());
  }
  std::string text = theorem.name() + ": " + guarantee;
  const char* separator = " (";
  const auto add = [&](const std::string& name, double value, const char* unit) {
    if (!std::regex_search(guarantee, std::regex("\\b" + name + "\\b"))) return;
    char number[32];
    std::snprintf(number, sizeof number, "%.4g", value);
    text += separator + name + " = " + number + unit;
    separator = ", ";
  };
  for (const auto& shapes : {theorem.multipliers(subject), theorem.parameters(subject)}) {
    for (const NamedShape& shape : shapes) {
      if (shape.form != NamedShape::Form::kScalar) continue;
      add(shape.name, certificate.values.at(shape.name)(0, 0), "");
    }
  }
  if (subject.sensor_times.empty()) {
    add("T1", subject.T1, " s");
    add("T2", subject.T2, " s");
  }
  for (std::size_t i = 0; i < subject.sensor_times.size(); ++i) {
    const SamplingTimes& times = subject.sensor_times[i];
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, ": T1 = %.4g s, T2 = %.4g s", times.T1, times.T2);
    text += separator + subject.plant.sampled[i].sensor + numbers;
    separator = ", ";
  }
  if (subject.dwell_time) {
    add("tau", subject.dwell_time->tau, " s");
    add("N0", subject.dwell_time->N0, "");
  }
  if (*separator == ',') text += ")";
  return text;
}

}  // namespace sampled_data_observers

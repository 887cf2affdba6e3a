#include "design/gain_file.h"

#include <cmath>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "certificate/proof_fingerprint.h"
#include "design/written_values.h"
#include "design/yaml_text.h"
#include "files/csv.h"

namespace sampled_data_observers {
namespace {

std::string decimal_or_inf(double value) {
  return std::isinf(value) ? ".inf" : shortest_decimal(value);
}

std::string interval_of(const SamplingTimes& times) {
  return "{T1: " + shortest_decimal(times.T1) + ", T2: " + decimal_or_inf(times.T2) + "}";
}

/// "{gps: {T1: …, T2: …}, …}"
std::string intervals_of_sensors(const CertificateSubject& subject) {
  std::string text = "{";
  for (std::size_t i = 0; i < subject.sensor_times.size(); ++i) {
    text += (i == 0 ? "" : ", ") + yaml_scalar(subject.plant.sampled[i].sensor) + ": " +
            interval_of(subject.sensor_times[i]);
  }
  return text + "}";
}

/// The grid of a Lyapunov function that depends on timers.
std::string timer_nodes_of(const CertificateSubject& subject) {
  if (subject.timer_nodes.empty()) return "";
  std::string text = "  timer_nodes:  # s\n";
  for (std::size_t i = 0; i < subject.timer_nodes.size(); ++i) {
    const auto& sampled = subject.plant.sampled;
    text +=
        "    " + (sampled.empty() ? std::string("jumps") : yaml_scalar(sampled[i].sensor)) + ": [";
    const char* separator = "";
    for (const double node : subject.timer_nodes[i]) {
      text += separator + shortest_decimal(node);
      separator = ", ";
    }
    text += "]\n";
  }
  return text;
}

std::string times_of_claim(const CertificateSubject& subject) {
  if (!subject.sensor_times.empty()) {
    return "  sensors: " + intervals_of_sensors(subject) + "\n";
  }
  if (!subject.dwell_time) {
    return "  T1: " + shortest_decimal(subject.T1) + "\n  T2: " + decimal_or_inf(subject.T2) + "\n";
  }
  const DwellTime& dwell_time = *subject.dwell_time;
  return std::string("  ") +
         (dwell_time.kind == DwellTime::Kind::kAverage ? kAverageDwellTime
                                                       : kReverseAverageDwellTime) +
         ": {tau: " + shortest_decimal(dwell_time.tau) +
         ", N0: " + shortest_decimal(dwell_time.N0) + "}\n";
}

/// Nothing where single times are not bounded.
std::string sampling_of(const CertificateSubject& subject) {
  if (subject.dwell_time) return "";
  if (!subject.sensor_times.empty()) {
    return "sampling: " + intervals_of_sensors(subject) + "  # s\n\n";
  }
  return "sampling: {T1: " + shortest_decimal(subject.T1) + ", T2: " + decimal_or_inf(subject.T2) +
         "}  # s\n\n";
}

void write_claim(const Design& design, const GainFileOrigin& origin, std::ostream& out) {
  const Certificate& certificate = design.certificate;
  const CertificateSubject& subject = certificate.subject;
  const Theorem& theorem = *certificate.theorem;
  out << "  theorem: " << theorem.name() << '\n'
      << "  guarantee: \"" << theorem.guarantee() << "\"\n"
      << "  plant: {file: " << yaml_scalar(origin.plant_file) << ", hash: " << origin.plant_hash
      << "}\n"
      << times_of_claim(subject) << timer_nodes_of(subject);
  if (subject.plant.N.cols() > 0) out << "  N: " << nested_lists(subject.plant.N) << '\n';
  if (design.disturbance) {
    out << "  disturbance: " << shortest_decimal(*design.disturbance)
        << "  # |w|, unless error_assumptions/disturbance says otherwise\n";
  }
  if (subject.plant.C_p.rows() > 0) out << "  C_p: " << nested_lists(subject.plant.C_p) << '\n';
  const StatedErrorMaps& stated = subject.plant.stated;
  if (stated.A) out << "  A: " << nested_lists(*stated.A) << '\n';
  if (stated.A_d) out << "  A_d: " << nested_lists(*stated.A_d) << '\n';
  write_named_values(theorem.parameters(subject), certificate.values, out);
  write_named_values(theorem.multipliers(subject), certificate.values, out);
  out << "  margin: " << shortest_decimal(design.margin)
      << "  # least eigenvalue of the conditions, scaled, beyond its rounding\n"
      << proof_record(certificate, design.proved_conditions) << "  method: " << design.method
      << '\n'
      << "  objective: " << to_string(design.objective)
      << (design.search_ended ? "  # the search ended here: no largest or least value was found"
                              : "")
      << '\n'
      << "  parameters: {";
  const char* separator = "";
  for (const auto& [name, value] : design.parameters) {
    out << separator << name << ": " << shortest_decimal(value);
    separator = ", ";
  }
  // In quotes, since ROS' loader of parameters takes no dates.
  out << "}\n  solver: " << design.solver << "\n  date: " << yaml_scalar(origin.date) << '\n';
}

}  // namespace

std::string proof_record(const Certificate& certificate, std::size_t conditions) {
  return "  proof: ball arithmetic, " + std::to_string(conditions) +
         " conditions\n  proof_hash: " + proof_fingerprint(certificate) + "\n";
}

std::string with_proof_record(const std::string& text, const std::string& section,
                              const std::string& record) {
  std::istringstream lines(text);
  std::ostringstream out;
  bool is_inside = false;
  bool is_recorded = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_of_section = line.empty() || line.front() == ' ' || line.front() == '#';
    if (is_inside && !is_of_section) is_inside = false;
    const std::string key = line.substr(0, line.find(':'));
    if (is_inside && (key == "  proof" || key == "  proof_hash")) continue;
    out << line << '\n';
    const std::size_t value = line.find_first_not_of(' ', key.size() + 1);
    const bool has_value = value != std::string::npos && line[value] != '#';
    if (key != section || key.size() == line.size() || has_value) continue;
    is_inside = true;
    is_recorded = true;
    out << record;
  }
  if (!is_recorded) {
    throw std::invalid_argument("expected a line '" + section +
                                ":' with the keys of the section below it, indented by two "
                                "spaces, found none; add these lines to that section by hand:\n" +
                                record);
  }
  return out.str();
}

std::string abridged_gain_file(const std::string& text) {
  constexpr std::size_t kMostLines = 6;
  constexpr std::size_t kKept = 2;
  constexpr std::size_t kMostBytes = 240;
  std::string out;
  std::vector<std::string> below;
  const auto end_block = [&] {
    const std::size_t kept = below.size() > kMostLines ? kKept : below.size();
    for (std::size_t i = 0; i < kept; ++i) out += below[i];
    if (kept < below.size()) {
      out += "    # and " + std::to_string(below.size() - kept) + " lines more\n";
    }
    below.clear();
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_below = line.compare(0, 4, "    ") == 0;
    // Cut where a value ends: never inside a character of several bytes.
    const std::size_t end = line.size() > kMostBytes ? line.rfind(',', kMostBytes) : line.npos;
    if (end != line.npos) line = line.substr(0, end) + ", ...";
    line += '\n';
    if (!is_below) end_block();
    (is_below ? below.emplace_back() : out) += line;
  }
  end_block();
  return out;
}

void write_gain_file(const Design& design, const GainFileOrigin& origin, std::ostream& out) {
  const Certificate& certificate = design.certificate;
  const CertificateSubject& subject = certificate.subject;
  const Theorem& theorem = *certificate.theorem;
  out << "# Gains with a certificate, made by\n#   " << yaml_comment(origin.command) << "\n"
      << "observer: " << design.observer_type << "\n\n"
      << sampling_of(subject) << "gains:\n";
  for (const auto& [key, choice] : theorem.gain_choices()) {
    out << "  " << key << ": " << choice << '\n';
  }
  write_named_values(theorem.gains(subject), certificate.values, out);
  out << '\n' << kCertificate << ":\n";
  write_claim(design, origin, out);
  if (!design.for_run_time) return;
  out << "\n# The proof of these gains that bounds their error at run time best.\n"
      << kRunTimeCertificate << ":\n";
  write_claim(*design.for_run_time, origin, out);
}

}  // namespace sampled_data_observers

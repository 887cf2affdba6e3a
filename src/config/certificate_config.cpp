#include "config/certificate_config.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "certificate/proof_fingerprint.h"
#include "certificate/timer_grid.h"
#include "config/claimed_gains.h"
#include "config/event_times.h"
#include "config/named_values.h"

namespace sampled_data_observers {
namespace {

/// What the file says for readers only.
const char* const kRemarks[] = {"guarantee",  "method", "objective", "solver",
                                "parameters", "margin", "proof",     "date"};

const Theorem& read_theorem(ConfigSection& section) {
  std::vector<std::string> names;
  for (const Theorem* theorem : theorems()) names.push_back(theorem->name());
  return *find_theorem(section.choice("theorem", names));
}

void require_theorem_for_type(ConfigSection& root, const ConfigSection& section,
                              const Theorem& theorem) {
  const std::string type = root.text("observer");
  const std::vector<std::string> types = theorem.observer_types();
  if (std::count(types.begin(), types.end(), type) > 0) return;
  throw section.error("theorem", "a theorem about a " + type + ", the type of this observer",
                      theorem.name() + ", which is about " + types.front());
}

CertificateSubject read_subject(ConfigSection& section, const Plant& plant,
                                const Theorem& theorem) {
  CertificateSubject subject;
  const StatedErrorMaps stated = read_stated_error_maps(section, plant.states());
  try {
    subject.plant = matrices_of(plant, stated);
  } catch (const std::invalid_argument& fault) {
    throw section.error("theorem", "a plant that the theorem is about", fault.what());
  }
  const Eigen::Index n = subject.plant.states();
  if (section.has("N")) subject.plant.N = section.matrix("N", n, -1);
  if (section.has("C_p")) subject.plant.C_p = section.matrix("C_p", -1, n);
  read_event_times(section, subject);
  read_timer_nodes(section, theorem, subject);
  subject.falls_at_events = theorem.takes_fall_at_events() && section.has("mu");
  return subject;
}

/// Gains that depend on timers are proved on the grid on which the law interpolates them.
void require_same_nodes(ConfigSection& section, const Certificate& certificate) {
  const CertificateSubject& subject = certificate.subject;
  for (std::size_t i = 0; i < subject.plant.sampled.size(); ++i) {
    const std::string& sensor = subject.plant.sampled[i].sensor;
    const auto timers = certificate.values.find("timers/" + sensor);
    if (timers == certificate.values.end()) continue;
    const TensorGrid grid = grid_of(subject);
    const std::vector<double>& nodes = grid.nodes(i);
    if (std::equal(nodes.begin(), nodes.end(), timers->second.data())) continue;
    throw section.error("timer_nodes", "for sensor '" + sensor + "' those of gains/timers",
                        "others");
  }
}

}  // namespace

std::optional<CertificateConfig> read_certificate(ConfigSection& root, const Plant& plant,
                                                  const LawGains& law, const std::string& key) {
  if (!root.has(key)) return std::nullopt;
  ConfigSection section = root.section(key);
  CertificateConfig config;
  config.section = key;
  config.origin = section.origin();
  Certificate& certificate = config.certificate;
  certificate.theorem = &read_theorem(section);
  require_theorem_for_type(root, section, *certificate.theorem);
  certificate.subject = read_subject(section, plant, *certificate.theorem);
  try {
    require_subject(*certificate.theorem, certificate.subject);
  } catch (const std::invalid_argument& fault) {
    throw section.error("theorem", "a plant that the theorem is about", fault.what());
  }
  ConfigSection of_plant = section.section("plant");
  config.plant_file = of_plant.text("file");
  config.plant_hash = of_plant.text("hash");
  of_plant.finish();
  if (section.has("disturbance")) {
    config.disturbance = section.number_in("disturbance", 0.0, 1e50, std::nullopt);
  }

  const Theorem& theorem = *certificate.theorem;
  certificate.values = read_named_values(section, theorem.parameters(certificate.subject));
  certificate.values.merge(read_named_values(section, theorem.multipliers(certificate.subject)));
  certificate.values.merge(
      gains_of_theorem(root.section("gains"), theorem, certificate.subject, law));
  require_same_nodes(section, certificate);
  if (section.has("proof_hash")) {
    config.is_proved = section.text("proof_hash") == proof_fingerprint(certificate);
    config.is_altered = !config.is_proved;
  }
  for (const char* remark : kRemarks) section.has(remark);
  section.finish();
  return config;
}

}  // namespace sampled_data_observers

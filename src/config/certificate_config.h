#pragma once

#include <optional>
#include <string>

#include "certificate/certificate.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// The section `certificate` or `run_time_certificate` of a gain file.
struct CertificateConfig {
  std::string section;
  Certificate certificate;
  /// The plant that the claim is about: its file, relative to the gain file, and its fingerprint.
  std::string plant_file;
  std::string plant_hash;
  /// |w| that the gains were designed for, where the file says so.
  std::optional<double> disturbance;
  std::string origin;
  /// Whether the file records a proof in ball arithmetic of just these numbers.
  bool is_proved = false;
  /// Whether the file says that they were proved, but of other numbers.
  bool is_altered = false;
};

/// Reads the claim that a section of `root` makes of its gains; nothing where it has no such
/// section. Does not check it.
/// @param law  the gains of the law that `root` describes
/// @throws ConfigError for a section that is no certificate for this plant and type of observer.
std::optional<CertificateConfig> read_certificate(ConfigSection& root, const Plant& plant,
                                                  const LawGains& law,
                                                  const std::string& section = kCertificate);

}  // namespace sampled_data_observers

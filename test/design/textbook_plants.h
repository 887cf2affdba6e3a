#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sampled_data_observers/certificate/certificate.h"

namespace sampled_data_observers::test {

/// A plant of a textbook in SI units (but where its field uses others), its sensor and the times
/// between its samples, and how noisy that sensor is.
struct TextbookPlant {
  std::string name;
  CertificateSubject subject;
  double noise = 0.0;
  /// Whether its outputs move so little between samples, with the input of the test, that holding
  /// the last one is better than what is best against the worst disturbance.
  bool moves_little = false;
};

const std::vector<TextbookPlant>& textbook_plants();

}  // namespace sampled_data_observers::test

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
  /// Where the outputs of the designed observer are further off than the last sample held, in the
  /// runs of the test: known, and not yet understood.
  bool is_held_better = false;
};

const std::vector<TextbookPlant>& textbook_plants();

}  // namespace sampled_data_observers::test

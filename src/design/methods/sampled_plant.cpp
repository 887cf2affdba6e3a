#include "sampled_plant.h"

#include <cmath>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "sampled_data_observers/design/observability.h"

namespace sampled_data_observers {

void require_detectable(const CertificateSubject& subject) {
  for (const Mode& mode : unseen_modes(subject.plant.A(), subject.plant.C())) {
    if (mode.decays(TimeDomain::kContinuous)) continue;
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text
        << "the pair (A, C) is not detectable: the output does not show the mode of the eigenvalue "
        << mode.eigenvalue.real();
    if (mode.eigenvalue.imag() != 0.0) text << " +- " << mode.eigenvalue.imag() << " i";
    text << " 1/s, which does not decay by itself. Measure another output, or leave its states out";
    throw std::invalid_argument(text.str());
  }
}

std::string undetectable_sampling(const CertificateSubject& subject) {
  for (const PathologicalInterval& interval :
       pathological_intervals(subject.plant.A(), subject.plant.C(), subject.T2)) {
    if (interval.tau < subject.T1 || interval.decays) continue;
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "samples " << interval.tau
         << " s apart do not show a mode that does not decay by itself: [T1, T2] must leave out "
            "this time";
    return text.str();
  }
  return "";
}

}  // namespace sampled_data_observers

#include "sampled_plant.h"

#include <locale>
#include <sstream>
#include <stdexcept>

#include "sampled_data_observers/design/detectability.h"

namespace sampled_data_observers {

void require_detectable(const CertificateSubject& subject) {
  const auto hidden = undetectable_eigenvalue(subject.plant.A(), subject.plant.C());
  if (!hidden) return;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "the pair (A, C) is not detectable: the output does not show the mode of the eigenvalue "
       << hidden->real();
  if (hidden->imag() != 0.0) text << " +- " << std::abs(hidden->imag()) << " i";
  text << " 1/s, which does not decay by itself. Measure another output, or leave its states out";
  throw std::invalid_argument(text.str());
}

std::string undetectable_sampling(const CertificateSubject& subject) {
  const auto tau = undetectable_time(subject.plant.A(), subject.plant.C(), subject.T1, subject.T2);
  if (!tau) return "";
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "samples " << *tau
       << " s apart do not show a mode that does not decay by itself: [T1, T2] must leave out this "
          "time";
  return text.str();
}

}  // namespace sampled_data_observers

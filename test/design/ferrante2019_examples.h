#pragma once

#include "certificate/certificate.h"

namespace sampled_data_observers::test {

/// Example 1 of ferrante2019: an oscillator.
CertificateSubject oscillator(double T2);
/// Example 2: a unicycle beside a line.
CertificateSubject unicycle(double T2);
/// Example 3: a flexible link, with the performance output z3, or z3 and z4.
CertificateSubject flexible_link(double T2, int performance_outputs = 1);

}  // namespace sampled_data_observers::test

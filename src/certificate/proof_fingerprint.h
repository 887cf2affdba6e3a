#pragma once

#include <string>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// A UUID of all that the proof of a certificate rests on, each number to its last bit: the
/// theorem, T1 and T2, the matrices of the plant, gains, multipliers and parameters. A gain file
/// that holds it says that a proof of just these numbers was found. It is no signature: who edits a
/// file can compute it as well.
std::string proof_fingerprint(const Certificate& certificate);

}  // namespace sampled_data_observers

#pragma once

#include <Eigen/Core>
#include <vector>

#include "certificate/modal_bound.h"
#include "certificate/sublevel_set.h"

namespace sampled_data_observers {

/// Norms of what moves an error in each mode of a plant, |·|_q = |·| in the norm of P_q, all
/// rounded to the safe side.
class ModalNorms {
 public:
  /// @throws std::invalid_argument where rounding hides that a P is positive
  ModalNorms(const CertificateSubject& subject, const std::vector<ModalProof>& modes,
             const ErrorAssumptions& assumptions);

  struct OfMode {
    double per_error = 0.0;       ///< |e|_q of |e| = 1
    double least = 0.0;           ///< the least of them
    SublevelSet set;              ///< of |e|_q²
    double growth = 0.0;          ///< 1/s: of |e|_q by the plant's flow
    double push = 0.0;            ///< |N w|_q at most, per second
    double injection = 0.0;       ///< of what is held, per |h|: |L_c|_q, and what f takes of it
    double free_injection = 0.0;  ///< 1/s: of |e|_q, by f where it takes x̂ in place of an output
    double output = 0.0;          ///< ‖C_c‖
    double noise = 0.0;           ///< |L_d η|_q' at most, the largest of all q'
    std::vector<double> reset;    ///< ‖A_d − L_d C_d‖ from |·|_q to |·|_q', for each q'
    std::vector<double> uncorrected;  ///< ‖A_d‖, likewise
  };
  const OfMode& at(double mode) const { return modes_[static_cast<std::size_t>(mode)]; }

 private:
  std::vector<OfMode> modes_;
};

}  // namespace sampled_data_observers

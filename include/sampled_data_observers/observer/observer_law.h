#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sampled_data_observers/hybrid/hybrid_system.h"

namespace sampled_data_observers {

/// An observer as a hybrid system: a flow map between events and reset maps for samples, plant
/// jumps and inputs, over one state vector whose first entries are the estimate.
///
/// A law is built once from a valid configuration and is const ever after; see HybridSystem for
/// what its maps may and may not do. A new observer type derives from this class.
class ObserverLaw : public HybridSystem {
 public:
  /// Names of the estimated states, in the order of the state vector.
  virtual const std::vector<std::string>& estimate_names() const = 0;

  /// Number of estimated states: the first entries of the state vector.
  Eigen::Index estimate_size() const { return static_cast<Eigen::Index>(estimate_names().size()); }

  void reset(const Event& event, double* state, double* workspace) const final;

  /// Takes over the input that holds in state `from`, for a restart.
  virtual void keep_input(const double* from, double* state) const = 0;

 protected:
  /// Reset map of a sample of sensor number `sensor`, y its outputs.
  virtual void sample(std::size_t sensor, const double* y, double* state,
                      double* workspace) const = 0;

  /// Reset map of a plant jump.
  virtual void jump(double* state, double* workspace) const = 0;

  /// Takes in the input that holds from now on.
  virtual void input(const double* u, double* state) const = 0;
};

}  // namespace sampled_data_observers

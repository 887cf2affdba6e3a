#pragma once

#include <Eigen/Core>
#include <vector>

#include "observer/transformed_high_gain_observer.h"

namespace sampled_data_observers {

/// The coordinates z = T(x) in one mode of a TransformedHighGainObserver (bernard2022, examples 4.3
/// and 7.3), with the input at zero. It keeps scratch memory: one object serves one thread.
class ModeCoordinates {
 public:
  /// `law` must outlive it.
  ModeCoordinates(const TransformedHighGainObserver& law, std::size_t mode);

  Eigen::Index n() const { return law_.plant().states(); }
  Eigen::Index d() const { return law_.settings().K[mode_].front().size(); }
  /// k_1 … k_d
  const Eigen::VectorXd& K() const { return law_.settings().K[mode_].front(); }

  Eigen::VectorXd T(const Eigen::VectorXd& x) const;
  /// sat(Θ(z))
  Eigen::VectorXd state_of(const Eigen::VectorXd& z) const;
  /// Φ(T(x), x)
  double phi(const Eigen::VectorXd& x) const;
  /// Φ as the observer takes it: at sat(Θ(z)).
  double phi_of(const Eigen::VectorXd& z) const { return phi(state_of(z)); }
  /// Its gradient in z, by central differences.
  /// @param scales  d entries > 0: sizes of usual changes of z
  Eigen::VectorXd gradient(const Eigen::VectorXd& z, const Eigen::VectorXd& scales) const;

  /// The Jacobian in z of what a jump makes of it, T(sat(g(sat(Θ(z))))), likewise: d x d.
  /// @pre the plant jumps and does not switch
  Eigen::MatrixXd jump_gradient(const Eigen::VectorXd& z, const Eigen::VectorXd& scales) const;

  /// (h, T_1, …, T_d, Φ) as the formulas give them, less what they are: h, and the derivative along
  /// the flow of the one before. d + 1 entries, the first T_1 − h.
  Eigen::VectorXd derivative_errors(const Eigen::VectorXd& x) const;

 private:
  Eigen::VectorXd jumped(const Eigen::VectorXd& z) const;

  const TransformedHighGainObserver& law_;
  std::size_t mode_;
  const TransformedHighGainObserver::Maps& maps_;
  Eigen::VectorXd u_;
};

/// So many points of the box of a law's saturations: its corners, as far as there is room for all
/// of them in a tenth, and else those of Halton's sequence.
/// @throws std::invalid_argument for states without bounds, and more states than there are primes
/// in its table.
std::vector<Eigen::VectorXd> points_of_box(const HighGainObserver& law, std::size_t count);

}  // namespace sampled_data_observers

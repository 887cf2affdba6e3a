#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "replay/comparison.h"

namespace sampled_data_observers {

/// Errors apart from those around jumps, where the error peaks however good the estimate is: from
/// when one of plant and estimate has jumped until both have (bernard2022, section 6).
struct ErrorsApart {
  /// How far around jumps [s].
  double around = 0.0;
  std::size_t jumps = 0;
  /// Of the stamps compared, those that are not around a jump, with the root mean square of each
  /// quantity's error and of their norm, and the largest norm; nothing where there are none.
  std::size_t stamps = 0;
  std::vector<std::optional<double>> rmse;
  std::optional<double> rmse_norm;
  std::optional<double> largest;
  /// The largest norm of the error around jumps; nothing where no stamp is there.
  std::optional<double> peak;
  /// The same of an error without the peaks, min(|x − x̂|, |g(x) − x̂|, |x − g(x̂)|) with the
  /// plant's jump map g: the distance of (x, x̂) to where estimates converge to, one of the two a
  /// jump ahead or none. Nothing where the plant has modes, or not every state is compared.
  std::optional<double> peak_free;
};

/// Collects errors and jumps, and tells them apart when all are known.
class JumpNeighbourhood {
 public:
  /// @param around  [ns], >= 0
  JumpNeighbourhood(std::vector<Quantity> quantities, std::shared_ptr<const Plant> plant,
                    Duration around);

  /// A jump that was told with one stamp and took effect at `release`, the same or a later one.
  void add_jump(Stamp stamp, Stamp release);

  /// One that was told with this stamp was taken back.
  void remove_jump(Stamp stamp);

  /// The truth, one value per quantity, and the estimate x (n entries) with the input u held.
  void add_truth(Stamp stamp, const std::vector<double>& truth, const double* x, const double* u);

  ErrorsApart errors() const;

 private:
  struct Interval {
    Stamp begin = 0;
    Stamp end = 0;
  };
  struct Compared {
    Stamp stamp = 0;
    double norm = 0.0;
    std::optional<double> without_peak;
  };

  std::vector<Interval> intervals() const;
  double distance(const std::vector<double>& truth, const Eigen::VectorXd& x) const;

  std::vector<Quantity> quantities_;
  std::shared_ptr<const Plant> plant_;
  Duration around_;
  /// Where each state stands among the quantities; empty where peaks can't be told.
  std::vector<std::size_t> places_;
  std::vector<Interval> jumps_;
  std::vector<Compared> compared_;
  std::vector<double> squares_;  ///< of each stamp compared, one per quantity
};

}  // namespace sampled_data_observers

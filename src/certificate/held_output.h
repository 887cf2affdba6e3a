#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "certificate/bound_flow.h"
#include "certificate/error_bound.h"
#include "certificate/outward.h"

namespace sampled_data_observers {

/// What a bound knows of h = y_held − C_c x, by how much the continuous output that a law holds is
/// off, in kEntries numbers of its state: nothing, or |h| <= offset + output_rate s, s the time
/// since it was `offset` at most.
class HeldOutput {
 public:
  static constexpr Eigen::Index kEntries = 3;

  HeldOutput(const ErrorAssumptions& assumptions, double output_norm)
      : noise_(assumptions.noise),
        rate_(assumptions.output_rate.value_or(0.0)),
        output_norm_(output_norm) {}

  static void forget(double* numbers) { numbers[kIsKnown] = 0.0; }
  static bool is_known(const double* numbers) { return numbers[kIsKnown] != 0.0; }

  /// At a message.
  void take_message(double* numbers) const { set(noise_, numbers); }

  /// Told what the law holds. Of what it held before, nothing is known but the innovation ν =
  /// y_held − C_c x̂, and h = ν − C_c (x − x̂).
  /// @param innovation  |ν|; nothing where nothing is held
  /// @param error       |x − x̂| at most
  void look_at(std::optional<double> innovation, double error, double* numbers) const {
    if (!innovation) {
      forget(numbers);
    } else if (!is_known(numbers)) {
      set(raised(*innovation) + output_norm_ * error, numbers);
    }
  }

  /// w(duration) of ẇ = growth w + push + gain |h|, w(0) = start. @pre is_known()
  double flowed(double start, double growth, double push, double gain, double duration,
                const double* numbers) const {
    const double now = numbers[kOffset] + rate_ * numbers[kSince];
    return flowed_linearly(start, growth, push + gain * now, duration) +
           gain * rate_ * integral_of_ramp(growth, duration);
  }

  static void advance(double duration, double* numbers) { numbers[kSince] += duration; }

 private:
  enum Entry { kIsKnown, kSince, kOffset };

  static void set(double offset, double* numbers) {
    numbers[kIsKnown] = 1.0;
    numbers[kSince] = 0.0;
    numbers[kOffset] = offset;
  }

  double noise_;
  double rate_;
  double output_norm_;
};

/// @throws std::invalid_argument where a bound rests on outputs that are held, and that is missing
inline void require_output_rate(const ErrorAssumptions& assumptions) {
  if (assumptions.output_rate) return;
  throw std::invalid_argument(
      "no output_rate, how fast the continuous output changes at most [its unit/s]: it is held "
      "between its messages");
}

/// |d|_P at most of all d with |d_i| <= injection_lipschitz(i); 0 where nothing is injected.
inline double injection_gain(const Eigen::MatrixXd& P, const ErrorAssumptions& assumptions) {
  if (!assumptions.injection_lipschitz) return 0.0;
  const Eigen::VectorXd& each = *assumptions.injection_lipschitz;
  return raised(std::sqrt(each.dot(P.cwiseAbs() * each)));
}

}  // namespace sampled_data_observers

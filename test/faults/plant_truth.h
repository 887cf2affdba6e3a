#pragma once

#include <functional>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers::test {

using State = std::vector<double>;

/// The solution of a plant's flow in closed form: the state that `seconds` (of any sign) lead to,
/// with the input u held.
using Flow = std::function<State(const State&, double u, double seconds)>;

/// p' = v, v' = -omega^2 p + u
Flow oscillator(double omega);

/// A plant at rest.
Flow rest();

/// The true state of the plant at all times, which the campaign makes up and the observer is to
/// find.
class PlantTruth {
 public:
  /// Before, the plant flowed alike.
  void begin(Flow flow, Stamp stamp, State state, double u);

  State at(Stamp stamp) const;

  /// From `stamp` on all is new: what was known of later times is forgotten.
  void change(Stamp stamp, State state);
  void forget_after(Stamp stamp);

 private:
  struct Segment {
    Stamp start = 0;
    State state;
  };

  const Segment& segment_at(Stamp stamp) const;

  Flow flow_;
  double u_ = 0.0;
  std::vector<Segment> segments_;
};

}  // namespace sampled_data_observers::test

#include "faults/plant_truth.h"

#include <cmath>
#include <utility>

namespace sampled_data_observers::test {

Flow oscillator(double omega) {
  return [omega](const State& state, double u, double seconds) {
    const double center = u / (omega * omega);
    const double c = std::cos(omega * seconds);
    const double s = std::sin(omega * seconds);
    const double p = state[0] - center;
    const double v = state[1];
    return State{center + c * p + s / omega * v, -omega * s * p + c * v};
  };
}

Flow rest() {
  return [](const State& state, double, double) { return state; };
}

void PlantTruth::begin(Flow flow, Stamp stamp, State state, double u) {
  flow_ = std::move(flow);
  u_ = u;
  segments_ = {{stamp, std::move(state)}};
}

State PlantTruth::at(Stamp stamp) const {
  const Segment& segment = segment_at(stamp);
  return flow_(segment.state, u_, to_seconds(stamp - segment.start));
}

void PlantTruth::change(Stamp stamp, State state) {
  forget_after(stamp);
  segments_.push_back({stamp, std::move(state)});
}

void PlantTruth::forget_after(Stamp stamp) {
  while (segments_.size() > 1 && segments_.back().start > stamp) segments_.pop_back();
}

const PlantTruth::Segment& PlantTruth::segment_at(Stamp stamp) const {
  std::size_t i = segments_.size() - 1;
  while (i > 0 && segments_[i].start > stamp) --i;
  return segments_[i];
}

}  // namespace sampled_data_observers::test

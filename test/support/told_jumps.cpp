#include "support/told_jumps.h"

#include <algorithm>
#include <iterator>
#include <random>
#include <stdexcept>
#include <utility>

namespace sampled_data_observers::test {
namespace {

bool arrives_sooner(const SimulatedMessage& a, const SimulatedMessage& b) {
  return a.arrival < b.arrival;
}

}  // namespace

ToldJumps::ToldJumps(const Simulator& simulator, std::vector<SimulatedMessage> messages)
    : simulator_(simulator), others_(std::move(messages)) {
  const auto is_other = [&](const SimulatedMessage& message) {
    return simulator_.channels()[message.channel].kind != SimulatedChannel::Kind::kJump;
  };
  const auto jumps = std::stable_partition(others_.begin(), others_.end(), is_other);
  jumps_.assign(std::make_move_iterator(jumps), std::make_move_iterator(others_.end()));
  others_.erase(jumps, others_.end());
  std::stable_sort(jumps_.begin(), jumps_.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  is_dropped_.assign(jumps_.size(), false);
}

void ToldJumps::drop(std::size_t k) { is_dropped_.at(k) = true; }

void ToldJumps::repeat(std::size_t k, double later) {
  move(added_.emplace_back(jumps_.at(k)), from_seconds(later));
}

void ToldJumps::add(double time, int mode) {
  const Scenario& scenario = simulator_.scenario();
  const Plant& plant = *scenario.plant;
  SimulatedMessage jump = jumps_.at(0);
  jump.stamp = jump.arrival = scenario.start + from_seconds(time);
  jump.mode = mode;
  jump.values.clear();
  const std::vector<double>& x = truth_at(jump.stamp);
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    if (plant.sensors()[i].timing != SensorTiming::kAtJumps) continue;
    const VectorMap& output = *plant.modes().front().outputs[i];
    Eigen::VectorXd y(output.size());
    output.evaluate(x.data(), nullptr, y.data());
    jump.values.insert(jump.values.end(), y.data(), y.data() + y.size());
  }
  added_.push_back(std::move(jump));
}

void ToldJumps::jitter(std::size_t first, std::size_t last, double most, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> error(-most, most);
  for (std::size_t k = first; k <= last; ++k) move(jumps_.at(k), from_seconds(error(generator)));
}

const std::vector<double>& ToldJumps::truth_at(Stamp stamp) const {
  for (const SimulatedMessage& message : others_) {
    if (message.stamp >= stamp &&
        simulator_.channels()[message.channel].kind == SimulatedChannel::Kind::kTruth) {
      return message.values;
    }
  }
  throw std::out_of_range("a jump after the end of the simulation");
}

void ToldJumps::move(SimulatedMessage& jump, Duration by) const {
  jump.stamp = std::max(jump.stamp + by, simulator_.scenario().start);
  jump.arrival = std::max(jump.arrival, jump.stamp);
}

std::vector<SimulatedMessage> ToldJumps::messages() && {
  std::vector<SimulatedMessage> all = std::move(others_);
  for (std::size_t k = 0; k < jumps_.size(); ++k) {
    if (!is_dropped_[k]) all.push_back(std::move(jumps_[k]));
  }
  std::move(added_.begin(), added_.end(), std::back_inserter(all));
  std::stable_sort(all.begin(), all.end(), arrives_sooner);
  return all;
}

}  // namespace sampled_data_observers::test

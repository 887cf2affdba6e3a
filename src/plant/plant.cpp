#include "sampled_data_observers/plant/plant.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace sampled_data_observers {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("Plant: " + what);
}

void check_map(const std::shared_ptr<const VectorMap>& map, Eigen::Index size, Eigen::Index states,
               Eigen::Index inputs, const std::string& name) {
  require(map != nullptr, name + " is missing");
  require(map->size() == size, name + " must have " + std::to_string(size) + " entries");
  const AffineMap* affine = map->affine();
  if (affine == nullptr) return;
  require(affine->M().cols() == states, name + " must have one column per state");
  require(affine->N().cols() == 0 || affine->N().cols() == inputs,
          name + " must have one column per input");
}

/// Each of p inputs is in one channel, and channels are in the order of their first inputs.
bool are_in_order(const std::vector<InputChannel>& channels, Eigen::Index p) {
  std::vector<bool> is_there(static_cast<std::size_t>(p), false);
  Eigen::Index first_before = -1;
  for (const InputChannel& channel : channels) {
    if (channel.inputs.empty() || channel.inputs.front() <= first_before) return false;
    first_before = channel.inputs.front();
    Eigen::Index before = -1;
    for (const Eigen::Index input : channel.inputs) {
      if (input <= before || input >= p || is_there[static_cast<std::size_t>(input)]) return false;
      is_there[static_cast<std::size_t>(input)] = true;
      before = input;
    }
  }
  return std::find(is_there.begin(), is_there.end(), false) == is_there.end();
}

void check_unit_norms(const PlantDescription& plant) {
  std::vector<bool> taken(plant.state_names.size(), false);
  for (const std::vector<Eigen::Index>& group : plant.unit_norms) {
    require(group.size() > 1, "a group of unit norm needs two states");
    for (const Eigen::Index state : group) {
      const auto position = static_cast<std::size_t>(state);
      require(state >= 0 && position < taken.size() && !taken[position],
              "each state of unit norm must be one of the plant's, in one group");
      taken[position] = true;
    }
  }
}

PlantDescription checked(PlantDescription plant) {
  const auto n = static_cast<Eigen::Index>(plant.state_names.size());
  const auto p = static_cast<Eigen::Index>(plant.input_names.size());
  if (plant.input_channels.empty() && p > 0) {
    InputChannel all{"input", std::vector<Eigen::Index>(plant.input_names.size()), 0, {}};
    std::iota(all.inputs.begin(), all.inputs.end(), Eigen::Index{0});
    plant.input_channels.push_back(std::move(all));
  }
  for (const InputChannel& channel : plant.input_channels) {
    require(channel.timeout >= 0, "the timeout of inputs must not be negative");
    require(channel.after_timeout.empty() ||
                (channel.timeout > 0 && channel.after_timeout.size() == channel.inputs.size()),
            "after the timeout of inputs, where there is one, a value each");
  }
  require(are_in_order(plant.input_channels, p),
          "each input in one channel, in ascending order, as the channels' first inputs");
  require(n > 0, "at least one state");
  require(!plant.modes.empty(), "at least one mode");
  require(plant.integration.step > 0, "the integration step must be positive");
  require(plant.integration.horizon >= plant.integration.step,
          "the integration horizon must not be less than the step");
  check_unit_norms(plant);
  for (const Sensor& sensor : plant.sensors) {
    require(sensor.outputs() > 0, "sensor '" + sensor.name + "' must have an output");
  }
  for (const PlantMode& mode : plant.modes) {
    const std::string where =
        plant.modes.size() == 1 ? "" : " of mode " + std::to_string(mode.label);
    const auto same = [&](const PlantMode& other) { return other.label == mode.label; };
    require(std::count_if(plant.modes.begin(), plant.modes.end(), same) == 1,
            "each mode needs a label of its own");
    check_map(mode.flow, n, n, p, "the flow map" + where);
    if (mode.jump) check_map(mode.jump, n, n, p, "the jump map" + where);
    require(mode.outputs.size() == plant.sensors.size(), "one output map per sensor" + where);
    require(plant.unit_norms.empty() || mode.flow->affine() == nullptr,
            "states of unit norm take flows that are not affine" + where);
    for (std::size_t i = 0; i < plant.sensors.size(); ++i) {
      check_map(mode.outputs[i], plant.sensors[i].outputs(), n, p,
                "the output map of sensor '" + plant.sensors[i].name + "'" + where);
    }
  }
  return plant;
}

}  // namespace

Plant::Plant(PlantDescription description) : description_(checked(std::move(description))) {
  for (const PlantMode& mode : modes()) {
    for (std::size_t i = 0; i < sensors().size(); ++i) {
      const std::vector<bool>& angular = sensors()[i].angular;
      const bool has_angle = std::find(angular.begin(), angular.end(), true) != angular.end();
      const AffineMap* affine = mode.outputs[i]->affine();
      const bool is_linear =
          affine != nullptr && affine->c().isZero(0.0) && affine->N().isZero(0.0);
      outputs_.push_back({mode.outputs[i].get(), sensors()[i].outputs(), states(),
                          is_linear ? affine->M().data() : nullptr,
                          has_angle ? &angular : nullptr});
    }
  }
}

void Plant::normalize(double* x) const {
  for (const std::vector<Eigen::Index>& group : unit_norms()) {
    double squares = 0.0;
    for (const Eigen::Index state : group) squares += x[state] * x[state];
    const double norm = std::sqrt(squares);
    if (norm == 0.0) {
      x[group.front()] = 1.0;
    } else if (std::isfinite(norm)) {
      for (const Eigen::Index state : group) x[state] /= norm;
    }
  }
}

bool Plant::jumps() const {
  return switches() || std::any_of(modes().begin(), modes().end(),
                                   [](const PlantMode& mode) { return mode.jump != nullptr; });
}

std::optional<std::size_t> Plant::find_mode(double label) const {
  for (std::size_t i = 0; i < modes().size(); ++i) {
    if (static_cast<double>(modes()[i].label) == label) return i;
  }
  return std::nullopt;
}

bool Plant::is_affine() const {
  const auto affine = [](const std::shared_ptr<const VectorMap>& map) {
    return !map || map->affine() != nullptr;
  };
  return std::all_of(modes().begin(), modes().end(), [&](const PlantMode& mode) {
    return affine(mode.flow) && affine(mode.jump) &&
           std::all_of(mode.outputs.begin(), mode.outputs.end(), affine);
  });
}

Eigen::Index Plant::max_outputs() const {
  Eigen::Index largest = 0;
  for (const Sensor& sensor : sensors()) largest = std::max(largest, sensor.outputs());
  return largest;
}

Eigen::Index Plant::outputs(SensorTiming timing) const {
  Eigen::Index sum = 0;
  for (const Sensor& sensor : sensors()) {
    if (sensor.timing == timing) sum += sensor.outputs();
  }
  return sum;
}

bool Plant::has_angles(SensorTiming timing) const {
  return std::any_of(sensors().begin(), sensors().end(), [&](const Sensor& sensor) {
    return sensor.timing == timing &&
           std::find(sensor.angular.begin(), sensor.angular.end(), true) != sensor.angular.end();
  });
}

Eigen::MatrixXd Plant::stacked_outputs(std::size_t mode, SensorTiming timing) const {
  Eigen::MatrixXd H(outputs(timing), states());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < sensors().size(); ++i) {
    if (sensors()[i].timing != timing) continue;
    H.middleRows(row, sensors()[i].outputs()) = modes()[mode].outputs[i]->affine()->M();
    row += sensors()[i].outputs();
  }
  return H;
}

}  // namespace sampled_data_observers

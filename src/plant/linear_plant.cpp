#include "sampled_data_observers/plant/linear_plant.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/plant/ordered_product.h"

namespace sampled_data_observers {
namespace {

LinearPlantDescription checked(LinearPlantDescription plant) {
  const Eigen::Index n = plant.A.rows();
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument("LinearPlant: " + what);
  };
  require(n > 0 && plant.A.cols() == n, "A must be square and not empty");
  require(static_cast<Eigen::Index>(plant.state_names.size()) == n, "one state name per row of A");
  require(plant.B.rows() == n, "B must have as many rows as A");
  require(static_cast<Eigen::Index>(plant.input_names.size()) == plant.B.cols(),
          "one input name per column of B");
  for (const Sensor& sensor : plant.sensors) {
    require(sensor.C.rows() > 0 && sensor.C.cols() == n,
            "C of sensor '" + sensor.name + "' must have as many columns as A");
    require(static_cast<Eigen::Index>(sensor.angular.size()) == sensor.C.rows(),
            "angular of sensor '" + sensor.name + "' must have one entry per output");
  }
  if (plant.jump_map) {
    require(plant.jump_map->A_d.rows() == n && plant.jump_map->A_d.cols() == n,
            "A_d must have the shape of A");
    require(plant.jump_map->b_d.size() == n, "b_d must have as many entries as A has rows");
  }
  return plant;
}

}  // namespace

LinearPlantDescription with_bias_states(LinearPlantDescription plant,
                                        const std::vector<BiasState>& biases) {
  const Eigen::Index n = plant.A.rows();
  const Eigen::Index extended = n + static_cast<Eigen::Index>(biases.size());
  plant.A.conservativeResizeLike(Eigen::MatrixXd::Zero(extended, extended));
  plant.B.conservativeResizeLike(Eigen::MatrixXd::Zero(extended, plant.B.cols()));
  for (Sensor& sensor : plant.sensors) {
    sensor.C.conservativeResizeLike(Eigen::MatrixXd::Zero(sensor.C.rows(), extended));
  }
  if (plant.jump_map) {
    plant.jump_map->A_d.conservativeResizeLike(Eigen::MatrixXd::Identity(extended, extended));
    plant.jump_map->b_d.conservativeResizeLike(Eigen::VectorXd::Zero(extended));
  }
  for (std::size_t i = 0; i < biases.size(); ++i) {
    plant.state_names.push_back(biases[i].name);
    plant.sensors.at(biases[i].sensor).C(biases[i].output, n + static_cast<Eigen::Index>(i)) = 1.0;
  }
  return plant;
}

LinearPlant::LinearPlant(LinearPlantDescription description)
    : description_(checked(std::move(description))), flow_(description_.A, description_.B) {}

Eigen::Index LinearPlant::max_outputs() const {
  Eigen::Index largest = 0;
  for (const Sensor& sensor : sensors()) largest = std::max(largest, sensor.C.rows());
  return largest;
}

void LinearPlant::jump(double* x, double* scratch) const {
  const AffineJumpMap& map = *description_.jump_map;
  std::copy_n(map.b_d.data(), states(), scratch);
  add_product(map.A_d, x, scratch);
  std::copy_n(scratch, states(), x);
}

}  // namespace sampled_data_observers

#include "plant/linear_plant.h"

#include <utility>

namespace sampled_data_observers {

std::shared_ptr<const Plant> make_linear_plant(const LinearPlantDescription& description) {
  PlantDescription plant;
  plant.state_names = description.state_names;
  plant.input_names = description.input_names;
  PlantMode mode;
  mode.flow = std::make_shared<const AffineMap>(description.A, description.B,
                                                Eigen::VectorXd::Zero(description.A.rows()));
  if (description.jump_map) {
    const AffineJumpMap& jump = *description.jump_map;
    mode.jump = std::make_shared<const AffineMap>(
        jump.A_d, Eigen::MatrixXd::Zero(jump.A_d.rows(), 0), jump.b_d);
  }
  for (const LinearSensor& sensor : description.sensors) {
    plant.sensors.push_back({sensor.name, SensorTiming::kSampled, sensor.angular});
    mode.outputs.push_back(std::make_shared<const AffineMap>(sensor.C));
  }
  plant.modes.push_back(std::move(mode));
  return std::make_shared<const Plant>(std::move(plant));
}

}  // namespace sampled_data_observers

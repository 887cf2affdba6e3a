#include "certificate/plant_matrices.h"

#include <algorithm>
#include <stdexcept>

#include "plant/bounded_slope_map.h"
#include "plant/lipschitz_map.h"
#include "plant/polytopic_map.h"

namespace sampled_data_observers {
namespace {

const AffineMap& affine(const VectorMap& map, const std::string& what) {
  const AffineMap* result = map.affine();
  if (result != nullptr) return *result;
  throw std::invalid_argument("the conditions are about linear maps, but " + what +
                              " is given by formulas or a plug-in (where the observer's error has "
                              "a linear flow or jump map all the same, design/A or design/A_d "
                              "states it)");
}

Eigen::MatrixXd stacked_outputs(const Plant& plant, const PlantMode& mode, SensorTiming timing) {
  Eigen::MatrixXd stacked(plant.outputs(timing), plant.states());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (sensor.timing != timing) continue;
    stacked.middleRows(row, sensor.outputs()) =
        affine(*mode.outputs[i], "the output of sensor '" + sensor.name + "'").M();
    row += sensor.outputs();
  }
  return stacked;
}

Eigen::MatrixXd mean_of(const std::vector<Eigen::MatrixXd>& matrices) {
  Eigen::MatrixXd sum = matrices.front();
  for (std::size_t i = 1; i < matrices.size(); ++i) sum += matrices[i];
  return sum / static_cast<double>(matrices.size());
}

std::vector<SampledOutputs> sampled_outputs(const Plant& plant) {
  std::vector<SampledOutputs> all;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (sensor.timing != SensorTiming::kSampled) continue;
    all.push_back({sensor.name, i, row, sensor.outputs()});
    row += sensor.outputs();
  }
  return all;
}

void require_one_sensor_of_each_timing(const Plant& plant) {
  for (const SensorTiming timing : {SensorTiming::kContinuous, SensorTiming::kAtJumps}) {
    const auto count =
        std::count_if(plant.sensors().begin(), plant.sensors().end(),
                      [timing](const Sensor& sensor) { return sensor.timing == timing; });
    if (count <= 1) continue;
    throw std::invalid_argument(
        "the conditions are about one sensor whose outputs are measured together, but " +
        std::to_string(count) + " sensors are " + to_string(timing));
  }
}

}  // namespace

std::string of_mode(const std::string& symbol, const ModeMatrices& mode) {
  return symbol + "/" + std::to_string(mode.label);
}

Eigen::MatrixXd jump_of(const ModeMatrices& mode) {
  return mode.A_d ? *mode.A_d
                  : Eigen::MatrixXd(Eigen::MatrixXd::Identity(mode.A.rows(), mode.A.rows()));
}

const Eigen::MatrixXd& output_at_switches(const ModeMatrices& mode) {
  return mode.C_d.rows() > 0 ? mode.C_d : mode.C_c;
}

bool PlantMatrices::jumps() const {
  return lipschitz_jump || std::any_of(modes.begin(), modes.end(), [](const ModeMatrices& mode) {
           return mode.A_d.has_value();
         });
}

PlantMatrices matrices_of(const Plant& plant, const StatedErrorMaps& stated) {
  require_one_sensor_of_each_timing(plant);
  if (!plant.unit_norms().empty()) {
    throw std::invalid_argument("no theorem is about a plant with unit_norm");
  }
  if (plant.switches() && !stated.is_empty()) {
    throw std::invalid_argument("A and A_d of a design are those of a plant that does not switch");
  }
  PlantMatrices result;
  result.stated = stated;
  result.state_names = plant.state_names();
  result.sampled = sampled_outputs(plant);
  const Eigen::Index n = plant.states();
  result.G.resize(n, 0);
  result.S.resize(0, n);
  result.N.resize(n, 0);
  result.C_p.resize(0, n);
  for (const PlantMode& mode : plant.modes()) {
    ModeMatrices matrices;
    matrices.label = mode.label;
    if (stated.A) {
      matrices.A = *stated.A;
    } else if (const auto* lipschitz = dynamic_cast<const LipschitzMap*>(mode.flow.get())) {
      if (plant.switches()) {
        throw std::invalid_argument("the conditions are about switched plants with linear flows");
      }
      const LipschitzDescription& description = lipschitz->description();
      matrices.A = description.A;
      result.G = description.G;
      result.S = description.S;
      result.lipschitz_constant = description.lipschitz_constant;
      result.vertices = description.vertices;
    } else if (const auto* polytopic = dynamic_cast<const PolytopicMap*>(mode.flow.get())) {
      if (plant.switches()) {
        throw std::invalid_argument("the conditions are about switched plants with linear flows");
      }
      const PolytopicDescription& description = polytopic->description();
      result.flow_vertices = description.vertices;
      matrices.A = mean_of(description.vertices);
      result.G = description.G;
      result.S = description.S;
      if (result.G.cols() > 0) result.lipschitz_constant = description.lipschitz_constant;
    } else {
      matrices.A = affine(*mode.flow, "the flow").M();
    }
    const auto* bounded = dynamic_cast<const BoundedSlopeMap*>(mode.jump.get());
    const bool is_lipschitz = bounded != nullptr && !plant.switches();
    if (stated.A_d) {
      matrices.A_d = *stated.A_d;
    } else if (mode.jump && (mode.jump->affine() != nullptr || !is_lipschitz)) {
      matrices.A_d = affine(*mode.jump, "the jump map").M();
    }
    if (is_lipschitz) {
      result.lipschitz_jump = LipschitzJump{bounded->constant(), Eigen::MatrixXd::Identity(n, n)};
    }
    matrices.C = stacked_outputs(plant, mode, SensorTiming::kSampled);
    matrices.C_c = stacked_outputs(plant, mode, SensorTiming::kContinuous);
    matrices.C_d = stacked_outputs(plant, mode, SensorTiming::kAtJumps);
    result.modes.push_back(std::move(matrices));
  }
  return result;
}

}  // namespace sampled_data_observers

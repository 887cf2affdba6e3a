#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Checks gains of one matrix per sensor, n x m_i each; sensors of another timing have no gain.
/// @throws std::invalid_argument naming `name` and the sensor whose gain does not fit.
void check_gains(const std::string& name, const std::vector<Eigen::MatrixXd>& gains,
                 const Plant& plant, SensorTiming timing);

}  // namespace sampled_data_observers

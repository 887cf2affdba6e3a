#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/observer/law_gains.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// One matrix of `rows` rows and m_i columns per sensor of a timing; of the others, empty ones.
/// Below `key` stands a map from sensor names to matrices, or, where there is one such sensor only,
/// its matrix.
std::vector<Eigen::MatrixXd> read_gain_per_sensor(ConfigSection& gains, const std::string& key,
                                                  const Plant& plant, SensorTiming timing,
                                                  Eigen::Index rows);

/// The same with one square matrix of m_i rows per sensor of any of the timings.
std::vector<Eigen::MatrixXd> read_square_per_sensor(ConfigSection& gains, const std::string& key,
                                                    const Plant& plant,
                                                    const std::vector<SensorTiming>& timings);

/// R of each sensor that is sampled or measures at jumps, likewise: m_i x m_i; an empty one where
/// it comes with the messages.
std::vector<Eigen::MatrixXd> read_noise_covariances(ConfigSection& gains, const Plant& plant);

/// How, for each of these sensors.
std::vector<std::optional<MessageCovariance>> read_message_covariances(ConfigSection& gains,
                                                                       const Plant& plant);

/// The states that a SynchronizedObserver takes from continuous outputs, below `output_injection`:
/// a map from names of states to names of sensors.
std::vector<OutputInjection> read_output_injections(ConfigSection& gains, const Plant& plant);

}  // namespace sampled_data_observers

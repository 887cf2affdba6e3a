#include "observer/high_gain_settings.h"

#include <cmath>
#include <stdexcept>

#include "observer/gain_requirement.h"
#include "observer/observable_form.h"

namespace sampled_data_observers {

void check_settings(const HighGainSettings& settings, const Plant& plant) {
  require_of_gains(settings.saturation.size() == plant.states(),
                   "saturations: one entry per state of the plant");
  require_of_gains(settings.K.size() == plant.modes().size(), "K: one per mode of the plant");
  if (plant.sensors().empty()) {
    throw std::invalid_argument("a sensor that is measured continuously is needed");
  }
}

OutputChains chains_of(const HighGainSettings& settings, const Plant& plant) {
  OutputChains chains;
  for (const Sensor& sensor : plant.sensors()) {
    chains.angular.insert(chains.angular.end(), sensor.angular.begin(), sensor.angular.end());
  }
  const std::size_t m = chains.angular.size();
  require_of_gains(!settings.K.empty(), "K: one per mode of the plant");
  for (const auto& of_mode : settings.K) {
    require_of_gains(of_mode.size() == m, "K: one list of numbers per continuous output");
    for (std::size_t j = 0; j < m; ++j) {
      require_of_gains(of_mode[j].size() == settings.K.front()[j].size(),
                       "K: as many numbers in each mode");
    }
  }
  Eigen::Index first = 0;
  for (const Eigen::VectorXd& K : settings.K.front()) {
    chains.first.push_back(first);
    first += K.size();
    chains.last.push_back(first - 1);
  }
  require_of_gains(m > 0, "a sensor that is measured continuously is needed");
  return chains;
}

void OutputChains::innovations(const double* y_c, const double* z, double* innovation) const {
  for (std::size_t j = 0; j < size(); ++j) {
    const double difference = y_c[j] - z[first[j]];
    innovation[j] = angular[j] ? wrap_angle(difference) : difference;
  }
}

std::vector<Eigen::MatrixXd> scaled_gains(const HighGainSettings& settings, const Plant& plant) {
  const OutputChains chains = chains_of(settings, plant);
  std::vector<Eigen::MatrixXd> result;
  for (const auto& of_mode : settings.K) {
    Eigen::MatrixXd& gain = result.emplace_back(
        Eigen::MatrixXd::Zero(chains.entries(), static_cast<Eigen::Index>(chains.size())));
    for (std::size_t j = 0; j < chains.size(); ++j) {
      const Eigen::VectorXd K = scaled_gain(settings.ell, of_mode[j]);
      gain.block(chains.first[j], static_cast<Eigen::Index>(j), K.size(), 1) = K;
    }
  }
  return result;
}

Eigen::VectorXd inverse_powers(const HighGainSettings& settings, const Plant& plant) {
  const OutputChains chains = chains_of(settings, plant);
  Eigen::VectorXd powers(chains.entries());
  for (std::size_t j = 0; j < chains.size(); ++j) {
    for (Eigen::Index i = chains.first[j]; i <= chains.last[j]; ++i) {
      powers(i) = std::pow(settings.ell, -static_cast<double>(i - chains.first[j]));
    }
  }
  return powers;
}

LawGains list_gains(const HighGainSettings& settings, const Plant& plant,
                    const std::vector<std::string>& maps) {
  LawGains listed;
  for (Eigen::Index i = 0; i < plant.states(); ++i) {
    const std::string& state = plant.state_names()[static_cast<std::size_t>(i)];
    const auto bounds = settings.saturation.bounds(i);
    if (bounds) listed.add("saturations/" + state, *bounds);
  }
  listed.add("ell", settings.ell);
  for (std::size_t mode = 0; mode < settings.K.size(); ++mode) {
    std::string where;
    if (plant.switches()) where = "modes/" + std::to_string(plant.modes()[mode].label) + "/";
    const std::vector<Eigen::VectorXd>& K = settings.K[mode];
    for (std::size_t i = 0; i < K.size(); ++i) {
      const std::string name = K.size() == 1 ? "K" : "K/" + std::to_string(i + 1);
      listed.add(where + name, K[i].transpose());
    }
    for (const std::string& map : maps) listed.add(where + map, Eigen::MatrixXd());
  }
  return listed;
}

}  // namespace sampled_data_observers

#include "observer/high_gain_settings.h"

#include <algorithm>
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

Eigen::Index order_of_one_output(const HighGainSettings& settings, const Plant& plant) {
  if (plant.sensors().size() != 1 || plant.max_outputs() != 1) {
    throw std::invalid_argument("this form takes one continuous sensor with one output");
  }
  require_of_gains(!settings.K.empty() && settings.K.front().size() == 1, "K: one list of numbers");
  const Eigen::Index d = settings.K.front().front().size();
  const bool agree = std::all_of(settings.K.begin(), settings.K.end(), [d](const auto& of_mode) {
    return of_mode.size() == 1 && of_mode.front().size() == d;
  });
  require_of_gains(agree, "K: as many numbers in each mode");
  return d;
}

std::vector<Eigen::VectorXd> scaled_gains(const HighGainSettings& settings, const Plant& plant) {
  order_of_one_output(settings, plant);
  std::vector<Eigen::VectorXd> result;
  for (const auto& of_mode : settings.K) {
    result.push_back(scaled_gain(settings.ell, of_mode.front()));
  }
  return result;
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

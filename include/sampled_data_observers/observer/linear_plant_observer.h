#pragma once

#include <Eigen/Core>
#include <memory>

#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/linear_plant.h"

namespace sampled_data_observers {

/// What observers of a linear plant share when they copy it between samples: the state is
/// (x̂, u) with u the input held; it flows by ẋ̂ = A x̂ + B u, and jumps as the plant does.
/// A law adds its sample().
class LinearPlantObserver : public ObserverLaw {
 public:
  /// @param initial_estimate  n entries
  /// @param initial_input     p entries: the input before the first input event
  /// @throws std::invalid_argument for sizes that do not fit the plant.
  LinearPlantObserver(std::shared_ptr<const LinearPlant> plant, Eigen::VectorXd initial_estimate,
                      Eigen::VectorXd initial_input);

  const LinearPlant& plant() const { return *plant_; }

  const std::vector<std::string>& estimate_names() const override;
  Eigen::Index state_size() const override;
  Eigen::Index workspace_size() const override;
  Eigen::Index event_size(EventKind kind, int channel) const override;
  Eigen::Index max_event_size() const override;
  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  void keep_input(const double* from, double* state) const override;

 protected:
  void jump(double* state, double* workspace) const override;
  void input(const double* u, double* state) const override;

 private:
  std::shared_ptr<const LinearPlant> plant_;
  Eigen::VectorXd initial_estimate_;
  Eigen::VectorXd initial_input_;
};

}  // namespace sampled_data_observers

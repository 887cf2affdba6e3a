#include "sampled_data_observers/observer/linear_plant_observer.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sampled_data_observers {

LinearPlantObserver::LinearPlantObserver(std::shared_ptr<const LinearPlant> plant,
                                         Eigen::VectorXd initial_estimate,
                                         Eigen::VectorXd initial_input)
    : plant_(std::move(plant)),
      initial_estimate_(std::move(initial_estimate)),
      initial_input_(std::move(initial_input)) {
  if (initial_estimate_.size() != plant_->states()) {
    throw std::invalid_argument("initial estimate: one entry per state of the plant");
  }
  if (initial_input_.size() != plant_->inputs()) {
    throw std::invalid_argument("initial input: one entry per input of the plant");
  }
}

const std::vector<std::string>& LinearPlantObserver::estimate_names() const {
  return plant_->description().state_names;
}

Eigen::Index LinearPlantObserver::state_size() const { return plant_->states() + plant_->inputs(); }

Eigen::Index LinearPlantObserver::workspace_size() const {
  return std::max(plant_->states(), plant_->max_outputs());
}

Eigen::Index LinearPlantObserver::event_size(EventKind kind, int channel) const {
  switch (kind) {
    case EventKind::kInput:
      return plant_->inputs() > 0 && channel == 0 ? plant_->inputs() : -1;
    case EventKind::kJump:
      return plant_->jumps() && channel == 0 ? 0 : -1;
    case EventKind::kSample:
      break;
  }
  const auto sensor = static_cast<std::size_t>(channel);
  return channel >= 0 && sensor < plant_->sensors().size() ? plant_->sensors()[sensor].C.rows()
                                                           : -1;
}

Eigen::Index LinearPlantObserver::max_event_size() const {
  return std::max(plant_->inputs(), plant_->max_outputs());
}

void LinearPlantObserver::initialize(double* state) const {
  std::copy_n(initial_estimate_.data(), plant_->states(), state);
  std::copy_n(initial_input_.data(), plant_->inputs(), state + plant_->states());
}

void LinearPlantObserver::flow(Duration duration, double* state, double* workspace) const {
  plant_->flow().apply(duration, state, state + plant_->states(), workspace);
}

void LinearPlantObserver::jump(double* state, double* workspace) const {
  plant_->jump(state, workspace);
}

void LinearPlantObserver::keep_input(const double* from, double* state) const {
  input(from + plant_->states(), state);
}

void LinearPlantObserver::input(const double* u, double* state) const {
  std::copy_n(u, plant_->inputs(), state + plant_->states());
}

}  // namespace sampled_data_observers

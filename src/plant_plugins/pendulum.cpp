// A plant written in C++ and loaded as a plug-in: the example of doc/extending.md.
#include <cmath>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <stdexcept>

#include "sampled_data_observers/plant/plant_plugin.h"

namespace sampled_data_observers {
namespace {

/// ẋ = (rate, −gravity / length sin(angle) − damping rate + torque)
class PendulumFlow : public VectorMap {
 public:
  PendulumFlow(double stiffness, double damping) : stiffness_(stiffness), damping_(damping) {}

  Eigen::Index size() const override { return 2; }
  void evaluate(const double* x, const double* u, double* out) const override {
    out[0] = x[1];
    out[1] = -stiffness_ * std::sin(x[0]) - damping_ * x[1] + u[0];
  }

 private:
  double stiffness_;
  double damping_;
};

/// Where the bob is: (length sin(angle), −length cos(angle)).
class BobPosition : public VectorMap {
 public:
  explicit BobPosition(double length) : length_(length) {}

  Eigen::Index size() const override { return 2; }
  void evaluate(const double* x, const double*, double* out) const override {
    out[0] = length_ * std::sin(x[0]);
    out[1] = -length_ * std::cos(x[0]);
  }

 private:
  double length_;
};

}  // namespace

/// A pendulum with a motor. Parameters: gravity [m/s^2] and length [m], both positive, and damping
/// [1/s]. States: angle [rad] from hanging down, rate [rad/s]. Input: torque, divided by the
/// inertia [rad/s^2]. Outputs: `angle`, and `bob`, its position [m].
class Pendulum : public PlantPlugin {
 public:
  CompiledPlant build(const std::map<std::string, double>& parameters) const override {
    const auto positive = [&](const char* name) {
      const auto found = parameters.find(name);
      if (found == parameters.end() || found->second <= 0.0) {
        throw std::invalid_argument(std::string("needs a positive parameter '") + name + "'");
      }
      return found->second;
    };
    const double gravity = positive("gravity");
    const double length = positive("length");
    const double damping = positive("damping");
    if (parameters.size() != 3) {
      throw std::invalid_argument("takes the parameters gravity, length and damping, no others");
    }
    CompiledPlant plant;
    plant.state_names = {"angle", "rate"};
    plant.input_names = {"torque"};
    plant.flow = std::make_shared<const PendulumFlow>(gravity / length, damping);
    plant.outputs["angle"] = std::make_shared<const AffineMap>(Eigen::RowVector2d(1.0, 0.0));
    plant.outputs["bob"] = std::make_shared<const BobPosition>(length);
    return plant;
  }
};

}  // namespace sampled_data_observers

PLUGINLIB_EXPORT_CLASS(sampled_data_observers::Pendulum, sampled_data_observers::PlantPlugin)

#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/expression_map.h"

namespace sampled_data_observers {

/// The 15 states of robot_localization, as it names them: pose, velocity and acceleration of a
/// body.
inline const ExpressionNames& body_names() {
  static const ExpressionNames names{
      {"x", "y", "z", "roll", "pitch", "yaw", "vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay", "az"},
      {},
      {}};
  return names;
}

/// How they flow in its model, by formulas.
inline std::shared_ptr<const VectorMap> body_flow() {
  const std::vector<NamedExpression> definitions = {
      {"sr", "sin(roll)"}, {"cr", "cos(roll)"}, {"sp", "sin(pitch)"},          {"cp", "cos(pitch)"},
      {"sy", "sin(yaw)"},  {"cy", "cos(yaw)"},  {"turn", "(wy*sr + wz*cr)/cp"}};
  const std::vector<std::string> formulas = {
      "cy*cp*vx + (cy*sp*sr - sy*cr)*vy + (cy*sp*cr + sy*sr)*vz",
      "sy*cp*vx + (sy*sp*sr + cy*cr)*vy + (sy*sp*cr - cy*sr)*vz",
      "-sp*vx + cp*sr*vy + cp*cr*vz",
      "wx + turn*sp",
      "wy*cr - wz*sr",
      "turn",
      "ax",
      "ay",
      "az",
      "0",
      "0",
      "0",
      "0",
      "0",
      "0"};
  std::vector<NamedExpression> expressions;
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    expressions.push_back({body_names().x[i], formulas[i]});
  }
  return std::make_shared<const ExpressionMap>(body_names(), definitions, expressions);
}

}  // namespace sampled_data_observers

#include "design/linearized_trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear_algebra/matrix_functions.h"
#include "plant/differentiation.h"

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd jacobian(const VectorMap& map, const Eigen::VectorXd& x, const Eigen::VectorXd& u,
                         const Eigen::VectorXd& scales) {
  Eigen::MatrixXd J(map.size(), x.size());
  Eigen::VectorXd workspace(x.size() + 2 * map.size());
  differentiate(map, x.data(), u.data(), scales, J.data(), workspace.data());
  return J;
}

/// Ones in the place of zeros.
Eigen::VectorXd sizes_of(const Eigen::VectorXd& largest) {
  return largest.unaryExpr(
      [](double size) { return size > 0.0 && std::isfinite(size) ? size : 1.0; });
}

class Linearization {
 public:
  Linearization(const Plant& plant, const std::vector<TrajectoryStep>& steps)
      : plant_(plant), state_sizes_(Eigen::VectorXd::Zero(plant.states())) {
    for (const Sensor& sensor : plant.sensors()) {
      output_sizes_.emplace_back(Eigen::VectorXd::Zero(sensor.outputs()));
    }
    for (const TrajectoryStep& step : steps) {
      state_sizes_ = state_sizes_.cwiseMax(step.begin.cwiseAbs()).cwiseMax(step.end.cwiseAbs());
      for (std::size_t i = 0; i < output_sizes_.size(); ++i) {
        for (const Eigen::VectorXd* x : {&step.begin, &step.end}) {
          Eigen::VectorXd y(output_sizes_[i].size());
          plant.modes()[step.mode].outputs[i]->evaluate(x->data(), step.u.data(), y.data());
          output_sizes_[i] = output_sizes_[i].cwiseMax(y.cwiseAbs());
        }
      }
    }
    state_sizes_ = sizes_of(state_sizes_);
    for (Eigen::VectorXd& sizes : output_sizes_) sizes = sizes_of(sizes);
  }

  LinearizedStep of(const TrajectoryStep& step) const {
    const PlantMode& mode = plant_.modes()[step.mode];
    LinearizedStep result;
    const Eigen::VectorXd middle = 0.5 * (step.begin + step.end);
    result.A = scaled(jacobian(*mode.flow, middle, step.u, state_sizes_), state_sizes_);
    result.transition = exponential_of(result.A * step.duration);
    result.C = outputs(step, step.begin, false);
    result.C_d = Eigen::MatrixXd(0, plant_.states());
    if (!step.jumps) return result;
    result.C_d = outputs(step, step.end, true);
    result.G = mode.jump
                   ? scaled(jacobian(*mode.jump, step.end, step.u, state_sizes_), state_sizes_)
                   : Eigen::MatrixXd::Identity(plant_.states(), plant_.states());
    return result;
  }

 private:
  /// Of a map whose result has those units.
  Eigen::MatrixXd scaled(const Eigen::MatrixXd& J, const Eigen::VectorXd& sizes) const {
    return sizes.cwiseInverse().asDiagonal() * J * state_sizes_.asDiagonal();
  }

  Eigen::MatrixXd outputs(const TrajectoryStep& step, const Eigen::VectorXd& x,
                          bool at_jumps) const {
    Eigen::MatrixXd rows(0, plant_.states());
    for (std::size_t i = 0; i < output_sizes_.size(); ++i) {
      if ((plant_.sensors()[i].timing == SensorTiming::kAtJumps) != at_jumps) continue;
      const Eigen::MatrixXd J =
          scaled(jacobian(*plant_.modes()[step.mode].outputs[i], x, step.u, state_sizes_),
                 output_sizes_[i]);
      const Eigen::Index before = rows.rows();
      rows.conservativeResize(before + J.rows(), Eigen::NoChange);
      rows.bottomRows(J.rows()) = J;
    }
    return rows;
  }

  const Plant& plant_;
  Eigen::VectorXd state_sizes_;
  std::vector<Eigen::VectorXd> output_sizes_;
};

}  // namespace

std::vector<LinearizedStep> linearize(const Plant& plant,
                                      const std::vector<TrajectoryStep>& steps) {
  const Linearization linearization(plant, steps);
  std::vector<LinearizedStep> linear;
  for (const TrajectoryStep& step : steps) linear.push_back(linearization.of(step));
  return linear;
}

Visibility visibility(const std::vector<TrajectoryStep>& steps,
                      const std::vector<LinearizedStep>& linear, std::size_t first, std::size_t end,
                      bool with_jumps) {
  const Eigen::Index n = linear[first].A.rows();
  double duration = 0.0;
  Eigen::Index rows = 0;
  for (std::size_t k = first; k < end; ++k) {
    duration += steps[k].duration;
    rows += linear[k].C.rows() + linear[k].C_d.rows();
  }
  Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(rows, n), n);
  Eigen::MatrixXd carried = Eigen::MatrixXd::Identity(n, n);
  Eigen::Index row = 0;
  for (std::size_t k = first; k < end; ++k) {
    const LinearizedStep& step = linear[k];
    const double weight = duration > 0.0 ? std::sqrt(steps[k].duration / duration) : 0.0;
    seen.middleRows(row, step.C.rows()) = weight * step.C * carried;
    row += step.C.rows();
    carried = step.transition * carried;
    if (step.G.size() == 0) continue;
    if (with_jumps) seen.middleRows(row, step.C_d.rows()) = step.C_d * carried;
    row += step.C_d.rows();
    carried = step.G * carried;
  }
  Visibility result;
  if (!seen.allFinite()) {
    result.least = result.largest = std::numeric_limits<double>::infinity();
    result.direction = Eigen::VectorXd::Zero(n);
    return result;
  }
  const Eigen::VectorXd values = singular_values(seen);
  result.largest = values(0);
  result.least = values(n - 1);
  result.direction = weakest_directions(seen, 1);
  return result;
}

}  // namespace sampled_data_observers

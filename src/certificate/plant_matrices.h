#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// The matrices of one mode of a plant.
struct ModeMatrices {
  int label = 0;
  Eigen::MatrixXd A;                   ///< n x n: the linear part of the flow
  Eigen::MatrixXd C;                   ///< m x n: sampled output; may have no rows
  Eigen::MatrixXd C_c;                 ///< continuous output; may have no rows
  Eigen::MatrixXd C_d;                 ///< output measured at jumps; may have no rows
  std::optional<Eigen::MatrixXd> A_d;  ///< n x n: x⁺ = A_d x + b_d at jumps
};

/// The symbol of one mode of a switched plant: `L_d/2`.
std::string of_mode(const std::string& symbol, const ModeMatrices& mode);

/// n x n: A_d, or the identity for a mode without jump map.
Eigen::MatrixXd jump_of(const ModeMatrices& mode);

/// What a mode shows at a switch: C_d, or C_c where nothing is measured at jumps.
const Eigen::MatrixXd& output_at_switches(const ModeMatrices& mode);

/// Maps of the observer's error e = x − x̂ that a design states, ė = A e in flow and e⁺ = A_d e at
/// jumps before any innovation, each n x n. They stand for maps of the plant that are no matrices:
/// where the observer takes what is nonlinear from measured outputs (output injection), it cancels
/// in the error.
struct StatedErrorMaps {
  std::optional<Eigen::MatrixXd> A;
  std::optional<Eigen::MatrixXd> A_d;

  bool is_empty() const { return !A && !A_d; }
};

/// Which rows of C are those of one sampled sensor.
struct SampledOutputs {
  std::string sensor;        ///< its name
  std::size_t position = 0;  ///< among the sensors of the plant
  Eigen::Index first = 0;    ///< of its rows
  Eigen::Index rows = 0;
};

/// What is stated of a jump map g: |J (g(x) − g(x̂))| <= constant |J (x − x̂)|.
struct LipschitzJump {
  double constant = 0.0;
  Eigen::MatrixXd J;  ///< n x n: the identity, in the units of the plant's file
};

/// The plant as the papers' conditions see it:
///   ẋ = A x + B u + G ψ(S x) + N w between jumps, y = C x at samples, y_p = C_p (x − x̂).
struct PlantMatrices {
  std::vector<std::string> state_names;  ///< n
  std::vector<ModeMatrices> modes;       ///< at least one
  std::vector<SampledOutputs> sampled;   ///< of each sensor that is sampled, in order
  Eigen::MatrixXd G;                     ///< n x s; no columns for a linear flow
  Eigen::MatrixXd S;                     ///< q x n
  std::optional<double> lipschitz_constant;
  /// Of a plant that does not switch; without A_d where the jump map is no matrix.
  std::optional<LipschitzJump> lipschitz_jump;
  std::vector<Eigen::MatrixXd> vertices;  ///< n x n each
  /// Of a flow by formulas, n x n each: A may be anything in their convex hull, at any time. The
  /// mode's A is their mean then.
  std::vector<Eigen::MatrixXd> flow_vertices;
  Eigen::MatrixXd N;       ///< n x n_w; no columns without disturbance
  Eigen::MatrixXd C_p;     ///< n_p x n; no rows without performance output
  StatedErrorMaps stated;  ///< which of A and A_d are not the plant's own

  const ModeMatrices& mode() const { return modes.front(); }
  const Eigen::MatrixXd& A() const { return mode().A; }
  const Eigen::MatrixXd& C() const { return mode().C; }
  Eigen::Index states() const { return A().rows(); }
  bool is_linear() const { return G.cols() == 0; }
  bool jumps() const;
};

/// The matrices of a plant without disturbance and performance output.
/// @param stated  instead of the plant's own maps, for a plant that does not switch
/// @throws std::invalid_argument for a plant that the conditions of the papers are not about: a
/// flow, output map or, without Lipschitz constant, jump map by formulas, or several sensors that
/// measure continuously, or at jumps.
PlantMatrices matrices_of(const Plant& plant, const StatedErrorMaps& stated = {});

}  // namespace sampled_data_observers

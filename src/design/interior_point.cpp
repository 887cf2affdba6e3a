#include "design/interior_point.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "design/conic_step.h"
#include "design/schur_complement.h"
#include "design/sdp_data.h"
#include "design/work_limit.h"

namespace sampled_data_observers {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
/// How near rays must come to proving that there is no solution, or no least one.
constexpr double kRayTolerance = 1e-9;
constexpr double kLargeStart = 100.0;
/// Of a gap and infeasibilities that have stopped falling: what may do.
constexpr double kNearlySolved = 1e-5;
/// Iterations without progress that end it.
constexpr int kIterationsWithoutProgress = 8;
/// A step shorter than this, twice in a row, is none.
constexpr double kLeastStep = 1e-6;

/// The matrices of one block.
struct Cone {
  Eigen::MatrixXd S, Z;  ///< of the program, and of its dual
  Eigen::MatrixXd S_factor, Z_factor, S_inverse;
  Eigen::MatrixXd residual;  ///< S − F(x)
  Eigen::MatrixXd step_S, step_Z;
  Eigen::MatrixXd second_order;  ///< of the predictor: ΔZ ΔS
};

/// How far from a solution a point is.
struct Distances {
  double gap = kUnlimited;
  double primal = kUnlimited;
  double dual = kUnlimited;
  double largest() const { return std::max({gap, primal, dual}); }
};

class InteriorPoint {
 public:
  InteriorPoint(const StandardForm& form, const InteriorPointOptions& options)
      : options_(options), data_(form), schur_(data_) {
    for (const SdpBlock& block : data_.blocks) {
      order_ += block.size();
      largest_constant_ = std::max(largest_constant_, block.constant.norm());
    }
    start();
  }

  InteriorPointResult run() {
    int without_progress = 0;
    int short_steps = 0;
    for (iterations_ = 0; iterations_ < options_.max_iterations; ++iterations_) {
      require_time_left();
      if (!invert()) return stopped("a matrix became singular");
      measure();
      if (!std::isfinite(mu_)) return stopped("numbers overflowed");
      if (const auto told = verdict()) return *told;
      const bool is_nearer = keep_best();
      without_progress = is_nearer || ray_advances() ? 0 : without_progress + 1;
      if (without_progress > kIterationsWithoutProgress || short_steps > 1)
        return stopped("lack of progress");
      assemble();
      if (!schur_.factorize()) return stopped("a matrix became singular");
      const double length = advance();
      if (!std::isfinite(length)) return stopped("numbers overflowed");
      short_steps = length < kLeastStep ? short_steps + 1 : 0;
    }
    return stopped("the maximum number of iterations was reached");
  }

 private:
  /// Multiples of I, of the size of the data, as in SDPT3; Z larger, since solutions may be large
  /// and too small a Z would draw x to where the inequalities seem to contradict each other.
  void start() {
    x_ = Eigen::VectorXd::Zero(data_.objective.size());
    for (const SdpBlock& block : data_.blocks) {
      const double n = static_cast<double>(block.size());
      double primal = std::max(10.0, std::sqrt(n));
      double dual = std::max({10.0, std::sqrt(n), block.constant.norm()});
      for (std::size_t i = 0; i < block.variables.size(); ++i) {
        double square = 0.0;
        for (std::size_t e = block.first[i]; e < block.first[i + 1]; ++e) {
          const double value = block.entries[e].value;
          square += (block.entries[e].row == block.entries[e].col ? 1.0 : 2.0) * value * value;
        }
        const double norm = std::sqrt(square);
        const double c = std::abs(data_.objective(block.variables[i]));
        primal = std::max(primal, n * (1.0 + c) / (1.0 + norm));
        dual = std::max(dual, norm);
      }
      Cone cone;
      const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(block.size(), block.size());
      cone.Z = kLargeStart * primal * unit;
      cone.S = dual * unit;
      cones_.push_back(std::move(cone));
    }
  }

  /// Factors, inverse and what x leaves of S.
  bool invert() {
    for (std::size_t b = 0; b < cones_.size(); ++b) {
      Cone& cone = cones_[b];
      const SdpBlock& block = data_.blocks[b];
      cone.residual = block.constant;
      block.add_combination(x_, cone.residual);
      cone.residual = cone.S - cone.residual;
      if (!lower_factor(cone.S, cone.S_factor) || !lower_factor(cone.Z, cone.Z_factor)) {
        return false;
      }
      cone.S_inverse = inverse_from_factor(cone.S_factor);
    }
    return true;
  }

  void measure() {
    double complementarity = 0.0;
    double residual = 0.0;
    double constant_Z = 0.0;
    slope_ = Eigen::VectorXd::Zero(x_.size());
    for (std::size_t b = 0; b < cones_.size(); ++b) {
      const Cone& cone = cones_[b];
      complementarity += cone.S.cwiseProduct(cone.Z).sum();
      residual += cone.residual.squaredNorm();
      constant_Z += data_.blocks[b].constant.cwiseProduct(cone.Z).sum();
      data_.blocks[b].add_inner_products(cone.Z, slope_);
    }
    mu_ = complementarity / static_cast<double>(order_);
    objective_ = data_.objective.dot(x_);
    dual_objective_ = -constant_Z;
    residual_ = std::sqrt(residual);
    distances_.primal = residual_ / (1.0 + largest_constant_);
    distances_.dual = (data_.objective - slope_).norm() / (1.0 + data_.objective.norm());
    gap_ = std::max(complementarity, objective_ - dual_objective_);
    distances_.gap = gap_ / (1.0 + std::abs(objective_) + std::abs(dual_objective_));
  }

  /// Whether Z tells better than before that the program has no solution.
  bool ray_advances() {
    if (!(dual_objective_ > 0.0)) return false;
    const double distance = slope_.norm() / dual_objective_;
    if (!(distance < 0.9 * best_ray_)) return false;
    best_ray_ = distance;
    return true;
  }

  /// Whether the point, or a ray, settles it.
  std::optional<InteriorPointResult> verdict() {
    const bool is_enough = distances_.primal < options_.tolerance &&
                           distances_.dual < kNearlySolved && gap_ < -options_.enough * objective_;
    if (is_enough || distances_.largest() < options_.tolerance) {
      best_distances_ = Distances();
      keep_best();
      return result(SolverStatus::kSolved, "solved");
    }
    if (dual_objective_ > 0.0 && slope_.norm() < kRayTolerance * dual_objective_) {
      return result(SolverStatus::kInfeasible, "the inequalities contradict each other");
    }
    if (objective_ < 0.0) {
      double left = 0.0;
      for (std::size_t b = 0; b < cones_.size(); ++b) {
        left += (cones_[b].residual + data_.blocks[b].constant).squaredNorm();
      }
      if (std::sqrt(left) < -kRayTolerance * objective_) {
        return result(SolverStatus::kUnbounded, "the objective is not bounded below");
      }
    }
    return std::nullopt;
  }

  bool keep_best() {
    const double distance = distances_.largest();
    if (!(distance < best_distances_.largest())) return false;
    const bool is_progress = distance < 0.9 * best_distances_.largest();
    best_distances_ = distances_;
    best_x_ = x_;
    best_objective_ = objective_;
    best_dual_objective_ = dual_objective_;
    return is_progress;
  }

  void assemble() {
    schur_.set_zero();
    for (std::size_t b = 0; b < cones_.size(); ++b) {
      schur_.add_block(b, cones_[b].S_inverse, cones_[b].Z);
    }
  }

  /// The direction towards S Z = target I.
  /// @param corrects  by the second order term of the predictor
  void find_direction(double target, bool corrects) {
    Eigen::VectorXd right = -data_.objective;
    Eigen::MatrixXd part;
    for (std::size_t b = 0; b < cones_.size(); ++b) {
      const Cone& cone = cones_[b];
      part.noalias() = cone.Z * cone.residual;
      if (corrects) part -= cone.second_order;
      part = Eigen::MatrixXd(part * cone.S_inverse);
      if (target > 0.0) part += target * cone.S_inverse;
      data_.blocks[b].add_inner_products(part, right);
    }
    step_x_ = schur_.solve(right);
    for (std::size_t b = 0; b < cones_.size(); ++b) {
      Cone& cone = cones_[b];
      cone.step_S = -cone.residual;
      data_.blocks[b].add_combination(step_x_, cone.step_S);
      part.noalias() = cone.Z * cone.step_S;
      if (corrects) part += cone.second_order;
      cone.step_Z.noalias() = part * cone.S_inverse;
      cone.step_Z = target * cone.S_inverse - cone.Z -
                    Eigen::MatrixXd((cone.step_Z + cone.step_Z.transpose()) / 2.0);
    }
  }

  /// How far S and Z remain positive definite along their steps.
  std::pair<double, double> lengths() const {
    double primal = kUnlimited;
    double dual = kUnlimited;
    for (const Cone& cone : cones_) {
      primal = std::min(primal, largest_step(cone.S_factor, cone.step_S));
      dual = std::min(dual, largest_step(cone.Z_factor, cone.step_Z));
    }
    return {primal, dual};
  }

  /// Predictor and corrector.
  /// @return the shorter of the two steps; not finite where numbers overflowed
  double advance() {
    find_direction(0.0, false);
    auto [primal, dual] = lengths();
    primal = std::min(1.0, primal);
    dual = std::min(1.0, dual);
    double after = 0.0;
    for (Cone& cone : cones_) {
      after += (cone.S + primal * cone.step_S).cwiseProduct(cone.Z + dual * cone.step_Z).sum();
      cone.second_order.noalias() = cone.step_Z * cone.step_S;
    }
    after /= static_cast<double>(order_);
    const double shorter = std::min(primal, dual);
    const double power = std::max(1.0, 3.0 * shorter * shorter);
    const double centering = std::pow(std::clamp(after / mu_, 0.0, 1.0), power);
    find_direction(std::max(centering, 1e-6) * mu_, true);
    const double room = 0.9 + 0.09 * shorter;
    std::tie(primal, dual) = lengths();
    primal = std::min(1.0, room * primal);
    dual = std::min(1.0, room * dual);
    if (!step_x_.allFinite() || !(primal > 0.0) || !(dual > 0.0)) return kUnlimited;
    x_ += primal * step_x_;
    for (Cone& cone : cones_) {
      cone.S += primal * cone.step_S;
      cone.Z += dual * cone.step_Z;
    }
    return std::min(primal, dual);
  }

  InteriorPointResult stopped(const char* why) {
    const double left = best_distances_.largest();
    return result(left < kNearlySolved
                      ? SolverStatus::kSolved
                      : (std::isfinite(left) ? SolverStatus::kInaccurate : SolverStatus::kFailed),
                  why);
  }

  InteriorPointResult result(SolverStatus status, const char* message) const {
    InteriorPointResult result;
    result.status = status;
    result.message = message;
    result.iterations = iterations_;
    const bool has_best = best_x_.size() == x_.size() && status != SolverStatus::kInfeasible &&
                          status != SolverStatus::kUnbounded;
    const Eigen::VectorXd x = (has_best ? best_x_ : x_).cwiseProduct(data_.units);
    result.x.assign(x.data(), x.data() + x.size());
    result.gap = has_best ? best_distances_.gap : distances_.gap;
    result.objective = data_.objective_unit * (has_best ? best_objective_ : objective_);
    result.dual_objective =
        data_.objective_unit * (has_best ? best_dual_objective_ : dual_objective_);
    return result;
  }

  const InteriorPointOptions& options_;
  const SdpData data_;
  SchurComplement schur_;
  Eigen::Index order_ = 0;  ///< of all blocks
  double largest_constant_ = 0.0;

  int iterations_ = 0;
  Eigen::VectorXd x_, step_x_;
  std::vector<Cone> cones_;
  Eigen::VectorXd slope_;  ///< tr(F_k Z)
  double mu_ = 0.0;
  double objective_ = 0.0;
  double dual_objective_ = 0.0;
  double residual_ = 0.0;
  double gap_ = 0.0;
  Distances distances_;

  double best_ray_ = 1e-2;
  Distances best_distances_;
  Eigen::VectorXd best_x_;
  double best_objective_ = 0.0;
  double best_dual_objective_ = 0.0;
};

}  // namespace

InteriorPointResult solve_by_interior_point(const StandardForm& form,
                                            const InteriorPointOptions& options) {
  return InteriorPoint(form, options).run();
}

}  // namespace sampled_data_observers

#pragma once

#include <Eigen/Core>
#include <vector>

#include "sampled_data_observers/plant/linear_flow.h"
#include "sampled_data_observers/plant/plant.h"
#include "sampled_data_observers/plant/runge_kutta_flow.h"

namespace sampled_data_observers::test {

/// ẋ = f(x) + N w of the modes of a plant, with w held and without input: exact where f is affine.
class DisturbedFlow : private VectorField {
 public:
  /// @param N     n x n_w
  /// @param step  of the integration where f is not affine
  DisturbedFlow(const Plant& plant, Eigen::MatrixXd N, Duration step)
      : plant_(plant),
        N_(std::move(N)),
        numeric_(plant.states(), step),
        u_(Eigen::VectorXd::Zero(plant.inputs())),
        scratch_(plant.states()) {
    if (!plant.is_affine()) return;
    for (const PlantMode& mode : plant.modes()) {
      Eigen::MatrixXd B(N_.rows(), N_.cols() + 1);
      B << N_, mode.flow->affine()->c();
      exact_.emplace_back(mode.flow->affine()->M(), B);
    }
  }

  void apply(std::size_t mode, const Eigen::VectorXd& w, Duration duration, Eigen::VectorXd& x) {
    if (exact_.empty()) {
      mode_ = mode;
      N_w_ = N_ * w;
      numeric_.apply(*this, duration, x.data());
      return;
    }
    Eigen::VectorXd held(w.size() + 1);
    held << w, 1.0;
    exact_[mode].apply(duration, x.data(), held.data(), scratch_.data());
  }

 private:
  void evaluate(const double* x, double* dx) const override {
    plant_.modes()[mode_].flow->evaluate(x, u_.data(), dx);
    for (Eigen::Index i = 0; i < N_w_.size(); ++i) dx[i] += N_w_(i);
  }

  const Plant& plant_;
  Eigen::MatrixXd N_;
  std::vector<LinearFlow> exact_;
  RungeKuttaFlow numeric_;
  std::size_t mode_ = 0;
  Eigen::VectorXd N_w_;
  Eigen::VectorXd u_;
  Eigen::VectorXd scratch_;
};

}  // namespace sampled_data_observers::test

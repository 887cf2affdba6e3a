// Plants for the variants of the Kalman filter.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "observer/kalman_matrices.h"
#include "sampled_data_observers/plant/expression_map.h"
#include "support/law_runner.h"

namespace sampled_data_observers::test {

/// An affine map that does not say that it is one: with its derivative, or without.
class Disguised : public VectorMap {
 public:
  Disguised(const Eigen::MatrixXd& M, bool knows_derivative)
      : map_(M), knows_derivative_(knows_derivative) {}
  Eigen::Index size() const override { return map_.size(); }
  void evaluate(const double* x, const double* u, double* out) const override {
    map_.evaluate(x, u, out);
  }
  std::shared_ptr<const VectorMap> jacobian() const override {
    if (!knows_derivative_) return nullptr;
    const Eigen::MatrixXd& M = map_.M();
    return std::make_shared<const AffineMap>(Eigen::MatrixXd::Zero(M.size(), M.cols()),
                                             Eigen::MatrixXd(M.size(), 0),
                                             Eigen::Map<const Eigen::VectorXd>(M.data(), M.size()));
  }

 private:
  AffineMap map_;
  bool knows_derivative_;
};

enum class Disguise { kNone, kOutputs, kAll, kAllWithoutDerivatives };

struct LinearPlant {
  Disguise disguise = Disguise::kNone;
  Duration step = 1000000;
  double stamp_deviation = 0.0;
};

template <class Law>
std::shared_ptr<const Law> filter_of_linear_plant(const LinearPlant& options) {
  const auto map = [&](const Eigen::MatrixXd& M, bool is_output) {
    const bool is_disguised = options.disguise != Disguise::kNone &&
                              (is_output || options.disguise != Disguise::kOutputs);
    const bool knows = options.disguise != Disguise::kAllWithoutDerivatives;
    return is_disguised
               ? std::shared_ptr<const VectorMap>(std::make_shared<const Disguised>(M, knows))
               : std::make_shared<const AffineMap>(M);
  };
  Eigen::Matrix3d A;
  A << 0.0, 1.0, 0.0, -2.0, -0.3, 0.5, 0.1, 0.0, -0.2;
  Eigen::Matrix3d A_d;
  A_d << 1.0, 0.0, 0.0, 0.0, -0.8, 0.1, 0.0, 0.0, 1.0;
  PlantDescription description;
  description.state_names = {"x1", "x2", "x3"};
  description.sensors = {{"a", SensorTiming::kSampled, {true, false}},
                         {"d", SensorTiming::kAtJumps, {false}}};
  description.integration.step = options.step;
  PlantMode mode;
  mode.flow = map(A, false);
  mode.jump = map(A_d, false);
  mode.outputs = {map((Eigen::MatrixXd(2, 3) << 1.0, 0.0, 0.0, 0.5, 0.0, 1.0).finished(), true),
                  map(Eigen::RowVector3d(0.0, 1.0, 0.0), true)};
  description.modes = {mode};
  KalmanCovariances covariances;
  covariances.P0 = Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal();
  covariances.R = {(Eigen::Matrix2d() << 0.1, 0.03, 0.03, 0.2).finished(),
                   Eigen::MatrixXd::Constant(1, 1, 0.05)};
  covariances.Q = Eigen::Vector3d(0.0, 0.3, 0.1).asDiagonal();
  covariances.Q_d = Eigen::Vector3d(0.01, 0.0, 0.02).asDiagonal();
  covariances.stamp_deviation = options.stamp_deviation;
  return std::make_shared<const Law>(
      ObserverContext{std::make_shared<const Plant>(description), Eigen::Vector3d(0.5, -1.0, 0.2),
                      Eigen::VectorXd::Zero(0)},
      covariances);
}

/// The estimate and its covariance after the same random events.
inline Eigen::VectorXd after_events(const std::shared_ptr<const PlantObserver>& law) {
  LawRunner runner(law);
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> value(-2.0, 2.0);
  std::uniform_real_distribution<double> interval(0.05, 0.3);
  Eigen::VectorXd all(0);
  const auto note = [&] {
    Eigen::VectorXd more(all.size() + 12);
    more << all, runner.estimate(),
        Eigen::Map<const Eigen::VectorXd>(law->covariance(runner.state().data()), 9);
    all = more;
  };
  for (int i = 0; i < 40; ++i) {
    runner.flow(from_seconds(interval(generator)));
    note();
    const double y = value(generator);
    if (i % 4 == 0) {
      runner.jump(i % 8 == 0 ? std::vector<double>{y} : std::vector<double>{});
    } else {
      runner.sample(0, {3.0 * y, value(generator)});
    }
    note();
  }
  return all;
}

inline std::shared_ptr<const ExpressionMap> formulas(const ExpressionNames& names,
                                                     const std::vector<std::string>& texts) {
  std::vector<NamedExpression> expressions;
  for (const std::string& text : texts) {
    expressions.push_back({"f" + std::to_string(expressions.size()), text});
  }
  return std::make_shared<const ExpressionMap>(names, std::vector<NamedExpression>{}, expressions);
}

}  // namespace sampled_data_observers::test

#include "plant/bias_states.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {
namespace {

/// A map of the first states of an extended plant, to whose result E x_ext is added: the new states
/// themselves behind a jump, the biases on an output. A flow or jump map gets longer by the number
/// of new states.
class ExtendedMap : public VectorMap {
 public:
  ExtendedMap(std::shared_ptr<const VectorMap> map, Eigen::MatrixXd E)
      : map_(std::move(map)), E_(std::move(E)) {}

  Eigen::Index size() const override { return E_.rows(); }
  void evaluate(const double* x, const double* u, double* out) const override {
    map_->evaluate(x, u, out);
    for (Eigen::Index i = map_->size(); i < size(); ++i) out[i] = 0.0;
    add_product(E_, x, out);
  }
  std::shared_ptr<const VectorMap> jacobian() const override;

 private:
  std::shared_ptr<const VectorMap> map_;
  Eigen::MatrixXd E_;  ///< size() x extended states
};

/// Of an ExtendedMap: the Jacobian of the map by the first states, in the upper left, plus E.
class ExtendedJacobian : public VectorMap {
 public:
  ExtendedJacobian(std::shared_ptr<const VectorMap> jacobian, Eigen::Index rows, Eigen::MatrixXd E)
      : jacobian_(std::move(jacobian)),
        rows_(rows),
        E_(std::move(E)),
        entries_(jacobian_->size()) {}

  Eigen::Index size() const override { return E_.size(); }
  void evaluate(const double* x, const double* u, double* out) const override {
    jacobian_->evaluate(x, u, entries_.data());
    std::copy_n(E_.data(), E_.size(), out);
    for (Eigen::Index k = 0; k < entries_.size(); ++k) {
      out[(k / rows_) * E_.rows() + k % rows_] += entries_(k);
    }
  }

 private:
  std::shared_ptr<const VectorMap> jacobian_;
  Eigen::Index rows_;  ///< of jacobian_
  Eigen::MatrixXd E_;
  mutable Eigen::VectorXd entries_;
};

std::shared_ptr<const VectorMap> ExtendedMap::jacobian() const {
  std::shared_ptr<const VectorMap> of_map = map_->jacobian();
  if (of_map == nullptr) return nullptr;
  return std::make_shared<const ExtendedJacobian>(std::move(of_map), map_->size(), E_);
}

std::shared_ptr<const VectorMap> extended(const std::shared_ptr<const VectorMap>& map,
                                          const Eigen::MatrixXd& E) {
  const AffineMap* affine = map->affine();
  if (affine == nullptr) return std::make_shared<const ExtendedMap>(map, E);
  Eigen::MatrixXd M = E;
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(E.rows(), affine->N().cols());
  Eigen::VectorXd c = Eigen::VectorXd::Zero(E.rows());
  M.topLeftCorner(affine->M().rows(), affine->M().cols()) += affine->M();
  N.topRows(affine->N().rows()) = affine->N();
  c.head(affine->c().size()) = affine->c();
  return std::make_shared<const AffineMap>(std::move(M), std::move(N), std::move(c));
}

}  // namespace

PlantDescription with_bias_states(PlantDescription plant, const std::vector<BiasState>& biases) {
  if (biases.empty()) return plant;
  const auto n = static_cast<Eigen::Index>(plant.state_names.size());
  const auto added = static_cast<Eigen::Index>(biases.size());
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(n + added, n + added);
  Eigen::MatrixXd keep = none;
  keep.bottomRightCorner(added, added).setIdentity();
  for (PlantMode& mode : plant.modes) {
    mode.flow = extended(mode.flow, none);
    if (mode.jump) mode.jump = extended(mode.jump, keep);
    for (std::size_t sensor = 0; sensor < plant.sensors.size(); ++sensor) {
      Eigen::MatrixXd E = Eigen::MatrixXd::Zero(plant.sensors[sensor].outputs(), n + added);
      for (std::size_t i = 0; i < biases.size(); ++i) {
        if (biases[i].sensor == sensor) E(biases[i].output, n + static_cast<Eigen::Index>(i)) = 1.0;
      }
      mode.outputs[sensor] = extended(mode.outputs[sensor], E);
    }
  }
  for (const BiasState& bias : biases) plant.state_names.push_back(bias.name);
  return plant;
}

}  // namespace sampled_data_observers

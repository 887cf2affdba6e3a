#include "observer/scheduled_gain.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "linear_algebra/definite_matrix.h"
#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {
namespace {

/// A sum of matrices with P − δD ⪰ 0, D the diagonal of P, is one again. With this δ no Cholesky
/// factorization of it, of up to 120 rows, fails by rounding: that moves the matrix, scaled to a
/// unit diagonal, by less than n (n + 10) 2^-53.
constexpr double kLeastEigenvalue = 1e-11;

void demand(bool holds, const std::string& name, const std::string& what) {
  if (!holds) throw std::invalid_argument(name + " must " + what);
}

/// The grid of nodes that fit the plant's sensors.
TensorGrid make_grid(const std::vector<std::vector<double>>& timers, const Plant& plant) {
  demand(timers.size() == plant.sensors().size(), "timers", "have one entry per sensor");
  for (std::size_t i = 0; i < timers.size(); ++i) {
    demand(!timers[i].empty() && timers[i].front() == 0.0, "timers/" + plant.sensors()[i].name,
           "begin with 0");
  }
  return TensorGrid(timers);
}

Eigen::MatrixXd checked_metric(const std::string& name, const Eigen::MatrixXd& P, Eigen::Index n) {
  Eigen::MatrixXd symmetric = checked_positive_definite(name, P, n);
  Eigen::MatrixXd rest = symmetric;
  rest.diagonal() *= 1.0 - kLeastEigenvalue;
  demand(factor_cholesky(rest.data(), n), name,
         "be further from singular: scaled to a unit diagonal, its least eigenvalue is below "
         "1e-11");
  return symmetric;
}

/// C_i of a sensor for whose gain a Z stands.
Eigen::MatrixXd linear_output(const Plant& plant, std::size_t sensor, const std::string& name) {
  const AffineMap* map = plant.modes().front().outputs[sensor]->affine();
  demand(map != nullptr && !plant.switches(), name,
         "be of a sensor with a linear output (C), of a plant that does not switch");
  return map->M();
}

/// M ← M + w A
void add_scaled(const Eigen::MatrixXd& A, double w, double* M) {
  const double* entries = A.data();
  for (Eigen::Index i = 0; i < A.size(); ++i) M[i] += w * entries[i];
}

}  // namespace

ScheduledGain::ScheduledGain(ScheduledGains gains, const Plant& plant)
    : grid_(make_grid(gains.timers, plant)),
      n_(plant.states()),
      K_(std::move(gains.K)),
      Z_(std::move(gains.Z)),
      metric_(workspace_.vector(n_ * n_)),
      correction_(workspace_.vector(n_ * plant.max_outputs())),
      product_(workspace_.vector(n_ * plant.max_outputs())) {
  demand(gains.P.size() == grid_.size(), "P", "have one matrix per node");
  for (std::size_t node = 0; node < grid_.size(); ++node) {
    P_.push_back(checked_metric("P/" + std::to_string(node), gains.P[node], n_));
  }
  demand(K_.size() == plant.sensors().size(), "K", "have one entry per sensor");
  Z_.resize(K_.size());
  for (std::size_t i = 0; i < K_.size(); ++i) {
    const std::string name = "K/" + plant.sensors()[i].name;
    const Eigen::Index m = plant.sensors()[i].outputs();
    demand(K_[i].size() == grid_.size(), name, "have one matrix per node");
    std::vector<Eigen::MatrixXd>& products = PK_.emplace_back();
    Z_[i].resize(grid_.size());
    for (std::size_t node = 0; node < grid_.size(); ++node) {
      Eigen::MatrixXd& K = K_[i][node];
      if (Z_[i][node].size() > 0) {
        products.push_back(product_of_Z(plant, i, node, K));
        continue;
      }
      const std::string of_node = name + "/" + std::to_string(node);
      demand(K.rows() == n_ && K.cols() == m, of_node,
             "have one row per state, one column per "
             "output");
      Eigen::MatrixXd& PK = products.emplace_back(n_, m);
      multiply(P_[grid_.with_first(node, i)].data(), n_, n_, K.data(), m, PK.data());
      demand(PK.allFinite(), of_node, "be finite, and its product with P");
    }
  }
}

/// C_iᵀ Z, and the gain that it is the product of.
Eigen::MatrixXd ScheduledGain::product_of_Z(const Plant& plant, std::size_t sensor,
                                            std::size_t node, Eigen::MatrixXd& K) const {
  const std::string name = "Z/" + plant.sensors()[sensor].name + "/" + std::to_string(node);
  const Eigen::MatrixXd& Z = Z_[sensor][node];
  const Eigen::MatrixXd Ct = linear_output(plant, sensor, name).transpose();
  const Eigen::Index m = Ct.cols();
  demand(grid_.position(node, sensor) == 0, name, "be of a node at which the sensor's time is 0");
  demand(Z.rows() == m && Z.cols() == m, name, "have one row and one column per output");
  Eigen::MatrixXd product(n_, m);
  multiply(Ct.data(), n_, m, Z.data(), m, product.data());
  demand(product.allFinite(), name, "be finite, and its product with C");
  Eigen::MatrixXd metric = P_[node];
  factor_cholesky(metric.data(), n_);  // never fails: see kLeastEigenvalue
  K = product;
  solve_lower(metric.data(), n_, n_, K.data(), m);
  solve_lower_transposed(metric.data(), n_, n_, K.data(), m);
  return product;
}

void ScheduledGain::evaluate(std::size_t sensor, const double* tau, double* K,
                             double* workspace) const {
  const TensorGrid::Interpolation at = grid_.locate(tau);
  const Eigen::Index size = K_[sensor].front().size();
  std::fill_n(K, size, 0.0);
  for (std::size_t v = 0; v < at.size; ++v) {
    add_scaled(K_[sensor][at.vertices[v]], at.weights[v], K);
  }
  // The metric is that of the first node everywhere, and so the mean the plain one.
  if (grid_.dimensions() == 1) return;
  // What the mean in the metric has beside the plain one: exactly nothing at a node.
  double* metric = metric_.of(workspace);
  double* correction = correction_.of(workspace);
  double* product = product_.of(workspace);
  metric_.fill(0.0, workspace);
  std::fill_n(correction, size, 0.0);
  for (std::size_t v = 0; v < at.size; ++v) {
    const std::size_t vertex = at.vertices[v];
    add_scaled(P_[grid_.with_first(vertex, sensor)], at.weights[v], metric);
    add_scaled(PK_[sensor][vertex], at.weights[v], correction);
  }
  const Eigen::Index m = size / n_;
  multiply(metric, n_, n_, K, m, product);
  for (Eigen::Index i = 0; i < size; ++i) correction[i] -= product[i];
  factor_cholesky(metric, n_);  // never fails: see kLeastEigenvalue
  solve_lower(metric, n_, n_, correction, m);
  solve_lower_transposed(metric, n_, n_, correction, m);
  for (Eigen::Index i = 0; i < size; ++i) K[i] += correction[i];
}

void ScheduledGain::list(const Plant& plant, LawGains* gains) const {
  for (std::size_t i = 0; i < K_.size(); ++i) {
    const std::vector<double>& nodes = grid_.nodes(i);
    gains->add("timers/" + plant.sensors()[i].name,
               Eigen::Map<const Eigen::RowVectorXd>(nodes.data(),
                                                    static_cast<Eigen::Index>(nodes.size())));
  }
  for (std::size_t node = 0; node < P_.size(); ++node) {
    gains->add("P/" + std::to_string(node), P_[node]);
  }
  for (std::size_t i = 0; i < K_.size(); ++i) {
    for (std::size_t node = 0; node < K_[i].size(); ++node) {
      const std::string of_node = plant.sensors()[i].name + "/" + std::to_string(node);
      if (Z_[i][node].size() > 0) {
        gains->add("Z/" + of_node, Z_[i][node]);
      } else {
        gains->add("K/" + of_node, K_[i][node]);
      }
    }
  }
}

}  // namespace sampled_data_observers

#include "certificate/flown_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "certificate/outward.h"
#include "linear_algebra/matrix_functions.h"
#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {
namespace {

// As in ExponentialNorm: of rounding, and of that of a stiff flow, times ‖A‖ τ and n.
constexpr double kRoundingOfFlown = 1e-9;
constexpr double kStiffness = 1e-15;
/// Of n terms of a product, and with room of those of an inverse.
constexpr double kRoundingOfProduct = 1e-15;

}  // namespace

/// e^{Aτ} X_i r_i of each ball, in the workspace.
struct FlownErrors::Parts {
  struct Part {
    double* M = nullptr;  ///< n x columns
    Eigen::Index columns = 0;
    /// Of row j what is lost is at most loss rows_(j) + reach inexact_(j).
    double loss = 0.0;
    double reach = 0.0;
  };
  std::array<Part, kMostBalls> part;

  double width(std::size_t i, Eigen::Index row, Eigen::Index n) const {
    double sum = 0.0;
    for (Eigen::Index j = 0; j < part[i].columns; ++j) {
      sum += part[i].M[j * n + row] * part[i].M[j * n + row];
    }
    return std::sqrt(sum);
  }
};

FlownErrors::FlownErrors(const Eigen::MatrixXd& A, const FlowGrowth& growth,
                         const std::vector<Shape>& shapes)
    : n_(A.rows()),
      rate_(growth.rate),
      stiffness_(kStiffness * static_cast<double>(n_) *
                 (growth.W.cwiseAbs() * A.cwiseAbs() * growth.inverse_W.cwiseAbs()).norm()),
      flow_(growth.W * A * growth.inverse_W, Eigen::MatrixXd::Zero(n_, 0)),
      inverse_W_(growth.inverse_W),
      rows_(raised(1.0) * growth.inverse_W.rowwise().norm()),
      inexact_(raised(1.0) * inverse_with_rounding(growth.W).rounding.rowwise().norm()) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(n_, n_);
  for (const Shape& shape : shapes) {
    const Shape start = product_with_rounding(growth.W, none, shape);
    starts_.push_back({start.X, raised(start.X.norm()), raised(start.rounding.norm())});
    most_columns_ = std::max(most_columns_, start.X.cols());
  }
}

Eigen::Index FlownErrors::workspace_size() const {
  const auto balls = static_cast<Eigen::Index>(kMostBalls);
  return n_ * n_ + (balls + 1) * n_ * most_columns_ + n_;
}

FlownErrors::Parts FlownErrors::flown(double tau, const Balls& balls, double* workspace) const {
  double* E = workspace;
  double* weighed = E + n_ * n_;
  double* M = weighed + n_ * most_columns_;
  double* scratch = M + static_cast<Eigen::Index>(kMostBalls) * n_ * most_columns_;
  flow_.transition(from_seconds(tau), E, scratch);
  const double lost = kRoundingOfFlown + stiffness_ * tau;
  const double growth = raised(std::exp(rate_ * tau));
  Parts parts;
  const std::array<Ball, kMostBalls> all = {balls.first, balls.second};
  for (std::size_t i = 0; i < kMostBalls; ++i, M += n_ * most_columns_) {
    const double radius = all[i].radius;
    if (radius == 0.0) continue;
    const Start& start = starts_[all[i].shape];
    const Eigen::Index columns = start.WX.cols();
    multiply(E, n_, n_, start.WX.data(), columns, weighed);
    multiply(inverse_W_.data(), n_, n_, weighed, columns, M);
    for (Eigen::Index k = 0; k < n_ * columns; ++k) M[k] *= radius;
    const double grown = radius * growth;
    parts.part[i] = {M, columns, grown * (lost * start.size + start.rounding), grown * start.size};
  }
  return parts;
}

double FlownErrors::lost(const Parts& parts, Eigen::Index row) const {
  double sum = 0.0;
  for (const Parts::Part& part : parts.part) {
    sum += part.loss * rows_(row) + part.reach * inexact_(row);
  }
  return sum;
}

void FlownErrors::bounds(double tau, const Balls& balls, double* workspace,
                         Eigen::Ref<Eigen::VectorXd> bounds) const {
  const Parts parts = flown(tau, balls, workspace);
  for (Eigen::Index row = 0; row < n_; ++row) {
    double sum = lost(parts, row);
    for (std::size_t i = 0; i < kMostBalls; ++i) sum += parts.width(i, row, n_);
    bounds(row) = raised(sum);
  }
}

/// The sum of ellipsoids Q_i lies in that of Σ Q_i/p_i, Σ p_i = 1, which is smallest where the p_i
/// are as the sizes of the Q_i: those beside the sum, each state in units of its own. What is lost
/// of row j is at most l_j: it lies in n diag(l_j²).
void FlownErrors::ellipsoid(double tau, const Balls& balls, double* workspace,
                            Eigen::Ref<Eigen::MatrixXd> Q) const {
  const Parts parts = flown(tau, balls, workspace);
  std::array<double, kMostBalls + 1> size{};
  const auto loss = [&](Eigen::Index row) {
    return std::sqrt(static_cast<double>(n_)) * lost(parts, row);
  };
  for (Eigen::Index row = 0; row < n_; ++row) {
    double sum = loss(row);
    for (std::size_t i = 0; i < kMostBalls; ++i) sum += parts.width(i, row, n_);
    if (sum == 0.0) continue;
    for (std::size_t i = 0; i < kMostBalls; ++i) {
      size[i] += std::pow(parts.width(i, row, n_) / sum, 2);
    }
    size[kMostBalls] += std::pow(loss(row) / sum, 2);
  }
  double whole = 0.0;
  for (double& one : size) whole += one = std::sqrt(one);
  Q.setZero();
  if (whole == 0.0) return;
  for (std::size_t i = 0; i < kMostBalls; ++i) {
    if (size[i] == 0.0) continue;
    const double weight = raised(whole / size[i]);
    const double* M = parts.part[i].M;
    for (Eigen::Index k = 0; k < parts.part[i].columns; ++k, M += n_) {
      for (Eigen::Index col = 0; col < n_; ++col) {
        for (Eigen::Index row = 0; row < n_; ++row) Q(row, col) += weight * (M[row] * M[col]);
      }
    }
  }
  if (size[kMostBalls] == 0.0) return;
  for (Eigen::Index row = 0; row < n_; ++row) {
    Q(row, row) += raised(whole / size[kMostBalls]) * std::pow(loss(row), 2);
  }
}

FlownErrors::Shape inverse_with_rounding(const Eigen::MatrixXd& R) {
  const Eigen::MatrixXd X = inverse_of(R);
  return {X, kRoundingOfProduct * static_cast<double>(R.rows()) *
                 (X.cwiseAbs() * R.cwiseAbs() * X.cwiseAbs())};
}

FlownErrors::Shape product_with_rounding(const Eigen::MatrixXd& M, const Eigen::MatrixXd& rounding,
                                         const FlownErrors::Shape& X) {
  const Eigen::MatrixXd size = X.X.cwiseAbs();
  const Eigen::MatrixXd size_of_M = M.cwiseAbs();
  const double product = kRoundingOfProduct * static_cast<double>(M.cols());
  return {M * X.X,
          size_of_M * X.rounding + rounding * (size + X.rounding) + product * (size_of_M * size)};
}

}  // namespace sampled_data_observers

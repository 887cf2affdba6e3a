#include "plant/lipschitz_map.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {
namespace {

LipschitzDescription checked(LipschitzDescription map) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument("LipschitzMap: " + what);
  };
  const Eigen::Index n = map.A.rows();
  require(n > 0 && map.A.cols() == n, "A must be square and not empty");
  require(map.B.rows() == n, "B must have as many rows as A");
  require(map.psi != nullptr, "psi is missing");
  require(map.G.rows() == n && map.G.cols() == map.psi->size(),
          "G must have one row per state and one column per component of psi");
  require(map.S.cols() == n, "S must have as many columns as A");
  require(!map.lipschitz_constant || *map.lipschitz_constant > 0.0,
          "the Lipschitz constant must be positive");
  for (const Eigen::MatrixXd& vertex : map.vertices) {
    require(vertex.rows() == n && vertex.cols() == n, "each vertex must have the shape of A");
  }
  return map;
}

class LipschitzJacobian : public VectorMap {
 public:
  LipschitzJacobian(LipschitzDescription map, std::shared_ptr<const VectorMap> of_psi)
      : map_(std::move(map)),
        of_psi_(std::move(of_psi)),
        argument_(map_.S.rows()),
        slopes_(map_.G.cols() * map_.S.rows()),
        column_(map_.G.cols()) {}

  Eigen::Index size() const override { return map_.A.size(); }
  void evaluate(const double* x, const double* u, double* out) const override {
    argument_.setZero();
    add_product(map_.S, x, argument_.data());
    of_psi_->evaluate(argument_.data(), u, slopes_.data());
    const Eigen::Index n = map_.A.rows();
    for (Eigen::Index j = 0; j < n; ++j) {
      column_.setZero();
      add_product(slopes_.data(), map_.G.cols(), map_.S.rows(), map_.S.data() + j * map_.S.rows(),
                  column_.data());
      for (Eigen::Index i = 0; i < n; ++i) out[j * n + i] = map_.A(i, j);
      add_product(map_.G, column_.data(), out + j * n);
    }
  }

 private:
  LipschitzDescription map_;
  std::shared_ptr<const VectorMap> of_psi_;
  mutable Eigen::VectorXd argument_;  ///< S x
  mutable Eigen::VectorXd slopes_;    ///< of ψ by its arguments
  mutable Eigen::VectorXd column_;
};

}  // namespace

LipschitzMap::LipschitzMap(LipschitzDescription description)
    : description_(checked(std::move(description))),
      argument_(description_.S.rows()),
      psi_(description_.psi->size()) {}

void LipschitzMap::evaluate(const double* x, const double* u, double* out) const {
  argument_.setZero();
  add_product(description_.S, x, argument_.data());
  description_.psi->evaluate(argument_.data(), u, psi_.data());
  for (Eigen::Index i = 0; i < size(); ++i) out[i] = 0.0;
  add_product(description_.A, x, out);
  add_product(description_.B, u, out);
  add_product(description_.G, psi_.data(), out);
}

std::shared_ptr<const VectorMap> LipschitzMap::jacobian() const {
  const std::shared_ptr<const VectorMap> of_psi = description_.psi->jacobian();
  if (of_psi == nullptr) return nullptr;
  return std::make_shared<const LipschitzJacobian>(description_, of_psi);
}

}  // namespace sampled_data_observers

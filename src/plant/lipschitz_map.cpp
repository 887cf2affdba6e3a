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

}  // namespace sampled_data_observers

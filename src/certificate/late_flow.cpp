#include "certificate/late_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "certificate/bound_flow.h"
#include "certificate/flow_growth.h"
#include "certificate/outward.h"
#include "certificate/weighted_norm.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// The flow may grow by so many times more in the second of the norms that are made for it.
constexpr double kFaster = 20.0;
constexpr double kLowest = std::numeric_limits<double>::lowest();

double squared(double value) { return value * value; }

/// A matrix with a bound on the size of what it was summed from, entry by entry.
struct Sized {
  Eigen::MatrixXd value;
  Eigen::MatrixXd size;

  void add(const Eigen::MatrixXd& term, const Eigen::MatrixXd& size_of_term) {
    value += term;
    size += size_of_term;
  }
};

/// Not less than the least c with M <= c P, for a symmetric M.
double quotient_above(const Sized& M, const Eigen::MatrixXd& P) {
  const Eigen::MatrixXd inverse_R = inverse_of(cholesky_root(P));
  const Eigen::MatrixXd scaled = inverse_R.transpose() * M.value * inverse_R;
  const Eigen::MatrixXd size = inverse_R.cwiseAbs().transpose() * M.size * inverse_R.cwiseAbs();
  return max_eigenvalue(scaled) + 1e3 * eigenvalue_rounding(P.rows(), size.norm());
}

/// P F + Fᵀ P + χ ℓ² Sᵀ S + P G Gᵀ P / χ, not less than what (F e + G φ) makes of V. Any χ will do.
Sized flow_of(const ErrorSystem& system, const Eigen::MatrixXd& F, const Eigen::MatrixXd& P) {
  const Eigen::MatrixXd product = P * F;
  const Eigen::MatrixXd size = P.cwiseAbs() * F.cwiseAbs();
  Sized flow{product + product.transpose(), size + size.transpose()};
  const double ell = system.lipschitz_constant;
  if (system.is_linear() || ell == 0.0) return flow;
  const Eigen::MatrixXd P_G = P * system.G;
  const double of_G = (system.G.transpose() * P_G).norm();
  const double of_S = (system.S * inverse_of(P) * system.S.transpose()).norm();
  double chi = std::sqrt(of_G / of_S) / ell;
  if (!std::isfinite(chi) || !(chi > 0.0)) chi = 1.0;
  const Eigen::MatrixXd size_of_P_G = P.cwiseAbs() * system.G.cwiseAbs();
  const Eigen::MatrixXd S = std::sqrt(chi) * ell * system.S;
  flow.add(S.transpose() * S, S.cwiseAbs().transpose() * S.cwiseAbs());
  flow.add(P_G * P_G.transpose() / chi, size_of_P_G * size_of_P_G.transpose() / chi);
  return flow;
}

double push_of(const Eigen::MatrixXd& P, const Eigen::MatrixXd& N, double disturbance) {
  return disturbance > 0.0 ? raised(norm_into(P, N) * disturbance) : 0.0;
}

}  // namespace

LateFlow::LateFlow(const TimerDependentFunction& function, const NamedMatrices& values,
                   const std::vector<Eigen::MatrixXd>& P, double disturbance, double horizon) {
  const ErrorSystem& system = function.system();
  std::vector<Eigen::MatrixXd> F;
  for (const MatrixExpression& flow : system.F) F.push_back(evaluate(flow, values));
  growth_.resize(std::size_t{1} << function.grid().dimensions());
  for (std::size_t late = 1; late < growth_.size(); ++late) {
    growth_[late] = growth_on_face(function, F, P, late, disturbance);
  }
  // Just after all events P is far from singular.
  add_norm(system, F, P, P.front(), disturbance);
  for (const double time : {horizon, horizon / kFaster}) {
    const Eigen::MatrixXd W = flow_growth(F.front(), time).W;
    const Eigen::MatrixXd Q = W.transpose() * W;
    add_norm(system, F, P, (Q + Q.transpose()) / 2.0, disturbance);
  }
}

LateFlow::Growth LateFlow::growth_in(const ErrorSystem& system,
                                     const std::vector<Eigen::MatrixXd>& F,
                                     const Eigen::MatrixXd& Q, double disturbance) {
  Growth growth = {kLowest, push_of(Q, system.N, disturbance)};
  for (const Eigen::MatrixXd& flow : F) {
    growth.rate = std::max(growth.rate, quotient_above(flow_of(system, flow, Q), Q) / 2.0);
  }
  return growth;
}

void LateFlow::add_norm(const ErrorSystem& system, const std::vector<Eigen::MatrixXd>& F,
                        const std::vector<Eigen::MatrixXd>& P, const Eigen::MatrixXd& Q,
                        double disturbance) {
  Norm norm;
  norm.growth = growth_in(system, F, Q, disturbance);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(system.size, system.size);
  for (const Eigen::MatrixXd& P_k : P) {
    norm.into.push_back(raised(squared(norm_between(P_k, Q, identity))));
    norm.out.push_back(raised(squared(norm_between(Q, P_k, identity))));
  }
  norms_.push_back(std::move(norm));
}

/// The largest at the corners of all cells, as far as they lie where these timers are at their end.
LateFlow::Growth LateFlow::growth_on_face(const TimerDependentFunction& function,
                                          const std::vector<Eigen::MatrixXd>& F,
                                          const std::vector<Eigen::MatrixXd>& P, std::size_t late,
                                          double disturbance) {
  const TensorGrid& grid = function.grid();
  Growth growth{kLowest, 0.0};
  for (const std::vector<CellCorner>& corners : cells_of(grid)) {
    for (const CellCorner& corner : corners) {
      bool is_on_face = true;
      for (std::size_t timer = 0; timer < grid.dimensions(); ++timer) {
        const bool is_last = grid.position(corner.node, timer) + 1 == grid.nodes(timer).size();
        is_on_face &= (late >> timer & 1U) == 0 || is_last;
      }
      if (!is_on_face) continue;
      const Eigen::MatrixXd& P_k = P[corner.node];
      growth.push = std::max(growth.push, push_of(P_k, function.system().N, disturbance));
      for (const Eigen::MatrixXd& flow : F) {
        Sized sum = flow_of(function.system(), flow, P_k);
        for (std::size_t timer = 0; timer < grid.dimensions(); ++timer) {
          if ((late >> timer & 1U) != 0) continue;
          const CellCorner::Edge& edge = corner.edges[timer];
          sum.add((P[edge.high] - P[edge.low]) / edge.length,
                  (P[edge.high].cwiseAbs() + P[edge.low].cwiseAbs()) / edge.length);
        }
        growth.rate = std::max(growth.rate, quotient_above(sum, P_k) / 2.0);
      }
    }
  }
  return growth;
}

double LateFlow::flowed(std::size_t late, double root, double duration) const {
  return flowed_linearly(root, growth_[late].rate, growth_[late].push, duration);
}

double LateFlow::flowed_in_Q(const TensorGrid::Interpolation& from, double root, double duration,
                             const TensorGrid::Interpolation& to, double weight_rounding) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Norm& norm : norms_) {
    // P⁻¹ is convex, and P affine, in the weights.
    double into = 0.0;
    double out = 0.0;
    for (std::size_t i = 0; i < from.size; ++i) {
      into += (from.weights[i] + weight_rounding) * norm.into[from.vertices[i]];
      out += (to.weights[i] + weight_rounding) * norm.out[to.vertices[i]];
    }
    const double flowed =
        flowed_linearly(std::sqrt(into) * root, norm.growth.rate, norm.growth.push, duration);
    least = std::min(least, std::sqrt(out) * flowed);
  }
  return least;
}

}  // namespace sampled_data_observers

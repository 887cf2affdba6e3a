#include "observer/observable_form.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// A row counts as a combination of others when less than this part of it is orthogonal to them.
constexpr double kIndependent = 1e-9;

/// How far 𝐀 − 𝐊 𝐇 may be missed, relative to its size.
constexpr double kAccuracy = 1e-6;

/// Orthonormal rows that span those added so far.
class RowSpace {
 public:
  explicit RowSpace(Eigen::Index n) : basis_(0, n) {}

  /// Adds a row, unless it depends on those before it.
  bool add(const Eigen::RowVectorXd& row) {
    const double norm = row.norm();
    if (!(norm > 0.0) || !std::isfinite(norm)) return false;
    Eigen::RowVectorXd rest = row / norm;
    // Twice is enough: the second pass removes what rounding left of the first.
    for (int pass = 0; pass < 2; ++pass) rest -= (rest * basis_.transpose()) * basis_;
    if (rest.norm() < kIndependent) return false;
    basis_.conservativeResize(basis_.rows() + 1, Eigen::NoChange);
    basis_.bottomRows(1) = rest / rest.norm();
    return true;
  }

  Eigen::Index dimension() const { return basis_.rows(); }

 private:
  Eigen::MatrixXd basis_;
};

std::vector<Eigen::Index> observability_indices(const Eigen::MatrixXd& A,
                                                const Eigen::MatrixXd& H) {
  const Eigen::Index n = A.rows();
  const Eigen::Index m = H.rows();
  RowSpace space(n);
  std::vector<Eigen::Index> indices(static_cast<std::size_t>(m), 0);
  Eigen::MatrixXd rows = H;
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index j = 0; j < m; ++j) {
      Eigen::Index& index = indices[static_cast<std::size_t>(j)];
      // Once a row depends on those before it, all later ones of its output do.
      if (index == k && space.add(rows.row(j))) ++index;
    }
    rows = (rows * A).eval();
  }
  if (space.dimension() < n) {
    throw std::invalid_argument(
        "the pair of A and the continuous outputs is not observable: they tell " +
        std::to_string(space.dimension()) + " of " + std::to_string(n) + " states");
  }
  for (Eigen::Index j = 0; j < m; ++j) {
    if (indices[static_cast<std::size_t>(j)] == 0) {
      throw std::invalid_argument("continuous output " + std::to_string(j + 1) +
                                  " is a combination of the others and adds nothing");
    }
  }
  return indices;
}

/// blkdiag(A_i) − blkdiag(K_i) blkdiag(H_i)
Eigen::MatrixXd closed_loop(const std::vector<Eigen::Index>& indices,
                            const std::vector<Eigen::VectorXd>& K) {
  const Eigen::Index n = std::accumulate(indices.begin(), indices.end(), Eigen::Index{0});
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const Eigen::Index d = indices[i];
    for (Eigen::Index k = 0; k + 1 < d; ++k) result(first + k + 1, first + k) = 1.0;
    result.block(first, first + d - 1, d, 1) -= K[i];
    first += d;
  }
  return result;
}

}  // namespace

ObservableForm observable_form(const Eigen::MatrixXd& A, const Eigen::MatrixXd& H) {
  const Eigen::Index n = A.rows();
  const Eigen::Index m = H.rows();
  ObservableForm form;
  form.indices = observability_indices(A, H);
  Eigen::MatrixXd selected(n, n);
  Eigen::Index row = 0;
  for (Eigen::Index j = 0; j < m; ++j) {
    Eigen::RowVectorXd h = H.row(j);
    for (Eigen::Index k = 0; k < form.indices[static_cast<std::size_t>(j)]; ++k, ++row) {
      selected.row(row) = h;
      h = (h * A).eval();
    }
  }
  const Eigen::MatrixXd inverse = inverse_of(selected);
  form.basis.resize(n, n);
  Eigen::MatrixXd last(n, m);  // A^(d_i) w_i = 𝒱⁻¹ 𝐃_i
  form.M.resize(m, m);
  Eigen::Index end = 0;
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index d = form.indices[static_cast<std::size_t>(i)];
    end += d;
    Eigen::VectorXd column = inverse.col(end - 1);
    for (Eigen::Index k = 0; k < d; ++k) {
      form.basis.col(end - d + k) = column;
      column = (A * column).eval();
    }
    last.col(i) = column;
    form.M.col(i) = H * form.basis.col(end - 1);
  }
  form.D = solve_linear(form.basis, last);
  return form;
}

Eigen::MatrixXd high_gain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& H,
                          const ObservableForm& form, double ell,
                          const std::vector<Eigen::VectorXd>& K) {
  const Eigen::Index n = A.rows();
  const Eigen::Index m = H.rows();
  if (!(ell > 0.0) || !std::isfinite(ell)) throw std::invalid_argument("ell must be positive");
  if (static_cast<Eigen::Index>(K.size()) != m) {
    throw std::invalid_argument("K: one list per continuous output, " + std::to_string(m) +
                                " of them");
  }
  Eigen::MatrixXd in_form = form.D;
  Eigen::VectorXd powers(n);  // 𝓛(ℓ)
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < K.size(); ++i) {
    const Eigen::Index d = form.indices[i];
    const std::string name = "K of continuous output " + std::to_string(i + 1);
    if (K[i].size() != d) {
      throw std::invalid_argument(name + ": " + std::to_string(d) +
                                  " numbers, as many as its observability index");
    }
    if (!is_hurwitz(K[i].reverse())) {
      throw std::invalid_argument(name + ": A_i - K_i H_i is not Hurwitz");
    }
    for (Eigen::Index k = 0; k < d; ++k) {
      powers(first + k) = std::pow(ell, static_cast<double>(d - 1 - k));
      in_form(first + k, static_cast<Eigen::Index>(i)) += ell * powers(first + k) * K[i](k);
    }
    first += d;
  }
  Eigen::MatrixXd L_c = form.basis * in_form * inverse_of(form.M);

  // ℓ (𝐀 − 𝐊 𝐇) = 𝓛⁻¹ 𝒱 (A − L_c H) 𝒱⁻¹ 𝓛, which has the eigenvalues of A − L_c H.
  const Eigen::MatrixXd scaled_basis = form.basis * powers.asDiagonal();
  const Eigen::MatrixXd found = solve_linear(scaled_basis, (A - L_c * H) * scaled_basis) / ell;
  const Eigen::MatrixXd wanted = closed_loop(form.indices, K);
  if (!((found - wanted).norm() <= kAccuracy * wanted.norm())) {
    throw std::invalid_argument(
        "the eigenvalues of A - L_c H can not be placed to six digits: the pair of A and the "
        "continuous outputs is almost unobservable, or ell is too large");
  }
  return L_c;
}

Eigen::VectorXd scaled_gain(double ell, const Eigen::VectorXd& K) {
  if (!(ell > 0.0 && std::isfinite(ell))) throw std::invalid_argument("ell must be positive");
  if (K.size() == 0 || !is_hurwitz(K)) {
    throw std::invalid_argument("K: A - K H is not Hurwitz");
  }
  Eigen::VectorXd result = K;
  for (Eigen::Index i = 0; i < K.size(); ++i) {
    result(i) *= std::pow(ell, static_cast<double>(i + 1));
  }
  return result;
}

bool is_hurwitz(const Eigen::VectorXd& c) {
  if (!c.allFinite()) return false;
  const Eigen::Index d = c.size();
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(d, d);
  companion.col(0) = -c;
  for (Eigen::Index i = 0; i + 1 < d; ++i) companion(i, i + 1) = 1.0;
  const Eigen::VectorXcd zeros = eigenvalues_of(companion);
  return zeros.real().maxCoeff() < -1e-12 * zeros.cwiseAbs().maxCoeff();
}

}  // namespace sampled_data_observers

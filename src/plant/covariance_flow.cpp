#include "plant/covariance_flow.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "linear_algebra/digit_tables.h"
#include "linear_algebra/kernels.h"
#include "linear_algebra/shared_tables.h"
#include "linear_algebra/transition_matrix.h"

namespace sampled_data_observers {
namespace {

/// Φ and Q_Δ of one duration.
struct CovarianceStep {
  Transition transition;
  ExtendedMatrix noise;

  bool is_finite() const { return transition.is_finite() && noise.cast<double>().allFinite(); }
};

CovarianceStep compose(const CovarianceStep& first, const CovarianceStep& second) {
  const ExtendedMatrix& Phi = second.transition.full;
  const ExtendedMatrix noise = product(product(Phi, first.noise), Phi.transpose()) + second.noise;
  return {compose(first.transition, second.transition), (noise + noise.transpose()) / 2.0L};
}

/// The step over one unit of the time in which A and Q are given.
CovarianceStep unit_step(const ExtendedMatrix& A, const ExtendedMatrix& Q) {
  // Q_h is the sum of D^k(Q) h^{k+1} / (k + 1)! with D(X) = A X + X Aᵀ: at |A| h <= 1/4 the
  // remainder after 20 terms is below 1e-25, relative to Q h.
  constexpr int kTerms = 20;
  const int doublings = doublings_for(A);
  const long double h = std::ldexp(1.0L, -doublings);
  const ExtendedMatrix transposed = A.transpose();
  ExtendedMatrix term = Q * h;
  ExtendedMatrix sum = term;
  for (int k = 2; k <= kTerms; ++k) {
    term = (product(A, term) + product(term, transposed)) * (h / static_cast<long double>(k));
    sum += term;
  }
  return doubled(CovarianceStep{exponential(A * h), sum}, doublings);
}

/// Where e^{At} may differ from zero: where there is a path from one state to another.
std::vector<std::vector<bool>> paths_of(const Eigen::MatrixXd& A) {
  const auto n = static_cast<std::size_t>(A.rows());
  std::vector<std::vector<bool>> path(n, std::vector<bool>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      path[i][j] = i == j || A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) != 0.0;
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; path[i][k] && j < n; ++j) {
        if (path[k][j]) path[i][j] = true;
      }
    }
  }
  return path;
}

}  // namespace

CovarianceFlow::CovarianceFlow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q)
    : states_(A.rows()) {
  if (A.rows() == 0 || A.rows() != A.cols()) {
    throw std::invalid_argument("CovarianceFlow: A must be square and not empty");
  }
  if (Q.rows() != A.rows() || Q.cols() != A.cols()) {
    throw std::invalid_argument("CovarianceFlow: Q must have the size of A");
  }
  if (!A.allFinite() || !Q.allFinite()) {
    throw std::invalid_argument("CovarianceFlow: A and Q must be finite");
  }
  const ExtendedMatrix zero = ExtendedMatrix::Zero(states_, states_);
  const auto unit = [&](long double scale) {
    const long double seconds = 1e-9L * scale;
    return unit_step(A.cast<long double>() * seconds, Q.cast<long double>() * seconds);
  };
  const auto doublings = [&](long double scale) {
    return doublings_for(A.cast<long double>() * (1e-9L * scale));
  };
  const Eigen::Index rows = padded(states_);
  row_begins_ = {0};
  for (const std::vector<bool>& row : paths_of(A)) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (row[j])
        offsets_.push_back(static_cast<std::int32_t>(j) * static_cast<std::int32_t>(rows));
    }
    row_begins_.push_back(static_cast<std::int32_t>(offsets_.size()));
  }
  const auto write = [&](const CovarianceStep& step, double* block) {
    for (Eigen::Index i = 0; i < states_; ++i) {
      for (auto k = row_begins_[static_cast<std::size_t>(i)];
           k < row_begins_[static_cast<std::size_t>(i) + 1]; ++k) {
        const Eigen::Index column = offsets_[static_cast<std::size_t>(k)] / rows;
        *block++ = static_cast<double>(step.transition.full(i, column));
      }
    }
    for (Eigen::Index j = 0; j < states_; ++j) {
      const Eigen::Index top = first_row_of_lower(j);
      for (Eigen::Index i = top; i < states_; ++i) {
        // No zero of it is negative: kernels rely on that.
        block[lower_column(states_, j) + i - top] = static_cast<double>(step.noise(i, j)) + 0.0;
      }
    }
  };
  std::vector<double> key = {kCovarianceTables, static_cast<double>(states_)};
  key.insert(key.end(), A.data(), A.data() + A.size());
  key.insert(key.end(), Q.data(), Q.data() + Q.size());
  tables_ = shared_tables(std::move(key), [&] {
    return digit_tables(block(), CovarianceStep{Transition(zero), zero}, unit, doublings, write);
  });
}

Eigen::Index CovarianceFlow::scratch_size(Eigen::Index n) { return covariance_scratch(n); }

std::size_t CovarianceFlow::block() const {
  return offsets_.size() + static_cast<std::size_t>(lower_column(states_, states_));
}

void CovarianceFlow::apply(Duration duration, double* P, double* scratch) const {
  DigitBlocks blocks;
  if (!find_digits(duration, *tables_, block(), blocks)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index i = 0; i < states_ * states_; ++i) P[i] = nan;
  } else if (blocks.count > 0) {
    kernels().covariance_flow(blocks.of, blocks.count, {row_begins_.data(), offsets_.data()},
                              states_, P, scratch);
  }
}

}  // namespace sampled_data_observers

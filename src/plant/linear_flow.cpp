#include "sampled_data_observers/plant/linear_flow.h"

#include <stdexcept>
#include <utility>

#include "linear_algebra/digit_tables.h"
#include "linear_algebra/transition_matrix.h"
#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {
namespace {

/// The transition of (x, u, 1), of which the rows of x are wanted.
struct AffineStep : Transition {
  AffineStep(Transition transition, Eigen::Index states)
      : Transition(std::move(transition)), states(states) {}

  void write(double* table) const {
    Eigen::Map<Eigen::MatrixXd>(table, states, full.cols()) = full.topRows(states).cast<double>();
  }

  Eigen::Index states;
};

AffineStep compose(const AffineStep& first, const AffineStep& second) {
  return {compose(static_cast<const Transition&>(first), second), first.states};
}

}  // namespace

LinearFlow::LinearFlow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::VectorXd& c)
    : states_(A.rows()), inputs_(B.cols()), has_constant_(c.size() > 0) {
  if (A.rows() == 0 || A.rows() != A.cols()) {
    throw std::invalid_argument("LinearFlow: A must be square and not empty");
  }
  if (B.rows() != A.rows()) {
    throw std::invalid_argument("LinearFlow: B must have as many rows as A");
  }
  if (has_constant_ && c.size() != A.rows()) {
    throw std::invalid_argument("LinearFlow: c must have as many rows as A");
  }
  if (!A.allFinite() || !B.allFinite()) {
    throw std::invalid_argument("LinearFlow: A and B must be finite");
  }
  if (!c.allFinite()) throw std::invalid_argument("LinearFlow: c must be finite");
  const Eigen::Index columns = states_ + inputs_ + (has_constant_ ? 1 : 0);
  ExtendedMatrix generator = ExtendedMatrix::Zero(columns, columns);
  generator.topLeftCorner(states_, states_) = A.cast<long double>();
  generator.block(0, states_, states_, inputs_) = B.cast<long double>();
  if (has_constant_) generator.topRightCorner(states_, 1) = c.cast<long double>();
  generator *= 1e-9L;
  const AffineStep none(Transition(ExtendedMatrix::Zero(columns, columns)), states_);
  const auto unit = [&](long double scale) {
    return AffineStep(exponential(generator * scale), states_);
  };
  tables_ = digit_tables(static_cast<std::size_t>(states_ * columns), none, unit);
}

void LinearFlow::apply(Duration duration, double* x, const double* u, double* scratch) const {
  const Eigen::Index columns = states_ + inputs_ + (has_constant_ ? 1 : 0);
  const auto block = static_cast<std::size_t>(states_ * columns);
  for_each_digit(duration, tables_, block, [&](const double* M) {
    // Loops, not fill_n and copy_n: these call the C library, which takes longer than the product.
    for (Eigen::Index i = 0; i < states_; ++i) scratch[i] = 0.0;
    add_product(M, states_, states_, x, scratch);
    add_product(M + states_ * states_, states_, inputs_, u, scratch);
    if (has_constant_) {
      const double* gamma = M + states_ * (states_ + inputs_);
      for (Eigen::Index i = 0; i < states_; ++i) scratch[i] += gamma[i];
    }
    for (Eigen::Index i = 0; i < states_; ++i) x[i] = scratch[i];
  });
}

void LinearFlow::transition(Duration duration, double* E, double* scratch) const {
  for (Eigen::Index j = 0; j < states_; ++j, E += states_) {
    for (Eigen::Index i = 0; i < states_; ++i) E[i] = i == j ? 1.0 : 0.0;
    apply(duration, E, nullptr, scratch);
  }
}

}  // namespace sampled_data_observers

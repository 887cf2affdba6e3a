#include "sampled_data_observers/plant/linear_flow.h"

#include <limits>
#include <stdexcept>
#include <utility>

#include "linear_algebra/digit_tables.h"
#include "linear_algebra/kernels.h"
#include "linear_algebra/shared_tables.h"
#include "linear_algebra/transition_matrix.h"

namespace sampled_data_observers {
namespace {

ExtendedMatrix generator_of(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                            const Eigen::VectorXd& c) {
  const Eigen::Index n = A.rows();
  const Eigen::Index columns = n + B.cols() + (c.size() > 0 ? 1 : 0);
  ExtendedMatrix generator = ExtendedMatrix::Zero(columns, columns);
  generator.topLeftCorner(n, n) = A.cast<long double>();
  generator.block(0, n, n, B.cols()) = B.cast<long double>();
  if (c.size() > 0) generator.topRightCorner(n, 1) = c.cast<long double>();
  return generator * 1e-9L;
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
  const ExtendedMatrix generator = generator_of(A, B, c);
  const Eigen::Index columns = generator.cols();
  const Eigen::Index rows = padded(states_);
  const auto unit = [&](long double scale) { return exponential(generator * scale); };
  const auto doublings = [&](long double scale) { return doublings_for(generator * scale); };
  // Of the transition of (x, u, 1) the rows of x are wanted.
  const auto write = [&](const Transition& step, double* block) {
    Eigen::Map<Eigen::MatrixXd>(block, rows, columns).topRows(states_) =
        step.full.topRows(states_).cast<double>();
  };
  std::vector<double> key = {kLinearTables, static_cast<double>(states_),
                             static_cast<double>(inputs_)};
  key.insert(key.end(), A.data(), A.data() + A.size());
  key.insert(key.end(), B.data(), B.data() + B.size());
  key.insert(key.end(), c.data(), c.data() + c.size());
  tables_ = shared_tables(std::move(key), [&] {
    return digit_tables(static_cast<std::size_t>(rows * columns),
                        Transition(ExtendedMatrix::Zero(columns, columns)), unit, doublings, write);
  });
}

void LinearFlow::apply(Duration duration, double* x, const double* u, double* scratch) const {
  const Eigen::Index columns = states_ + inputs_ + (has_constant_ ? 1 : 0);
  DigitBlocks blocks;
  if (!find_digits(duration, *tables_, static_cast<std::size_t>(padded(states_) * columns),
                   blocks)) {
    for (Eigen::Index i = 0; i < states_; ++i) x[i] = std::numeric_limits<double>::quiet_NaN();
  } else if (blocks.count > 0) {
    const Kernels::LinearFlow flow = kernels().linear_flow[states_ <= kPanelRows ? states_ : 0];
    flow(blocks.of, blocks.count, {states_, inputs_, has_constant_}, u, x, scratch);
  }
}

void LinearFlow::transition(Duration duration, double* E, double* scratch) const {
  for (Eigen::Index j = 0; j < states_; ++j, E += states_) {
    for (Eigen::Index i = 0; i < states_; ++i) E[i] = i == j ? 1.0 : 0.0;
    apply(duration, E, nullptr, scratch);
  }
}

}  // namespace sampled_data_observers

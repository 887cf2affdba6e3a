#include "design/log_balance.h"

#include <cmath>
#include <vector>

namespace sampled_data_observers {
namespace {

constexpr int kSweeps = 500;

/// Of unknown logarithms u: u[col] − u[row] + logarithm should be 0.
struct Equation {
  std::size_t row = 0;
  std::size_t col = 0;
  double logarithm = 0.0;
};

/// @param first  of the unknowns of the rows; those of the columns are the first of all
void add_entries(const Eigen::MatrixXd& a, std::size_t first, std::vector<Equation>& equations) {
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      const auto row = first + static_cast<std::size_t>(i);
      const auto col = static_cast<std::size_t>(j);
      if (row == col || a(i, j) == 0.0) continue;
      equations.push_back({row, col, std::log(std::abs(a(i, j)))});
    }
  }
}

/// One unknown after the other is chosen best for the others as they are.
std::vector<double> least_squares(const std::vector<Equation>& equations, std::size_t unknowns) {
  std::vector<double> u(unknowns, 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t k = 0; k < unknowns; ++k) {
      double sum = 0.0;
      int count = 0;
      for (const Equation& equation : equations) {
        if (equation.col == k) sum += u[equation.row] - equation.logarithm;
        if (equation.row == k) sum += u[equation.col] + equation.logarithm;
        if (equation.col == k || equation.row == k) ++count;
      }
      if (count > 0) u[k] = sum / count;
    }
  }
  return u;
}

}  // namespace

void balance_logarithms(const CertificateSubject& subject, PlantScaling& scaling) {
  std::vector<Equation> equations;
  const auto n = static_cast<std::size_t>(subject.plant.states());
  std::size_t unknowns = n;
  std::vector<Eigen::VectorXd*> units = {&scaling.state, &scaling.output,
                                         &scaling.continuous_output, &scaling.jump_output};
  for (const ModeMatrices& mode : subject.plant.modes) {
    add_entries(mode.A * time_scale(subject), 0, equations);
    if (mode.A_d) add_entries(*mode.A_d, 0, equations);
    unknowns = n;
    for (const Eigen::MatrixXd* C : {&mode.C, &mode.C_c, &mode.C_d}) {
      add_entries(*C, unknowns, equations);
      unknowns += static_cast<std::size_t>(C->rows());
    }
  }
  const std::vector<double> u = least_squares(equations, unknowns);
  std::size_t next = 0;
  for (Eigen::VectorXd* unit : units) {
    for (Eigen::Index i = 0; i < unit->size(); ++i) (*unit)(i) = std::exp(u[next++]);
  }
}

}  // namespace sampled_data_observers

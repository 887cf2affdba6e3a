#include "design/sdp_data.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sampled_data_observers {
namespace {

SdpBlock sdp_block(const AffineMatrix& matrix) {
  SdpBlock block;
  block.constant = (matrix.constant + matrix.constant.transpose()) / 2.0;
  std::vector<AffineMatrix::Term> terms = matrix.terms;
  for (AffineMatrix::Term& term : terms) {
    if (term.row > term.col) std::swap(term.row, term.col);
    // Off the diagonal, both triangles are averaged.
    if (term.row != term.col) term.coefficient /= 2.0;
  }
  const auto place = [](const AffineMatrix::Term& term) {
    return std::make_tuple(term.variable, term.row, term.col);
  };
  // Stable: equal programs have equal sums.
  std::stable_sort(terms.begin(), terms.end(),
                   [&](const AffineMatrix::Term& a, const AffineMatrix::Term& b) {
                     return place(a) < place(b);
                   });
  for (std::size_t i = 0; i < terms.size();) {
    double value = 0.0;
    std::size_t next = i;
    for (; next < terms.size() && place(terms[next]) == place(terms[i]); ++next) {
      value += terms[next].coefficient;
    }
    const AffineMatrix::Term& term = terms[i];
    i = next;
    if (value == 0.0) continue;
    if (block.variables.empty() || block.variables.back() != term.variable) {
      block.variables.push_back(term.variable);
      block.first.push_back(block.entries.size());
    }
    block.entries.push_back({term.row, term.col, value});
  }
  block.first.push_back(block.entries.size());
  return block;
}

}  // namespace

void SdpBlock::add_combination(const Eigen::VectorXd& x, Eigen::MatrixXd& sum) const {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const double factor = x(variables[i]);
    if (factor == 0.0) continue;
    for (std::size_t e = first[i]; e < first[i + 1]; ++e) {
      const Entry& entry = entries[e];
      sum(entry.row, entry.col) += factor * entry.value;
      if (entry.row != entry.col) sum(entry.col, entry.row) += factor * entry.value;
    }
  }
}

double SdpBlock::inner_product(std::size_t i, const Eigen::MatrixXd& U) const {
  double sum = 0.0;
  for (std::size_t e = first[i]; e < first[i + 1]; ++e) {
    const Entry& entry = entries[e];
    sum += entry.row == entry.col
               ? entry.value * U(entry.row, entry.row)
               : entry.value * (U(entry.row, entry.col) + U(entry.col, entry.row));
  }
  return sum;
}

void SdpBlock::add_inner_products(const Eigen::MatrixXd& U, Eigen::VectorXd& sum) const {
  for (std::size_t i = 0; i < variables.size(); ++i) sum(variables[i]) += inner_product(i, U);
}

SdpData::SdpData(const StandardForm& form)
    : objective(Eigen::Map<const Eigen::VectorXd>(
          form.objective.data(), static_cast<Eigen::Index>(form.objective.size()))) {
  for (const AffineMatrix& matrix : form.blocks) blocks.push_back(sdp_block(matrix));
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(objective.size());
  for (const SdpBlock& block : blocks) {
    for (std::size_t i = 0; i < block.variables.size(); ++i) {
      for (std::size_t e = block.first[i]; e < block.first[i + 1]; ++e) {
        const SdpBlock::Entry& entry = block.entries[e];
        squares(block.variables[i]) +=
            (entry.row == entry.col ? 1.0 : 2.0) * entry.value * entry.value;
      }
    }
  }
  units = squares.unaryExpr([](double square) {
    const double unit = 1.0 / std::sqrt(square);
    return std::isfinite(unit) && unit > 0.0 ? unit : 1.0;
  });
  for (SdpBlock& block : blocks) {
    for (std::size_t i = 0; i < block.variables.size(); ++i) {
      for (std::size_t e = block.first[i]; e < block.first[i + 1]; ++e) {
        block.entries[e].value *= units(block.variables[i]);
      }
    }
  }
  objective = objective.cwiseProduct(units);
  const double largest = objective.size() > 0 ? objective.cwiseAbs().maxCoeff() : 0.0;
  if (std::isfinite(largest) && largest > 0.0) objective_unit = largest;
  objective /= objective_unit;
}

}  // namespace sampled_data_observers

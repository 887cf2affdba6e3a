#include "design/schur_block.h"

#include <algorithm>
#include <map>

namespace sampled_data_observers {

SchurBlock::SchurBlock(const SdpBlock& block, std::vector<Eigen::Index> places)
    : block_(block), places_(std::move(places)) {
  const std::size_t count = block.variables.size();
  std::map<SparseVector, Eigen::Index> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    first_.push_back(terms_.size());
    add_terms(i, numbers);
    order_.push_back(i);
  }
  first_.push_back(terms_.size());
  const auto terms = [&](std::size_t i) { return first_[i + 1] - first_[i]; };
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return terms(a) > terms(b); });
  // In multiplications, about.
  const auto n = static_cast<std::size_t>(block.size());
  std::size_t terms_left = terms_.size();
  std::size_t entries_left = block.entries.size();
  for (const std::size_t i : order_) {
    const std::size_t entries = block.first[i + 1] - block.first[i];
    const std::size_t touched = std::min(n, 2 * entries);
    is_multiplied_out_.push_back(n * n * (touched + 1) + n * entries + 3 * entries_left <
                                 10 * terms(i) * terms_left);
    if (!is_multiplied_out_.back()) needs_products_ = true;
    terms_left -= terms(i);
    entries_left -= entries;
  }
}

/// Takes the row with the most entries out, until none is left.
void SchurBlock::add_terms(std::size_t i, std::map<SparseVector, Eigen::Index>& numbers) {
  std::vector<SdpBlock::Entry> left(
      block_.entries.begin() + static_cast<std::ptrdiff_t>(block_.first[i]),
      block_.entries.begin() + static_cast<std::ptrdiff_t>(block_.first[i + 1]));
  std::vector<int> count(static_cast<std::size_t>(block_.size()), 0);
  while (!left.empty()) {
    std::fill(count.begin(), count.end(), 0);
    for (const SdpBlock::Entry& entry : left) {
      ++count[static_cast<std::size_t>(entry.row)];
      if (entry.row != entry.col) ++count[static_cast<std::size_t>(entry.col)];
    }
    const Eigen::Index u = std::max_element(count.begin(), count.end()) - count.begin();
    SparseVector v;
    const auto rest = std::stable_partition(
        left.begin(), left.end(),
        [u](const SdpBlock::Entry& entry) { return entry.row != u && entry.col != u; });
    for (auto entry = rest; entry != left.end(); ++entry) {
      const bool is_diagonal = entry->row == entry->col;
      v.emplace_back(entry->row == u ? entry->col : entry->row,
                     is_diagonal ? entry->value / 2.0 : entry->value);
    }
    left.erase(rest, left.end());
    std::sort(v.begin(), v.end());
    const double size = v.front().second;
    for (auto& part : v) part.second /= size;
    Eigen::Index number = v.front().first;
    if (v.size() > 1) {
      const auto next = block_.size() + static_cast<Eigen::Index>(vectors_.size());
      const auto [found, is_new] = numbers.emplace(v, next);
      if (is_new) vectors_.push_back(std::move(v));
      number = found->second;
    }
    terms_.push_back({u, number, size});
  }
}

/// uᵀ matrix v of all vectors u and v.
Eigen::MatrixXd SchurBlock::products(const Eigen::MatrixXd& matrix) const {
  const Eigen::Index n = block_.size();
  const auto others = static_cast<Eigen::Index>(vectors_.size());
  Eigen::MatrixXd all(n + others, n + others);
  all.topLeftCorner(n, n) = matrix;
  for (Eigen::Index j = 0; j < others; ++j) {
    auto column = all.col(n + j);
    column.setZero();
    for (const auto& [row, value] : vectors_[static_cast<std::size_t>(j)]) {
      column.head(n) += value * matrix.col(row);
    }
    all.row(n + j).head(n) = column.head(n).transpose();
  }
  for (Eigen::Index j = 0; j < others; ++j) {
    auto column = all.col(n + j).tail(others);
    for (const auto& [row, value] : vectors_[static_cast<std::size_t>(j)]) {
      column += value * all.col(row).tail(others);
    }
  }
  return all;
}

/// Z F_j S⁻¹ of variables[i].
void SchurBlock::multiply_out(std::size_t i, const Eigen::MatrixXd& S_inverse,
                              const Eigen::MatrixXd& Z, Eigen::MatrixXd& Z_F,
                              Eigen::MatrixXd& U) const {
  Z_F.setZero();
  for (std::size_t e = block_.first[i]; e < block_.first[i + 1]; ++e) {
    const SdpBlock::Entry& entry = block_.entries[e];
    Z_F.col(entry.col) += entry.value * Z.col(entry.row);
    if (entry.row != entry.col) Z_F.col(entry.row) += entry.value * Z.col(entry.col);
  }
  U.noalias() = Z_F * S_inverse;
}

Eigen::MatrixXd SchurBlock::matrix(const Eigen::MatrixXd& S_inverse,
                                   const Eigen::MatrixXd& Z) const {
  const std::size_t count = block_.variables.size();
  Eigen::MatrixXd result(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  Eigen::MatrixXd Zs;
  Eigen::MatrixXd Ss;
  if (needs_products_) {
    Zs = products(Z);
    Ss = products(S_inverse);
  }
  Eigen::MatrixXd Z_F(block_.size(), block_.size());
  Eigen::MatrixXd U(block_.size(), block_.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t j = order_[i];
    if (is_multiplied_out_[i]) multiply_out(j, S_inverse, Z, Z_F, U);
    for (std::size_t next = i; next < count; ++next) {
      const std::size_t k = order_[next];
      double sum = 0.0;
      if (is_multiplied_out_[i]) {
        sum = block_.inner_product(k, U);
      } else {
        for (std::size_t s = first_[j]; s < first_[j + 1]; ++s) {
          const Term& a = terms_[s];
          for (std::size_t t = first_[k]; t < first_[k + 1]; ++t) {
            const Term& b = terms_[t];
            sum += a.coefficient * b.coefficient *
                   (Zs(b.v, a.u) * Ss(b.u, a.v) + Zs(b.v, a.v) * Ss(b.u, a.u) +
                    Zs(b.u, a.u) * Ss(b.v, a.v) + Zs(b.u, a.v) * Ss(b.v, a.u));
          }
        }
      }
      result(places_[k], places_[j]) = sum;
      result(places_[j], places_[k]) = sum;
    }
  }
  return result;
}

}  // namespace sampled_data_observers

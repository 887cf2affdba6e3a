#include "design/schur_complement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "design/elimination_order.h"

namespace sampled_data_observers {
namespace {

/// Added to the unit diagonal of the scaled matrix, at first and at last.
constexpr double kLeastShift = 1e-15;
constexpr double kLargestShift = 1e-7;
constexpr int kRefinements = 3;

}  // namespace

Eigen::Index SchurComplement::Panel::row_of(std::size_t group) const {
  const auto found = std::lower_bound(groups.begin(), groups.end(), group);
  return rows[static_cast<std::size_t>(found - groups.begin())];
}

SchurComplement::SchurComplement(const SdpData& data) {
  make_groups(data);
  make_panels(eliminate(data));
}

void SchurComplement::make_groups(const SdpData& data) {
  const auto count = static_cast<std::size_t>(data.objective.size());
  std::vector<std::vector<std::size_t>> blocks_of(count);
  for (std::size_t b = 0; b < data.blocks.size(); ++b) {
    for (const Eigen::Index k : data.blocks[b].variables) {
      blocks_of[static_cast<std::size_t>(k)].push_back(b);
    }
  }
  std::map<std::vector<std::size_t>, std::size_t> group_of;
  for (std::size_t k = 0; k < count; ++k) {
    const auto [found, is_new] = group_of.emplace(blocks_of[k], groups_.size());
    if (is_new) groups_.emplace_back();
    groups_[found->second].variables.push_back(static_cast<Eigen::Index>(k));
  }
}

/// Puts the groups in order.
/// @return  for each group the later ones that its rows reach
std::vector<std::vector<std::size_t>> SchurComplement::eliminate(const SdpData& data) {
  std::vector<std::size_t> group_of(static_cast<std::size_t>(data.objective.size()));
  std::vector<Eigen::Index> sizes;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    sizes.push_back(groups_[g].size());
    for (const Eigen::Index k : groups_[g].variables) group_of[static_cast<std::size_t>(k)] = g;
  }
  std::vector<std::vector<std::size_t>> cliques;
  for (const SdpBlock& block : data.blocks) {
    std::vector<std::size_t> clique;
    for (const Eigen::Index k : block.variables) {
      clique.push_back(group_of[static_cast<std::size_t>(k)]);
    }
    std::sort(clique.begin(), clique.end());
    clique.erase(std::unique(clique.begin(), clique.end()), clique.end());
    cliques.push_back(std::move(clique));
  }
  EliminationOrder order = elimination_order(sizes, cliques);
  std::vector<Group> ordered;
  std::vector<std::size_t> position(groups_.size());
  place_.resize(group_of.size());
  Eigen::Index begin = 0;
  for (const std::size_t g : order.order) {
    position[g] = ordered.size();
    ordered.push_back(std::move(groups_[g]));
    ordered.back().begin = begin;
    for (const Eigen::Index k : ordered.back().variables) {
      place_[static_cast<std::size_t>(k)] = begin++;
    }
  }
  groups_ = std::move(ordered);
  for (std::size_t b = 0; b < cliques.size(); ++b) {
    std::vector<std::size_t>& clique = cliques[b];
    for (std::size_t& g : clique) g = position[g];
    std::sort(clique.begin(), clique.end());
    std::map<Eigen::Index, Eigen::Index> local;
    for (const std::size_t g : clique) {
      for (const Eigen::Index k : groups_[g].variables) {
        local.emplace(k, static_cast<Eigen::Index>(local.size()));
      }
    }
    std::vector<Eigen::Index> places;
    for (const Eigen::Index k : data.blocks[b].variables) places.push_back(local.at(k));
    blocks_.emplace_back(data.blocks[b], std::move(places));
  }
  groups_of_block_ = std::move(cliques);
  return order.later;
}

void SchurComplement::make_panels(const std::vector<std::vector<std::size_t>>& later) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    // With the group before it, where that adds no entries.
    const bool continues = g > 0 && !later[g - 1].empty() && later[g - 1].front() == g &&
                           later[g - 1].size() == later[g].size() + 1;
    if (!continues) {
      panels_.emplace_back();
      panels_.back().begin = groups_[g].begin;
    }
    Panel& panel = panels_.back();
    groups_[g].panel = panels_.size() - 1;
    groups_[g].column = panel.columns;
    panel.columns += groups_[g].size();
    if (continues) continue;
    panel.groups = {g};
    panel.groups.insert(panel.groups.end(), later[g].begin(), later[g].end());
  }
  for (Panel& panel : panels_) {
    Eigen::Index row = 0;
    for (const std::size_t g : panel.groups) {
      panel.rows.push_back(row);
      row += groups_[g].size();
    }
    panel.matrix = Eigen::MatrixXd::Zero(row, panel.columns);
  }
}

void SchurComplement::set_zero() {
  for (Panel& panel : panels_) panel.matrix.setZero();
}

void SchurComplement::add_block(std::size_t block, const Eigen::MatrixXd& S_inverse,
                                const Eigen::MatrixXd& Z) {
  const Eigen::MatrixXd local = blocks_[block].matrix(S_inverse, Z);
  Eigen::Index col = 0;
  const std::vector<std::size_t>& groups = groups_of_block_[block];
  for (std::size_t j = 0; j < groups.size(); ++j) {
    const Group& column = groups_[groups[j]];
    Panel& panel = panels_[column.panel];
    Eigen::Index row = col;
    for (std::size_t i = j; i < groups.size(); ++i) {
      const Eigen::Index rows = groups_[groups[i]].size();
      panel.matrix.block(panel.row_of(groups[i]), column.column, rows, column.size()) +=
          local.block(row, col, rows, column.size());
      row += rows;
    }
    col += column.size();
  }
}

bool SchurComplement::factorize() {
  scale_.resize(static_cast<Eigen::Index>(place_.size()));
  for (const Panel& panel : panels_) {
    scale_.segment(panel.begin, panel.columns) =
        panel.matrix.topRows(panel.columns).diagonal().unaryExpr([](double entry) {
          return entry > 0.0 ? 1.0 / std::sqrt(entry) : 1.0;
        });
  }
  if (!scale_.allFinite()) return false;
  for (double shift = kLeastShift; shift < kLargestShift; shift *= 30.0) {
    if (factorize_with(shift)) return true;
  }
  return false;
}

bool SchurComplement::factorize_with(double shift) {
  for (Panel& panel : panels_) {
    panel.factor.noalias() = panel.matrix * scale_.segment(panel.begin, panel.columns).asDiagonal();
    for (std::size_t i = 0; i < panel.groups.size(); ++i) {
      const Group& group = groups_[panel.groups[i]];
      panel.factor.middleRows(panel.rows[i], group.size()).array().colwise() *=
          scale_.segment(group.begin, group.size()).array();
    }
    panel.factor.topRows(panel.columns).diagonal().array() += shift;
  }
  Eigen::MatrixXd update;
  for (Panel& panel : panels_) {
    const Eigen::Index below = panel.factor.rows() - panel.columns;
    auto top = panel.factor.topRows(panel.columns);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(top);
    if (cholesky.info() != Eigen::Success || !top.diagonal().allFinite()) return false;
    if (below == 0) continue;
    auto bottom = panel.factor.bottomRows(below);
    top.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(bottom);
    for (std::size_t j = 0; j < panel.groups.size(); ++j) {
      if (panel.rows[j] < panel.columns) continue;
      const Group& column = groups_[panel.groups[j]];
      const Eigen::Index from = panel.rows[j];
      update.noalias() = panel.factor.bottomRows(panel.factor.rows() - from) *
                         panel.factor.middleRows(from, column.size()).transpose();
      Panel& target = panels_[column.panel];
      for (std::size_t i = j; i < panel.groups.size(); ++i) {
        const Eigen::Index rows = groups_[panel.groups[i]].size();
        target.factor.block(target.row_of(panel.groups[i]), column.column, rows, column.size()) -=
            update.middleRows(panel.rows[i] - from, rows);
      }
    }
  }
  return true;
}

/// M x, both in the order of elimination.
Eigen::VectorXd SchurComplement::product(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (const Panel& panel : panels_) {
    const auto top = panel.matrix.topRows(panel.columns);
    y.segment(panel.begin, panel.columns) +=
        top.selfadjointView<Eigen::Lower>() * x.segment(panel.begin, panel.columns);
    for (std::size_t i = 0; i < panel.groups.size(); ++i) {
      if (panel.rows[i] < panel.columns) continue;
      const Group& group = groups_[panel.groups[i]];
      const auto rows = panel.matrix.middleRows(panel.rows[i], group.size());
      y.segment(group.begin, group.size()) += rows * x.segment(panel.begin, panel.columns);
      y.segment(panel.begin, panel.columns) +=
          rows.transpose() * x.segment(group.begin, group.size());
    }
  }
  return y;
}

/// By the factors of the scaled and shifted matrix.
Eigen::VectorXd SchurComplement::back_and_forth(Eigen::VectorXd x) const {
  x.array() *= scale_.array();
  for (const Panel& panel : panels_) {
    const auto top = panel.factor.topRows(panel.columns);
    auto own = x.segment(panel.begin, panel.columns);
    top.triangularView<Eigen::Lower>().solveInPlace(own);
    for (std::size_t i = 0; i < panel.groups.size(); ++i) {
      if (panel.rows[i] < panel.columns) continue;
      const Group& group = groups_[panel.groups[i]];
      x.segment(group.begin, group.size()) -=
          panel.factor.middleRows(panel.rows[i], group.size()) * own;
    }
  }
  for (std::size_t p = panels_.size(); p-- > 0;) {
    const Panel& panel = panels_[p];
    const auto top = panel.factor.topRows(panel.columns);
    auto own = x.segment(panel.begin, panel.columns);
    for (std::size_t i = 0; i < panel.groups.size(); ++i) {
      if (panel.rows[i] < panel.columns) continue;
      const Group& group = groups_[panel.groups[i]];
      own -= panel.factor.middleRows(panel.rows[i], group.size()).transpose() *
             x.segment(group.begin, group.size());
    }
    top.triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  x.array() *= scale_.array();
  return x;
}

Eigen::VectorXd SchurComplement::solve(const Eigen::VectorXd& right) const {
  Eigen::VectorXd permuted(right.size());
  for (Eigen::Index k = 0; k < right.size(); ++k) {
    permuted(place_[static_cast<std::size_t>(k)]) = right(k);
  }
  Eigen::VectorXd x = back_and_forth(permuted);
  Eigen::VectorXd residual = permuted - product(x);
  for (int i = 0; i < kRefinements; ++i) {
    const Eigen::VectorXd better = x + back_and_forth(residual);
    const Eigen::VectorXd next = permuted - product(better);
    // In the norm in which all variables count alike.
    if (!(next.cwiseProduct(scale_).norm() < 0.5 * residual.cwiseProduct(scale_).norm())) break;
    x = better;
    residual = next;
  }
  Eigen::VectorXd solution(right.size());
  for (Eigen::Index k = 0; k < right.size(); ++k) {
    solution(k) = x(place_[static_cast<std::size_t>(k)]);
  }
  return solution;
}

}  // namespace sampled_data_observers

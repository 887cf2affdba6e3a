#include "design/elimination_order.h"

#include <algorithm>
#include <set>

namespace sampled_data_observers {

EliminationOrder elimination_order(const std::vector<Eigen::Index>& sizes,
                                   const std::vector<std::vector<std::size_t>>& cliques) {
  const std::size_t count = sizes.size();
  std::vector<std::set<std::size_t>> neighbours(count);
  for (const std::vector<std::size_t>& clique : cliques) {
    for (const std::size_t a : clique) neighbours[a].insert(clique.begin(), clique.end());
  }
  const auto degree = [&](std::size_t g) {
    Eigen::Index sum = 0;
    for (const std::size_t other : neighbours[g]) sum += sizes[other];
    return sum;
  };
  // By degree, then by number.
  std::set<std::pair<Eigen::Index, std::size_t>> waiting;
  std::vector<Eigen::Index> degrees;
  for (std::size_t g = 0; g < count; ++g) {
    neighbours[g].erase(g);
    degrees.push_back(degree(g));
    waiting.emplace(degrees[g], g);
  }
  EliminationOrder result;
  std::vector<std::vector<std::size_t>> reached;
  std::vector<std::size_t> place(count);
  while (!waiting.empty()) {
    const std::size_t next = waiting.begin()->second;
    waiting.erase(waiting.begin());
    place[next] = result.order.size();
    result.order.push_back(next);
    const std::set<std::size_t> others = std::move(neighbours[next]);
    reached.emplace_back(others.begin(), others.end());
    for (const std::size_t g : others) {
      neighbours[g].insert(others.begin(), others.end());
      neighbours[g].erase(g);
      neighbours[g].erase(next);
      waiting.erase({degrees[g], g});
      degrees[g] = degree(g);
      waiting.emplace(degrees[g], g);
    }
  }
  for (std::vector<std::size_t>& groups : reached) {
    for (std::size_t& g : groups) g = place[g];
    std::sort(groups.begin(), groups.end());
  }
  result.later = std::move(reached);
  return result;
}

}  // namespace sampled_data_observers

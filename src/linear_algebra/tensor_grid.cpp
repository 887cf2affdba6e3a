#include "linear_algebra/tensor_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace sampled_data_observers {
namespace {

void check_nodes(const std::vector<double>& nodes) {
  if (nodes.size() < 2) throw std::invalid_argument("a grid needs two nodes per coordinate");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!std::isfinite(nodes[i]) || (i > 0 && !(nodes[i - 1] < nodes[i]))) {
      throw std::invalid_argument("nodes of a grid must be finite and strictly increasing");
    }
  }
}

}  // namespace

TensorGrid::TensorGrid(std::vector<std::vector<double>> nodes) : nodes_(std::move(nodes)) {
  if (nodes_.empty() || nodes_.size() > kMaxDimensions) {
    throw std::invalid_argument("a grid has one to " + std::to_string(kMaxDimensions) +
                                " coordinates");
  }
  for (std::size_t d = nodes_.size(); d-- > 0;) {
    check_nodes(nodes_[d]);
    strides_[d] = size_;
    size_ *= nodes_[d].size();
  }
}

TensorGrid::Interpolation TensorGrid::locate(const double* point) const {
  Interpolation result;
  result.size = 1;
  result.weights[0] = 1.0;
  for (std::size_t d = 0; d < nodes_.size(); ++d) {
    const std::vector<double>& nodes = nodes_[d];
    const double value = std::clamp(point[d], nodes.front(), nodes.back());
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, value);
    const auto low = static_cast<std::size_t>(above - nodes.begin()) - 1;
    const double fraction = (value - nodes[low]) / (nodes[low + 1] - nodes[low]);
    for (std::size_t v = 0; v < result.size; ++v) {
      const std::size_t upper = result.size + v;
      result.vertices[v] += low * strides_[d];
      result.vertices[upper] = result.vertices[v] + strides_[d];
      result.weights[upper] = result.weights[v] * fraction;
      result.weights[v] *= 1.0 - fraction;
    }
    result.size *= 2;
  }
  return result;
}

}  // namespace sampled_data_observers

#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace sampled_data_observers {

/// A tensor grid: nodes per coordinate, whose combinations are the nodes of the grid, numbered in
/// row-major order, so that the last coordinate changes fastest. Between them a function that is
/// given at the nodes is interpolated multi-affinely: it is affine in each coordinate within a cell
/// (between neighbouring nodes of all coordinates), and continuous.
///
/// Immutable; nothing but the constructor allocates or throws.
class TensorGrid {
 public:
  static constexpr std::size_t kMaxDimensions = 5;
  static constexpr std::size_t kMaxVertices = std::size_t{1} << kMaxDimensions;

  /// The vertices of the cell that a point lies in, and their weights there.
  struct Interpolation {
    std::size_t size = 0;  ///< number of vertices, 2^dimensions()
    /// Numbers of nodes. Bit d of the position in this list says whether the vertex is the upper
    /// one along the coordinate d; so vertices[0] is the lowest of the cell.
    std::array<std::size_t, kMaxVertices> vertices = {};
    /// In [0, 1]; they sum to 1 up to rounding. At a node, 1 is the weight of that one alone.
    std::array<double, kMaxVertices> weights = {};
  };

  /// @param nodes  for each coordinate, finite and strictly increasing
  /// @throws std::invalid_argument for no coordinate or more than kMaxDimensions, fewer than two
  /// nodes of a coordinate, and nodes that do not increase.
  explicit TensorGrid(std::vector<std::vector<double>> nodes);

  std::size_t dimensions() const { return nodes_.size(); }
  /// Number of nodes of the grid.
  std::size_t size() const { return size_; }
  /// The nodes of one coordinate.
  const std::vector<double>& nodes(std::size_t coordinate) const { return nodes_[coordinate]; }
  /// What a step along a coordinate adds to the number of a node.
  std::size_t stride(std::size_t coordinate) const { return strides_[coordinate]; }

  /// Which node of one coordinate a node of the grid has.
  std::size_t position(std::size_t node, std::size_t coordinate) const {
    return node / strides_[coordinate] % nodes_[coordinate].size();
  }
  /// The node of the grid that has the first node of one coordinate, and of the others those of
  /// `node`.
  std::size_t with_first(std::size_t node, std::size_t coordinate) const {
    return node - position(node, coordinate) * strides_[coordinate];
  }

  /// Where a point lies, and its weights there. Coordinates outside of their nodes are taken as the
  /// nearest node; at an inner node, it is the cell above.
  /// @param point  dimensions() entries, not NaN
  Interpolation locate(const double* point) const;

 private:
  std::vector<std::vector<double>> nodes_;
  std::array<std::size_t, kMaxDimensions> strides_ = {};
  std::size_t size_ = 1;
};

}  // namespace sampled_data_observers

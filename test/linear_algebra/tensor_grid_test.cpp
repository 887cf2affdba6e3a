#include "linear_algebra/tensor_grid.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

namespace sampled_data_observers {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Nodes = std::vector<std::vector<double>>;
using Function = std::function<double(const std::vector<double>&)>;

std::vector<double> values_at_nodes(const TensorGrid& grid, const Function& function) {
  std::vector<double> values;
  for (std::size_t node = 0; node < grid.size(); ++node) {
    std::vector<double> point;
    for (std::size_t d = 0; d < grid.dimensions(); ++d) {
      point.push_back(grid.nodes(d)[grid.position(node, d)]);
    }
    values.push_back(function(point));
  }
  return values;
}

double interpolate(const TensorGrid& grid, const std::vector<double>& values,
                   const std::vector<double>& point) {
  const TensorGrid::Interpolation at = grid.locate(point.data());
  double sum = 0.0;
  for (std::size_t v = 0; v < at.size; ++v) sum += at.weights[v] * values[at.vertices[v]];
  return sum;
}

TEST(TensorGridTest, NumbersNodesInRowMajorOrder) {
  const TensorGrid grid({{0.0, 1.0}, {0.0, 1.0, 2.0}, {0.0, 1.0, 2.0, 3.0}});
  EXPECT_EQ(24u, grid.size());
  std::size_t node = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 4; ++k, ++node) {
        EXPECT_EQ(i, grid.position(node, 0));
        EXPECT_EQ(j, grid.position(node, 1));
        EXPECT_EQ(k, grid.position(node, 2));
        EXPECT_EQ(4 * j + k, grid.with_first(node, 0));
        EXPECT_EQ(12 * i + k, grid.with_first(node, 1));
        EXPECT_EQ(12 * i + 4 * j, grid.with_first(node, 2));
      }
    }
  }
}

TEST(TensorGridTest, WeightsInACellAreProductsOfFractions) {
  const TensorGrid grid({{0.0, 0.5, 1.5}, {0.0, 0.25, 0.5}});
  const double point[] = {0.75, 0.375};  // a quarter, and half, of the way
  const TensorGrid::Interpolation at = grid.locate(point);
  ASSERT_EQ(4u, at.size);
  const std::size_t vertices[] = {4, 7, 5, 8};
  const double weights[] = {0.375, 0.125, 0.375, 0.125};
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_EQ(vertices[v], at.vertices[v]);
    EXPECT_EQ(weights[v], at.weights[v]);
  }
}

TEST(TensorGridTest, InterpolatesMultiaffineFunctionsWithoutError) {
  const TensorGrid grid({{0.0, 0.5, 1.0}, {-1.0, 1.0}, {0.0, 0.25, 2.0, 4.0}});
  const Function function = [](const std::vector<double>& x) {
    return 1.0 + x[0] - 2.0 * x[1] + 4.0 * x[0] * x[2] + 8.0 * x[0] * x[1] * x[2];
  };
  const std::vector<double> values = values_at_nodes(grid, function);
  for (const double a : {0.0, 0.125, 0.5, 0.875, 1.0}) {
    for (const double b : {-1.0, 0.5, 1.0}) {
      for (const double c : {0.0, 0.125, 0.25, 3.0, 4.0}) {
        EXPECT_NEAR(function({a, b, c}), interpolate(grid, values, {a, b, c}), 1e-13);
      }
    }
  }
}

TEST(TensorGridTest, AtANodeThatOneAloneHasAWeight) {
  const TensorGrid grid({{0.0, 0.1, 0.3}, {0.0, 0.7, 0.9}});
  for (std::size_t node = 0; node < grid.size(); ++node) {
    const double point[] = {grid.nodes(0)[grid.position(node, 0)],
                            grid.nodes(1)[grid.position(node, 1)]};
    const TensorGrid::Interpolation at = grid.locate(point);
    for (std::size_t v = 0; v < at.size; ++v) {
      EXPECT_EQ(at.vertices[v] == node ? 1.0 : 0.0, at.weights[v]) << node;
    }
  }
}

TEST(TensorGridTest, PointsOutsideAreTakenAsTheNearestNode) {
  const TensorGrid grid({{0.0, 1.0, 3.0}, {0.0, 2.0}});
  const std::vector<double> values = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
  EXPECT_EQ(4.0, interpolate(grid, values, {7.0, 0.0}));
  EXPECT_EQ(4.5, interpolate(grid, values, {kInfinity, 1.0}));
  EXPECT_EQ(1.0, interpolate(grid, values, {-1.0, kInfinity}));
}

TEST(TensorGridTest, RefusesWhatIsNoGrid) {
  EXPECT_THROW(TensorGrid(Nodes{}), std::invalid_argument);
  EXPECT_THROW(TensorGrid(Nodes(TensorGrid::kMaxDimensions + 1, {0.0, 1.0})),
               std::invalid_argument);
  EXPECT_THROW(TensorGrid({{0.0, 1.0}, {0.0}}), std::invalid_argument);
  EXPECT_THROW(TensorGrid({{0.0, 1.0, 1.0}}), std::invalid_argument);
  EXPECT_THROW(TensorGrid({{0.0, kInfinity}}), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers

// Tables that all of a process share, and the products in extended precision that they are made of.
#include "linear_algebra/shared_tables.h"

#include <gtest/gtest.h>

#include "linear_algebra/transition_matrix.h"

namespace sampled_data_observers {
namespace {

TEST(SharedTablesTest, AreMadeOnceAsLongAsSomebodyHasThem) {
  int made = 0;
  const auto make = [&] { return std::vector<double>{static_cast<double>(++made)}; };
  std::shared_ptr<const std::vector<double>> first = shared_tables({-1.0, 2.0}, make);
  EXPECT_EQ(first, shared_tables({-1.0, 2.0}, make));
  EXPECT_EQ(1, made);
  const std::shared_ptr<const std::vector<double>> other = shared_tables({-1.0, 3.0}, make);
  EXPECT_EQ(2.0, other->front());
  EXPECT_EQ(1.0, first->front());
  first.reset();
  EXPECT_EQ(3.0, shared_tables({-1.0, 2.0}, make)->front());
  EXPECT_EQ(other, shared_tables({-1.0, 3.0}, make));
}

TEST(ExtendedProductTest, SumsEachEntryInTheOrderOfTheColumns) {
  for (Eigen::Index rows = 1; rows <= 6; ++rows) {
    for (Eigen::Index columns = 1; columns <= 6; ++columns) {
      const ExtendedMatrix a = ExtendedMatrix::Random(rows, 9);
      const ExtendedMatrix b = ExtendedMatrix::Random(9, columns);
      ExtendedMatrix expected = ExtendedMatrix::Zero(rows, columns);
      for (Eigen::Index k = 0; k < 9; ++k) {
        for (Eigen::Index i = 0; i < rows; ++i) {
          for (Eigen::Index j = 0; j < columns; ++j) expected(i, j) += a(i, k) * b(k, j);
        }
      }
      EXPECT_EQ(expected, product(a, b));
    }
  }
}

}  // namespace
}  // namespace sampled_data_observers

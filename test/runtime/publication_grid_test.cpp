#include "sampled_data_observers/runtime/publication_grid.h"

#include <gtest/gtest.h>

#include <vector>

namespace sampled_data_observers {
namespace {

std::vector<Stamp> due(PublicationGrid& grid, Stamp now, Stamp earliest) {
  std::vector<Stamp> stamps;
  while (const std::optional<Stamp> stamp = grid.next(now, earliest)) stamps.push_back(*stamp);
  return stamps;
}

TEST(PublicationGridTest, GivesWholeMultiplesOnceAndInOrder) {
  PublicationGrid grid(10, 0, 1000);
  EXPECT_EQ((std::vector<Stamp>{100, 110}), due(grid, 115, 95));
  EXPECT_EQ((std::vector<Stamp>{}), due(grid, 119, 95));
  EXPECT_EQ((std::vector<Stamp>{120}), due(grid, 120, 95));
}

TEST(PublicationGridTest, WaitsForTheDelay) {
  PublicationGrid grid(10, 4, 1000);
  EXPECT_EQ((std::vector<Stamp>{}), due(grid, 103, 100));
  EXPECT_EQ((std::vector<Stamp>{100}), due(grid, 104, 100));
  EXPECT_EQ(114, grid.next_due_time(104));
  EXPECT_EQ(104, grid.next_due_time(103));
}

TEST(PublicationGridTest, CatchesUpNoFurtherThanTheBacklog) {
  PublicationGrid grid(10, 0, 25);
  EXPECT_EQ((std::vector<Stamp>{0}), due(grid, 5, 0));
  EXPECT_EQ((std::vector<Stamp>{980, 990, 1000}), due(grid, 1000, 0));
}

TEST(PublicationGridTest, RepeatsNoStampWhenTimeGoesBackButAfterARestart) {
  PublicationGrid grid(10, 0, 1000);
  due(grid, 100, 0);
  EXPECT_EQ((std::vector<Stamp>{}), due(grid, 50, 0));
  grid.restart(50);
  EXPECT_EQ((std::vector<Stamp>{50}), due(grid, 55, 45));
  grid.restart(55);
  EXPECT_EQ((std::vector<Stamp>{}), due(grid, 55, 45));
}

TEST(PublicationGridTest, TakesOtherStampsBetweenItsOwnWithoutRepeatingOrMissingOne) {
  PublicationGrid grid(10, 0, 1000);
  due(grid, 105, 95);
  EXPECT_TRUE(grid.insert(105));
  EXPECT_FALSE(grid.insert(105));
  EXPECT_FALSE(grid.insert(100));
  EXPECT_TRUE(grid.insert(109));
  EXPECT_EQ((std::vector<Stamp>{110, 120}), due(grid, 120, 95));
  EXPECT_FALSE(grid.insert(120));
}

TEST(PublicationGridTest, GivesUpWhatWasMissed) {
  PublicationGrid grid(10, 4, 1000);
  due(grid, 104, 95);
  grid.skip_to(154);
  EXPECT_EQ((std::vector<Stamp>{160}), due(grid, 164, 95));
  grid.skip_to(100);
  EXPECT_EQ((std::vector<Stamp>{170}), due(grid, 174, 95));
}

}  // namespace
}  // namespace sampled_data_observers

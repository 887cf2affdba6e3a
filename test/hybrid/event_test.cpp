#include "sampled_data_observers/hybrid/event.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/random_events.h"

namespace sampled_data_observers {
namespace {

using test::OwnedEvent;

Event without_values(EventKind kind) {
  Event event;
  event.stamp = 5;
  event.kind = kind;
  return event;
}

Event release(Duration delay) {
  Event event = without_values(EventKind::kRelease);
  event.delay = delay;
  return event;
}

Event rejection(EventKind kind) {
  Event event = without_values(EventKind::kRejected);
  event.rejected = kind;
  return event;
}

TEST(EventTest, AreOrderedByStampKindSensorSizeModeOrDelayAndValues) {
  const std::vector<OwnedEvent> owned = {
      {4, EventKind::kSample, 0, {9.0}},      {5, EventKind::kInput, 0, {-1.0}},
      {5, EventKind::kInput, 0, {1.0}},       {5, EventKind::kJump, 0, {}, 1.0},
      {5, EventKind::kJump, 0, {}, 2.0},      {5, EventKind::kJump, 0, {8.0}, 1.0},
      {5, EventKind::kJump, 0, {9.0}, 1.0},   {5, EventKind::kJump, 0, {7.0}, 2.0},
      {5, EventKind::kJumpOutput, 0, {3.0}},  {5, EventKind::kOutput, 0, {3.0}},
      {5, EventKind::kSample, 0, {2.0}},      {5, EventKind::kSample, 0, {3.0}},
      {5, EventKind::kSample, 1, {0.0, 1.0}}, {5, EventKind::kSample, 1, {0.0, 2.0}},
      {6, EventKind::kInput, 0, {0.0}}};
  std::vector<Event> events;
  for (const OwnedEvent& event : owned) {
    if (event.kind == EventKind::kOutput) {
      events.push_back(release(1));
      events.push_back(release(2));
    }
    if (event.stamp == 6) {
      events.push_back(rejection(EventKind::kInput));
      events.push_back(rejection(EventKind::kJump));
    }
    events.push_back(event.view());
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    for (std::size_t j = 0; j < events.size(); ++j) {
      const int order = compare(events[i], events[j]);
      EXPECT_EQ((i > j) - (i < j), (order > 0) - (order < 0)) << i << " and " << j;
      EXPECT_EQ(i == j, digest(events[i]) == digest(events[j])) << i << " and " << j;
    }
  }
}

TEST(EventTest, WhenItsResetTakesEffectIsNoPartOfAJump) {
  Event early;
  early.kind = EventKind::kJump;
  Event late = early;
  late.release = 7;
  EXPECT_EQ(0, compare(early, late));
  EXPECT_EQ(digest(early), digest(late));
}

TEST(EventTest, DuplicatesHaveOneDigestWhateverTheSignOfZero) {
  const OwnedEvent positive{5, EventKind::kSample, 0, {0.0, 1.0}};
  const OwnedEvent negative{5, EventKind::kSample, 0, {-0.0, 1.0}};
  EXPECT_EQ(0, compare(positive.view(), negative.view()));
  EXPECT_EQ(digest(positive.view()), digest(negative.view()));
}

}  // namespace
}  // namespace sampled_data_observers

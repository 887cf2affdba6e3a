#include "sampled_data_observers/hybrid/state_layout.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace sampled_data_observers {
namespace {

enum class Colour { kRed, kGreen, kBlue };

TEST(StateLayoutTest, SlotsLieBesideEachOtherAndKeepWhatIsSet) {
  StateLayout layout;
  const VectorSlot x = layout.vector(2);
  const Eigen::Index begin = layout.size();
  const FlagSlot flag = layout.flag();
  const FlagsSlot flags = layout.flags(3);
  const NumberSlot number = layout.number();
  const ChoiceSlot<Colour> colour = layout.choice<Colour>();
  const ModeSlot mode = layout.mode();
  const TimerSlot timer = layout.timer();
  EXPECT_EQ(10, layout.size());
  EXPECT_EQ(8, layout.since(begin).size());

  Eigen::VectorXd storage = Eigen::VectorXd::Constant(layout.size(), 0.0);
  double* state = storage.data();
  const double values[] = {1.5, -2.5};
  x.set(values, state);
  flag.set(true, state);
  flags.fill(true, state);
  flags[1].set(false, state);
  number.set(-0.25, state);
  colour.set(Colour::kBlue, state);
  mode.set(4, state);
  timer.advance(7, state);
  EXPECT_EQ(1.5, x.of(state)[0]);
  EXPECT_EQ(-2.5, x.part(1, 1).of(state)[0]);
  EXPECT_TRUE(flag.of(state));
  EXPECT_TRUE(flags[0].of(state));
  EXPECT_FALSE(flags[1].of(state));
  EXPECT_TRUE(flags[2].of(state));
  EXPECT_EQ(-0.25, number.of(state));
  EXPECT_EQ(Colour::kBlue, colour.of(state));
  EXPECT_EQ(4u, mode.of(state));
  EXPECT_EQ(7.0, timer.of(state));
  layout.since(begin).fill(0.0, state);
  EXPECT_EQ(-2.5, x.of(state)[1]);
  EXPECT_FALSE(flag.of(state));
  EXPECT_EQ(Colour::kRed, colour.of(state));
  EXPECT_EQ(0.0, timer.of(state));
}

TEST(StateLayoutTest, ATimerStaysAtItsLimit) {
  StateLayout layout;
  const TimerSlot timer = layout.timer(10.0);
  double state = 0.0;
  timer.advance(9, &state);
  EXPECT_FALSE(timer.is_over(&state));
  timer.advance(5, &state);
  EXPECT_TRUE(timer.is_over(&state));
  EXPECT_EQ(10.0, timer.of(&state));
  timer.restart(&state);
  EXPECT_EQ(0.0, timer.of(&state));
  timer.expire(&state);
  EXPECT_TRUE(timer.is_over(&state));
}

TEST(StateLayoutTest, TimePassesForAllTimers) {
  StateLayout layout;
  const TimerSlot free = layout.timer();
  const NumberSlot number = layout.number();
  const TimerSlot limited = layout.timer(10.0);
  const StateLayout copy = layout;
  double state[] = {1.0, 2.0, 3.0};
  copy.advance_timers(9, state);
  EXPECT_EQ(10.0, free.of(state));
  EXPECT_EQ(2.0, number.of(state));
  EXPECT_EQ(10.0, limited.of(state));
}

}  // namespace
}  // namespace sampled_data_observers

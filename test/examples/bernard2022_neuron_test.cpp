// The spiking neuron of bernard2022, section 7.2, as shipped: 1 s stands for 1 ms of the neuron.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

const ExampleRun& undelayed() {
  static const ExampleRun run = Example("bernard2022_neuron_jump_based", kPrinted).run();
  return run;
}

/// The errors up to `delay` after the spikes, and all others.
struct Split {
  Trajectory inside;
  Trajectory outside;

  Split(const ExampleRun& run, double delay)
      : inside(of(run, delay, true)), outside(of(run, delay, false)) {}

 private:
  static Trajectory of(const ExampleRun& run, double delay, bool inside) {
    return run.error.where([&](double t) {
      return inside == std::any_of(run.jumps.begin(), run.jumps.end(), [&](const auto& spike) {
               return spike.time <= t && t < spike.time + delay + 0.1;
             });
    });
  }
};

TEST(Bernard2022NeuronJumpBased, SpikesAsThePaperSays) {
  const ExampleRun& run = undelayed();
  ASSERT_EQ(48u, run.jumps.size());
  EXPECT_NEAR(3.15312, run.jumps.front().time, 1e-5);
  for (std::size_t j = 1; j < run.jumps.size(); ++j) {
    const double interval = run.jumps[j].time - run.jumps[j - 1].time;
    EXPECT_GT(interval, 31.2);
    EXPECT_LT(interval, 36.1);
  }
}

// Figure 4, top and bottom left.
TEST(Bernard2022NeuronJumpBased, ConvergesByTheSpikesAlone) {
  const ExampleRun& run = undelayed();
  ASSERT_EQ(15001u, run.error.size());
  EXPECT_GT(run.error.from(0.0, 300.0).max(), 50.0);
  const Trajectory recovery = run.error.component(1);
  // (Other gains converge, too: this is how fast the printed one does.)
  EXPECT_NEAR(1.571, run.error.component(2).from(150.0, 300.0).max(), 0.05);
  EXPECT_NEAR(1.355, recovery.from(300.0, 450.0).max(), 0.05);
  EXPECT_LT(recovery.from(750.0).max(), 0.2);
  EXPECT_LT(recovery.from(1050.0).max(), 0.1);
  const Trajectory end = Split(run, 0.0).outside.from(1200.0);
  EXPECT_LT(end.max(), 1.4);
  EXPECT_LT(end.component(1).max(), 0.06);
  EXPECT_LT(end.component(2).max(), 0.02);
}

// Figure 4, bottom right: the error is small outside of the delays only, and grows with the delay.
TEST(Bernard2022NeuronJumpBased, DelayedSpikesCostMoreTheLongerTheyTake) {
  const Example example("bernard2022_neuron_jump_based", kPrinted);
  const ExampleRun run_1 = example.run("scenario_delay_1.yaml", "observer_delayed.yaml");
  const ExampleRun run_5 = example.run("scenario_delay_5.yaml", "observer_delayed.yaml");
  ASSERT_EQ(48u, run_5.jumps.size());
  const Split none(undelayed(), 0.0);
  const Split delay_1(run_1, 1.0);
  const Split delay_5(run_5, 5.0);
  const Trajectory end = none.outside.from(1200.0);
  const Trajectory end_1 = delay_1.outside.from(1200.0);
  const Trajectory end_5 = delay_5.outside.from(1200.0);
  EXPECT_LT(end_1.max(), 1.6);
  EXPECT_LT(end_5.max(), 7.0);
  EXPECT_GT(end_1.median(), 3.0 * end.median());
  EXPECT_GT(end_5.median(), 4.0 * end_1.median());
  const double d = end.component(2).max();
  const double d_1 = end_1.component(2).max();
  const double d_5 = end_5.component(2).max();
  EXPECT_LT(d_1, 0.2);
  EXPECT_LT(d_5, 0.8);
  EXPECT_GT(d_1, 8.0 * d);
  EXPECT_GT(d_5, 3.0 * d_1);
  for (const Split* split : {&delay_1, &delay_5}) {
    const double peak = split->inside.from(1200.0).max();  // "around 80" in the paper
    EXPECT_GT(peak, 70.0);
    EXPECT_LT(peak, 120.0);
  }
}

// What the paper does not have: a late spike that takes effect at its stamp leaves no trace.
TEST(Bernard2022NeuronJumpBased, LateSpikesAtTheirStampsCostNothing) {
  const ExampleRun late = Example("bernard2022_neuron_jump_based", kPrinted)
                              .run("scenario_delay_5.yaml", "observer.yaml");
  const ExampleRun& none = undelayed();
  ASSERT_EQ(none.estimate.size(), late.estimate.size());
  ASSERT_EQ(none.jumps.size(), late.jumps.size());
  for (std::size_t k = 0; k < none.estimate.size(); ++k) {
    ASSERT_EQ(none.estimate.value(k), late.estimate.value(k)) << none.estimate.time(k);
  }
  for (std::size_t j = 0; j < none.jumps.size(); ++j) {
    EXPECT_EQ(none.jumps[j].estimate, late.jumps[j].estimate);
  }
}

// Figure 3. The hold of the potential, every millisecond of the neuron, leaves the small errors.
TEST(Bernard2022NeuronHighGain, FindsTheParametersBy20) {
  const ExampleRun run = Example("bernard2022_neuron_high_gain", kPrinted).run();
  ASSERT_EQ(6001u, run.error.size());
  ASSERT_EQ(2u, run.jumps.size());
  EXPECT_NEAR(3.15312, run.jumps[0].time, 1e-5);
  EXPECT_NEAR(39.2493, run.jumps[1].time, 1e-4);
  const Trajectory a = run.error.component(2);
  const Trajectory b = run.error.component(3);
  EXPECT_NEAR(0.08, a.at(0.0), 1e-9);
  EXPECT_GT(b.at(5.0), 0.1);
  EXPECT_LT(a.from(15.0, 38.0).max(), 2e-4);
  EXPECT_LT(b.from(15.0, 38.0).max(), 6e-4);
  EXPECT_LT(run.error.from(15.0, 36.0).max(), 2e-3);
  // The second spike throws the parameters off once more, inside their saturations.
  EXPECT_GT(a.from(39.25, 41.0).max(), 0.05);
  EXPECT_LT(a.from(42.0, 50.0).max(), 3e-3);
  EXPECT_LT(b.from(42.0, 50.0).max(), 0.02);
  EXPECT_LT(a.from(50.0).max(), 2e-4);
  EXPECT_LT(b.from(50.0).max(), 6e-4);
}

// In the plant's own coordinates, through Jacobians that are singular.
TEST(Bernard2022NeuronHighGain, TheOriginalFormFindsTheParameters) {
  const ExampleRun run = Example("bernard2022_neuron_high_gain", "gains_original.yaml").run();
  ASSERT_EQ(6001u, run.error.size());
  const Trajectory a = run.error.component(2);
  const Trajectory b = run.error.component(3);
  EXPECT_GT(a.from(0.1, 3.0).max(), 0.2);  // at its bound
  EXPECT_LT(a.from(20.0, 36.0).max(), 4e-4);
  EXPECT_LT(b.from(20.0, 36.0).max(), 3e-3);
  EXPECT_LT(run.error.component(1).from(10.0, 36.0).max(), 1e-3);
  EXPECT_LT(a.from(55.0).max(), 1e-3);
  EXPECT_LT(b.from(55.0).max(), 5e-3);
}

}  // namespace
}  // namespace sampled_data_observers::test

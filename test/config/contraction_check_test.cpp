// Gains with which a linear observer diverges are told of when they are loaded.
#include "config/contraction_check.h"

#include <gtest/gtest.h>

#include "support/config_faults.h"

namespace sampled_data_observers::test {
namespace {

const char kOscillator[] = R"yaml(
observer: ConstantGainObserver
plant: {states: [p, v], A: [[0, 1], [-4, 0]]}
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
sampling: {T1: 0.1, T2: 0.4}
gains: {L: [[0.5], [0.2]]}
)yaml";

std::string warning(const std::string& text) {
  const ObserverConfig config = parse(text);
  return config.warnings.empty() ? "" : config.warnings.front();
}

std::string with_gains(const std::string& type, const std::string& gains) {
  return replaced(replaced(kOscillator, "ConstantGainObserver", type), "L: [[0.5], [0.2]]", gains);
}

const char kDiverges[] = "from sample to sample: the estimate diverges";

TEST(ContractionCheckTest, GainsThatContractAreSilent) {
  EXPECT_EQ("", warning(kOscillator));
  EXPECT_EQ("", warning(with_gains("IntersampleInjectionObserver", "L: [[2], [1]], H: [[-2]]")));
  EXPECT_EQ("", warning(with_gains("SampleAndHoldObserver", "L: [[-1], [-0.5]]")));
  EXPECT_EQ("", warning(with_gains("HybridKalmanFilter",
                                   "P0: [[1, 0], [0, 1]], R: [[0.1]], Q: [[0.1, 0], [0, 0.1]]")));
  EXPECT_EQ("", warning(with_gains("TimeVaryingGainObserver", "P: [[4, 0], [0, 1]]")));
}

TEST(ContractionCheckTest, WrongSignsAreToldOf) {
  for (const std::string& text :
       {with_gains("ConstantGainObserver", "L: [[-0.5], [-0.2]]"),
        with_gains("IntersampleInjectionObserver", "L: [[-2], [-1]], H: [[-2]]"),
        with_gains("SampleAndHoldObserver", "L: [[1], [0.5]]")}) {
    const std::string message = warning(text);
    EXPECT_NE(std::string::npos, message.find("gains: with samples ")) << message << text;
    EXPECT_NE(std::string::npos, message.find(kDiverges)) << message;
  }
}

TEST(ContractionCheckTest, TheFactorIsThatOfTheErrorMap) {
  // x is measured itself and stands: the error is multiplied by 1 - L.
  const std::string message = warning(R"yaml(
observer: ConstantGainObserver
plant: {states: [x], A: [[0]]}
sensors: {position: {C: [[1]], source: {topic: position}}}
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[2.25]]}
)yaml");
  EXPECT_NE(std::string::npos, message.find("with samples every 0.1 s")) << message;
  EXPECT_NE(std::string::npos, message.find("by the factor 1.25")) << message;
}

TEST(ContractionCheckTest, JumpsAreLookedAtForTheTimesBetweenThem) {
  // The error is multiplied by 0.5 e^{0.1 tau} from jump to jump: it grows from 6.9 s on.
  const std::string text = R"yaml(
observer: SynchronizedObserver
plant: {states: [x], A: [[0.1]], jump_map: {A_d: [[1]]}}
sensors: {position: {C: [[1]], measured: at_jumps}}
gains: {L_d: [[0.5]]}
jumps: {dwell_time: [0.5, 2]}
)yaml";
  EXPECT_EQ("", warning(text));
  EXPECT_NE("", warning(replaced(text, "[0.5, 2]", "[0.5, 8]")));
}

TEST(ContractionCheckTest, TimesThatAlternateAreLookedAtToo) {
  // By the eigenvalues of (I - L C) e^{A tau} in another program: at all constant times of the grid
  // the error falls to 0.7746 or less from sample to sample, and at 0.1 s and 0.9 s by turns it
  // grows by 1.2992.
  const std::string text = replaced(replaced(kOscillator, "L: [[0.5], [0.2]]", "L: [[0.4], [2.2]]"),
                                    "T2: 0.4", "T2: 0.9");
  const std::string message = warning(text);
  EXPECT_NE(std::string::npos,
            message.find("apart by turns, inside of [T1, T2], the error grows by "
                         "the factor 1.299"))
      << message;
}

// Two states of their own, each measured by itself: the one of gps doubles in ln 2 s.
const char kTwoPaces[] = R"yaml(
observer: ConstantGainObserver
plant: {states: [x, z], A: [[1, 0], [0, -1]]}
sensors:
  gps: {C: [[1, 0]], sampling: {T1: 0.2, T2: 1}, source: {topic: gps}}
  wheel: {C: [[0, 1]], sampling: {T1: 0.05, T2: 0.15}, source: {topic: wheel}}
gains: {L: {gps: [[0.7], [0]], wheel: [[0], [0.5]]}}
)yaml";

TEST(ContractionCheckTest, SensorsAreLookedAtEachAtItsOwnTimes) {
  EXPECT_EQ("", warning(kTwoPaces));  // 0.3 e < 1
  const std::string slow = warning(replaced(kTwoPaces, "T2: 1}", "T2: 1.5}"));
  // 0.3 e^1.5
  EXPECT_NE(std::string::npos, slow.find("with samples of gps every 1.5 s, and those of the other "
                                         "sensors as seldom between them as may be"))
      << slow;
  EXPECT_NE(std::string::npos, slow.find("by the factor 1.345 from sample to sample")) << slow;
  // Seven samples of wheel in 0.95 s, each of which multiplies by -1.3: e^-0.95 1.3^7.
  const std::string fast = warning(replaced(kTwoPaces, "[[0], [0.5]]", "[[0], [2.3]]"));
  EXPECT_NE(std::string::npos, fast.find("by the factor 2.427")) << fast;
}

TEST(ContractionCheckTest, AModeThatNoSampleShowsMayStand) {
  EXPECT_EQ("", warning(R"yaml(
observer: ConstantGainObserver
plant: {states: [x, bias], A: [[-1, 0], [0, 0]]}
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[0.5], [0]]}
)yaml"));
}

const char kImpulsive[] = R"yaml(
observer: SynchronizedObserver
plant:
  states: [x1, x2, x3]
  A: [[0, 1, 0], [0, 0, 0], [0, 0, 0]]
  jump_map: {A_d: [[1, 0, 0], [0, 1, 0], [1, 0, 0]]}
sensors: {position: {C: [[1, 0, 0]], measured: at_jumps}}
jumps: {topic: jumps}
sampling: {T1: 2, T2: 5}
gains: {L_d: [[1], [0.2], [1]]}
)yaml";

TEST(ContractionCheckTest, WrongSignsAreToldOfForJumpsToo) {
  EXPECT_EQ("", warning(kImpulsive));
  const std::string message = warning(replaced(kImpulsive, "[0.2]", "[-0.2]"));
  // x2 is measured as tau x2 alone, and is left as (1 + 0.2 tau) x2.
  EXPECT_NE(std::string::npos, message.find("gains: with jumps every 5 s, ")) << message;
  EXPECT_NE(std::string::npos, message.find("by the factor 2 from jump to jump")) << message;
}

const char kSwitched[] = R"yaml(
observer: SwitchedObserver
plant:
  states: [x1, x2]
  modes:
    1: {A: [[0, 1], [-1, 0]]}
    7: {A: [[0, 0], [0, 0]]}
sensors: {first: {C: [[1, 0]], measured: at_jumps}}
jumps: {topic: jumps}
sampling: {T1: 0.6, T2: 1.4}
gains: {L_d: {1: [[1], [0.5]], 7: [[1], [0]]}}
)yaml";

TEST(ContractionCheckTest, WrongSignsAreToldOfForSwitchesToo) {
  EXPECT_EQ("", warning(kSwitched));
  const std::string message = warning(replaced(kSwitched, "[0.5]", "[-3]"));
  EXPECT_NE(std::string::npos, message.find("gains: with jumps ")) << message;
  EXPECT_NE(std::string::npos, message.find("(then mode 7)")) << message;
}

TEST(ContractionCheckTest, PlantsThatAreNotLinearAreNotLookedAt) {
  EXPECT_EQ("", warning(R"yaml(
observer: ConstantGainObserver
plant: {states: [x], flow: {x: "-sin(x)"}}
sensors: {position: {C: [[1]], source: {topic: position}}}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[-5]]}
)yaml"));
}

}  // namespace
}  // namespace sampled_data_observers::test

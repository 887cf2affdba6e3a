// The bare command on plants of textbooks: the package's own observer with its gain file is better
// than an open-loop copy and than holding the last sample, and its bound holds and is of use.
#include "textbook_plants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "config/design_config.h"
#include "design/assumed_disturbance.h"
#include "design/best_design.h"
#include "design/gain_file.h"
#include "design/workers.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "support/long_tests.h"
#include "textbook_run.h"

namespace sampled_data_observers::test {
namespace {

namespace fs = std::filesystem;

constexpr double kUsefulBound = 20.0;  ///< over the worst error seen

class TextbookPlantsTest : public ::testing::TestWithParam<TextbookPlant> {
 protected:
  void SetUp() override {
    std::string path = (fs::temp_directory_path() / "textbook-XXXXXX").string();
    ASSERT_NE(::mkdtemp(path.data()), nullptr);
    folder_ = path;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  /// As `design synthesize FILE -o gains.yaml` makes it.
  void design(const std::string& file) {
    const DesignConfig config = read_design_config({file}, no_plant_plugins);
    problem_.subject = config.subject;
    problem_.objective = Objective::kMinFinalError;
    assume({config.noise, config.disturbance}, problem_);
    SynthesisOptions options;
    options.jobs = default_jobs();
    const auto outcomes = synthesize_by_all(methods_that_apply(problem_), problem_, options);
    const MethodOutcome* best = best_of(outcomes, problem_.objective);
    ASSERT_NE(best, nullptr) << outcomes.front().message;
    method_ = best->method;
    std::ostringstream text;
    write_gain_file(*best->design, {file, config.plant_hash, "test", "2000-01-01"}, text);
    observer_ = read_observer_config({file, write("gains.yaml", text.str())}, no_plant_plugins);
  }

  /// In runs with disturbances that enter by N and are of this size.
  void expect_gains_of_use(const Eigen::MatrixXd& N, double disturbance) {
    double worst = 0.0;
    double bound = 0.0;
    for (const Signals signals : {Signals::kRandom, Signals::kConstant, Signals::kSwitching}) {
      const Seen seen = run_textbook_plant(plant_, observer_, N, disturbance, signals);
      EXPECT_LE(seen.largest_share, 1.0);
      worst = std::max(worst, seen.worst_error);
      bound = std::max(bound, seen.largest_bound);
      if (signals != Signals::kRandom) continue;
      EXPECT_LT(seen.estimated, seen.held);
      EXPECT_LT(seen.estimated, seen.open_loop);
      random_ = seen;
    }
    EXPECT_LE(bound, kUsefulBound * worst);
    std::printf("%s: %.2f of the noise, held %.2f, bound %.1f times the worst error\n",
                method_.c_str(), random_.estimated / plant_.noise, random_.held / plant_.noise,
                bound / worst);
  }

  const TextbookPlant& plant_ = GetParam();
  fs::path folder_;
  DesignProblem problem_;
  std::string method_;
  ObserverConfig observer_;
  Seen random_;
};

class TextbookPlants : public TextbookPlantsTest {};

TEST_P(TextbookPlants, HaveGainsOfUseWhereOnlyNoiseIsDeclared) {
  ASSERT_NO_FATAL_FAILURE(design(write("plant.yaml", plant_.file(false))));
  expect_gains_of_use(problem_.subject.plant.N, problem_.assumptions.disturbance);
  // About as much as the last sample held is off, however little the plant moves.
  EXPECT_LT(random_.estimated, 1.1 * plant_.noise);
}

/// All, or every so many where long tests are not wanted.
std::vector<TextbookPlant> some_of(const std::vector<TextbookPlant>& all, std::size_t step) {
  if (long_tests_are_wanted()) return all;
  std::vector<TextbookPlant> tried;
  for (std::size_t i = 0; i < all.size(); i += step) tried.push_back(all[i]);
  return tried;
}

INSTANTIATE_TEST_SUITE_P(All, TextbookPlants, ::testing::ValuesIn(some_of(textbook_plants(), 3)),
                         [](const auto& info) { return info.param.name; });

/// Which are hard: stiff, of several modes, or moving little between samples.
class HardTextbookPlants : public TextbookPlantsTest {};

TEST_P(HardTextbookPlants, HaveGainsOfUseForDeclaredDisturbances) {
  ASSERT_NO_FATAL_FAILURE(design(write("plant.yaml", plant_.file(true))));
  expect_gains_of_use(plant_.N, plant_.disturbance);
}

std::vector<TextbookPlant> hard_plants() {
  std::vector<TextbookPlant> hard;
  for (const TextbookPlant& plant : textbook_plants()) {
    for (const char* name : {"pendulum", "quarter_car", "aircraft_pitch", "flexible_shaft",
                             "satellite_attitude", "ship_heading", "hydraulic_servo"}) {
      if (plant.name == name) hard.push_back(plant);
    }
  }
  return hard;
}

INSTANTIATE_TEST_SUITE_P(All, HardTextbookPlants, ::testing::ValuesIn(some_of(hard_plants(), 2)),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace sampled_data_observers::test

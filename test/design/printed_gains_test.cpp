// The gains that the package ships for the papers' examples are at least as good as those that the
// papers print, by the figure that each of them is about.
#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "config/certificate_config.h"
#include "config/claimed_gains.h"
#include "config/design_config.h"
#include "config/law_config.h"
#include "design/analysis.h"
#include "design/workers.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers::test {
namespace {

struct ShippedExample {
  const char* folder;
  const char* plant;
  Objective objective;
};
void PrintTo(const ShippedExample& example, std::ostream* out) { *out << example.folder; }

class PrintedGainsTest : public ::testing::TestWithParam<ShippedExample> {
 protected:
  PrintedGainsTest() : config_(read_design_config({file(GetParam().plant)}, no_plant_plugins)) {
    const ConfigNode tree = read_yaml_file(file("gains.yaml"));
    ConfigSection root(tree, "");
    shipped_ = read_certificate(root, *config_.plant, gains_of(root))->certificate;
  }

  static std::string file(const std::string& name) {
    return std::string(SDO_SOURCE_DIR) + "/config/examples/" + GetParam().folder + "/" + name;
  }

  LawGains gains_of(ConfigSection& root) const {
    return read_law(root, {config_.plant, config_.names})->observer().gains();
  }

  /// The best certificate of the gains that the paper prints, for the shipped certificate's rate
  /// where that is not asked for.
  Certificate printed() const {
    const ConfigNode tree = read_yaml_file(file("gains_printed.yaml"));
    ConfigSection root(tree, "");
    AnalysisProblem problem;
    problem.theorem = shipped_.theorem;
    problem.subject = shipped_.subject;
    problem.gains = gains_of_theorem(root.section("gains"), *shipped_.theorem, shipped_.subject,
                                     gains_of(root));
    problem.objective = GetParam().objective;
    const std::string decay = shipped_.theorem->decay_parameter();
    if (problem.objective == Objective::kMinGamma) {
      problem.given[decay] = scalar_value(shipped_.values, decay);
    }
    SynthesisOptions options;
    options.jobs = default_jobs();
    return analyze(problem, options).certificate;
  }

  DesignConfig config_;
  Certificate shipped_;
};

TEST_P(PrintedGainsTest, AreNotBetterThanThoseThatAreShipped) {
  const Theorem& theorem = *shipped_.theorem;
  const Certificate certificate = printed();
  if (GetParam().objective == Objective::kMinGamma) {
    EXPECT_LE(theorem.gain_figure(shipped_.values).value,
              theorem.gain_figure(certificate.values).value);
  } else {
    EXPECT_GE(theorem.decay_figure(shipped_.values).value,
              theorem.decay_figure(certificate.values).value);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, PrintedGainsTest,
    ::testing::Values(
        ShippedExample{"ferrante2019_oscillator", "plant.yaml", Objective::kMinGamma},
        ShippedExample{"ferrante2019_unicycle", "plant.yaml", Objective::kMinGamma},
        ShippedExample{"etienne2019_dc_drive", "scenario.yaml", Objective::kMinGamma},
        ShippedExample{"bernard2022_bouncing_ball", "scenario.yaml", Objective::kMaxDecay},
        ShippedExample{"bernard2022_impulsive", "scenario.yaml", Objective::kMaxDecay}),
    [](const auto& info) { return std::string(info.param.folder); });

}  // namespace
}  // namespace sampled_data_observers::test

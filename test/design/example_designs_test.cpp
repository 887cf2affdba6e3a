// The shipped examples of etienne2019 and bernard2022: from their plant files to gain files that
// can be read, checked and run.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "config/certificate_config.h"
#include "config/design_config.h"
#include "config/law_config.h"
#include "design/gain_file.h"
#include "design/synthesis.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

std::shared_ptr<const PlantPlugin> no_plugins(const std::string&) { return nullptr; }

struct Example {
  const char* plant;
  const char* method;

  /// With the injection of outputs on which stated maps rest.
  std::string observer_file() const {
    const std::string path = std::string(SDO_SOURCE_DIR) + "/config/examples/" + plant;
    return path.substr(0, path.rfind('/')) + "/observer.yaml";
  }
};
void PrintTo(const Example& example, std::ostream* out) { *out << example.method; }

class ExampleDesigns : public testing::TestWithParam<Example> {};

TEST_P(ExampleDesigns, GiveGainFilesWhoseClaimsHoldWhenRead) {
  const std::string file =
      std::string(SDO_SOURCE_DIR) + "/config/examples/" + GetParam().plant + ".yaml";
  const DesignConfig config = read_design_config({file}, no_plugins);
  DesignProblem problem;
  problem.subject = config.subject;
  problem.given = config.parameters;
  SynthesisOptions options;
  options.jobs = 2;
  const Design design = synthesize(*find_design_method(GetParam().method), problem, options);
  std::ostringstream text;
  write_gain_file(design, {file, config.plant_hash, "test", "2000-01-01"}, text);

  const ConfigNode gains = read_yaml_text(text.str(), "gains.yaml");
  ConfigSection root(gains, "");
  const auto claim = read_certificate(
      root, *config.plant, read_law(root, {config.plant, config.names})->observer().gains());
  ASSERT_TRUE(claim) << text.str();
  const auto checks = check(claim->certificate);
  EXPECT_TRUE(all_hold(checks)) << describe_violations(checks);
  for (const auto& [name, value] : design.certificate.values) {
    EXPECT_EQ(value, claim->certificate.values.at(name)) << name;
  }
  std::vector<ConfigNode> trees = {read_yaml_file(file), gains};
  if (config.subject.plant.stated.A) trees.push_back(read_yaml_file(GetParam().observer_file()));
  EXPECT_NO_THROW(read_observer_config(merge(trees), no_plugins));
}

INSTANTIATE_TEST_SUITE_P(
    Shipped, ExampleDesigns,
    testing::Values(Example{"etienne2019_dc_drive/scenario", "etienne2019_proposition1"},
                    Example{"bernard2022_bouncing_ball/scenario", "bernard2022_equation26"},
                    Example{"bernard2022_impulsive/scenario", "bernard2022_equation36"},
                    Example{"bernard2022_neuron_jump_based/plant", "bernard2022_equation36"},
                    Example{"bernard2022_switched/scenario", "bernard2022_section7_3_2"}));

TEST(StatedErrorMaps, AreNeededWhereTheFlowIsGivenByFormulas) {
  const std::string folder =
      std::string(SDO_SOURCE_DIR) + "/config/examples/bernard2022_neuron_jump_based/";
  const DesignConfig config = read_design_config({folder + "plant.yaml"}, no_plugins);
  EXPECT_EQ(config.subject.plant.A()(0, 1), -1.0);
  EXPECT_THROW(matrices_of(*config.plant), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers

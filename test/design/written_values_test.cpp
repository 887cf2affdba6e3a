// What is written below any number of keys is what is read from there.
#include "design/written_values.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "config/named_values.h"
#include "design/gain_file.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "support/config_faults.h"

namespace sampled_data_observers::test {
namespace {

const std::vector<NamedShape> kShapes = {
    list_shape("timers/gps", 3),     matrix_shape("K/gps/0", 2, 1), symmetric_shape("P/0", 2),
    matrix_shape("K/wheel/0", 1, 2), scalar_shape("decay"),         matrix_shape("K/gps/1", 2, 1),
    list_shape("times", 1),          symmetric_shape("P/1", 2)};

NamedMatrices some_values() {
  NamedMatrices values;
  values["timers/gps"] = Eigen::RowVector3d(0.0, 0.1, 0.2 + 0.1);
  values["K/gps/0"] = Eigen::Vector2d(1.0 / 3.0, -1e-300);
  values["K/gps/1"] = Eigen::Vector2d(std::numeric_limits<double>::max(), 5e-324);
  values["K/wheel/0"] = Eigen::RowVector2d(1.5, 2.5);
  values["P/0"] = (Eigen::Matrix2d() << 2.0, 0.1, 0.1, 1.0).finished();
  values["P/1"] = Eigen::Matrix2d::Identity();
  values["decay"] = Eigen::MatrixXd::Constant(1, 1, 0.7);
  values["times"] = Eigen::MatrixXd::Constant(1, 1, 4.0);
  return values;
}

std::string written() {
  std::ostringstream out;
  out << "values:\n";
  write_named_values(kShapes, some_values(), out);
  return out.str();
}

NamedMatrices read(const std::string& text) {
  const ConfigNode tree = read_yaml_text(text, "test.yaml");
  ConfigSection section = ConfigSection(tree, "").section("values");
  NamedMatrices values = read_named_values(section, kShapes);
  section.finish();
  return values;
}

TEST(WrittenValuesTest, StandBelowTheirKeys) {
  EXPECT_EQ(0u, written().find("values:\n"
                               "  timers:\n"
                               "    gps: [0, 0.1, 0.30000000000000004]\n"
                               "  K:\n"
                               "    gps:\n"
                               "      \"0\": [[0.3333333333333333], [-1e-300]]\n"))
      << written();
}

TEST(WrittenValuesTest, AreAbridgedForPeople) {
  const std::string row = "    \"0\": [[1]]\n";
  const std::string long_list(300, '1');
  EXPECT_EQ(
      "gains:\n  P:\n" + row + row + "    # and 5 lines more\n  nu: 1\n",
      abridged_gain_file("gains:\n  P:\n" + row + row + row + row + row + row + row + "  nu: 1\n"));
  EXPECT_EQ("  P:\n" + row + row + row, abridged_gain_file("  P:\n" + row + row + row));
  EXPECT_EQ("  t: [0, ...\n", abridged_gain_file("  t: [0, " + long_list + "]\n"));
  EXPECT_EQ("  t: " + long_list + "\n", abridged_gain_file("  t: " + long_list + "\n"));
}

TEST(WrittenValuesTest, AreReadAsTheSameNumbers) { EXPECT_EQ(some_values(), read(written())); }

TEST(WrittenValuesTest, OtherKeysAndFormsAreRefused) {
  const auto changed = [](const std::string& from, const std::string& to) {
    return fault_of([&] { read(replaced(written(), from, to)); });
  };
  const Fault faults[] = {
      {"    wheel:\n", "    wheel:\n      7: [[0]]\n", {"values/K/wheel/7", "unknown"}},
      {"  K:\n", "  K:\n    Gps: 0\n", {"values/K/Gps", "unknown"}},
      {"      \"0\": [[1.5, 2.5]]", "      \"1\": [[1.5, 2.5]]", {"values/K/wheel/0", "missing"}},
      {"[[1.5, 2.5]]", "[1.5, 2.5]", {"values/K/wheel/0", "1 x 2"}},
      {"gps: [0, 0.1, ", "gps: [[0, 0.1, 0.2]] # ", {"values/timers/gps", "a list of 3"}},
      {"gps: [0, 0.1, ", "gps: [0, 0.1, 0.2, ", {"values/timers/gps", "a list of 3"}}};
  for (const Fault& fault : faults) {
    const std::string message = changed(fault.from, fault.to);
    EXPECT_EQ("", missing_parts(fault, message)) << message;
  }
}

}  // namespace
}  // namespace sampled_data_observers::test

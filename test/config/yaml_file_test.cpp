#include "sampled_data_observers/config/yaml_file.h"

#include <gtest/gtest.h>

namespace sampled_data_observers {
namespace {

std::string yaml_fault(const std::string& text) {
  try {
    read_yaml_text(text, "test.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(YamlFileTest, AliasesStandForWhatTheyName) {
  const ConfigNode root = read_yaml_text("a: &x [1, 2]\nb: *x\n", "test.yaml");
  ASSERT_EQ(2u, root.find("b")->items.size());
  EXPECT_EQ("2", root.find("b")->items[1].scalar);
}

TEST(YamlFileTest, AFewAliasesOfAliasesDoNotFillTheMemory) {
  std::string text = "a0: &a0 [1]\n";
  for (int level = 1; level < 15; ++level) {
    const std::string inner = "*a" + std::to_string(level - 1);
    text += "a" + std::to_string(level) + ": &a" + std::to_string(level) + " [" + inner;
    for (int i = 0; i < 9; ++i) text += ", " + inner;
    text += "]\n";
  }
  const std::string message = yaml_fault(text);
  for (const char* part : {"test.yaml:", "a5", "at most 200000 values"}) {
    EXPECT_NE(std::string::npos, message.find(part)) << message;
  }
}

TEST(YamlFileTest, ATokenThatBelongsToNoDocumentIsRefused) {
  for (const char* text : {",a: 1", "]", "}", "a: 1\n]", "a: 1\n--- \nb: 2"}) {
    EXPECT_NE("no fault", yaml_fault(text)) << text;
  }
}

}  // namespace
}  // namespace sampled_data_observers

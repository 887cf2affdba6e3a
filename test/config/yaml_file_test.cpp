#include "sampled_data_observers/config/yaml_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::fault_of;

std::string yaml_fault(const std::string& text) {
  return fault_of([&] { read_yaml_text(text, "test.yaml"); });
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

/// What a text of the largest size and more is refused with: never by quoting much of it.
std::string short_fault(const std::string& text) {
  const std::string message = yaml_fault(text);
  EXPECT_LT(message.size(), 300u);
  return message;
}

std::string repeated(const std::string& part, std::size_t bytes) {
  std::string text;
  while (text.size() < bytes) text += part;
  return text;
}

TEST(YamlFileTest, AFileThatIsTooLargeIsNotParsed) {
  EXPECT_EQ("test.yaml: expected at most 4000000 bytes, found 4000005",
            short_fault("a: 1\n" + std::string(4000000, '#')));
  const std::string path = testing::TempDir() + "too_large.yaml";
  std::ofstream(path) << repeated("a: [1]\n", 5000000);
  const auto read = [](const std::string& file) { return fault_of([&] { read_yaml_file(file); }); };
  EXPECT_NE(std::string::npos, read(path).find("expected at most 4000000 bytes, found 500000"));
  std::filesystem::remove(path);
  // Neither does what never ends fill the memory.
  EXPECT_EQ("/dev/zero: expected at most 4000000 bytes, found more", read("/dev/zero"));
}

TEST(YamlFileTest, TooManyKeysAndLevelsAreRefusedBeforeTheyTakeMemoryAndTime) {
  std::string keys;
  for (int i = 0; i < 190000; ++i) keys += "k" + std::to_string(i) + ": 1\n";
  EXPECT_EQ("test.yaml:1001: expected at most 1000 keys in a map, found more", short_fault(keys));
  EXPECT_EQ("test.yaml:1: expected at most 16 levels, found more",
            short_fault(std::string(3900000, '[')));
  EXPECT_EQ("test.yaml:1: expected at most 16 levels, found more",
            short_fault(repeated("- ", 3900000)));
  EXPECT_EQ("test.yaml:1: expected at most 400000 keys and values, found more",
            short_fault("a: [" + std::string(1900000, ',') + "]"));
}

TEST(YamlFileTest, TheLargestMatricesAreRead) {
  const std::string row = "[" + repeated("-1.2345678901234567, ", 200 * 21) + "1]";
  std::string text = "P: [" + row;
  for (int i = 1; i < 200; ++i) text += ", " + row;
  const ConfigNode root = read_yaml_text(text + "]", "test.yaml");
  EXPECT_EQ(200u, root.find("P")->items.size());
  EXPECT_EQ(201u, root.find("P")->items.back().items.size());
}

TEST(YamlFileTest, MessagesQuoteTheBeginOfLongTexts) {
  const std::string message =
      ConfigError("a.yaml:1", "x", "less", "'" + std::string(100000, 'y') + "'").what();
  EXPECT_LT(message.size(), 1100u);
  EXPECT_NE(std::string::npos, message.find("yyy... (100002 characters)"));
}

TEST(YamlFileTest, ATabThatIndentsIsNamed) {
  const auto refusal = [](const std::string& text) {
    return test::fault_of([&] { read_yaml_text(text, "a.yaml"); });
  };
  EXPECT_NE(std::string::npos, refusal("plant:\n  states: [p]\n\tinputs: [u]\nrate: 5\n")
                                   .find("line 3 is indented by a tab"));
  EXPECT_EQ(std::string::npos, refusal("plant: [p\n").find("tab"));
}

TEST(YamlFileTest, ATokenThatBelongsToNoDocumentIsRefused) {
  for (const char* text : {",a: 1", "]", "}", "a: 1\n]", "a: 1\n--- \nb: 2"}) {
    EXPECT_NE("no fault", yaml_fault(text)) << text;
  }
}

}  // namespace
}  // namespace sampled_data_observers

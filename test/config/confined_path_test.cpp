#include "config/confined_path.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace sampled_data_observers {
namespace {

namespace fs = std::filesystem;

class ConfinedPathTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "confined_path_XXXXXX").string();
    ASSERT_NE(nullptr, mkdtemp(name.data()));
    root_ = fs::canonical(name);
    inside_ = root_ / "gains";
    fs::create_directories(inside_ / "sub");
    fs::create_directories(root_ / "gains_of_others");
    for (const char* file :
         {"gains/a.yaml", "gains/sub/b.yaml", "outside.yaml", "gains_of_others/c.yaml"}) {
      std::ofstream(root_ / file) << "gains: {}";
    }
  }
  void TearDown() override { fs::remove_all(root_); }

  std::string confined(const fs::path& name) const {
    try {
      return confined_path(inside_.string(), name.string());
    } catch (const std::runtime_error& fault) {
      EXPECT_NE(std::string::npos, std::string(fault.what()).find(inside_.string()));
      return "refused";
    }
  }

  fs::path root_;
  fs::path inside_;
};

TEST_F(ConfinedPathTest, FindsFilesBelowTheDirectory) {
  EXPECT_EQ(inside_ / "a.yaml", confined("a.yaml"));
  EXPECT_EQ(inside_ / "sub/b.yaml", confined("sub/b.yaml"));
  EXPECT_EQ(inside_ / "a.yaml", confined("./sub/../a.yaml"));
  EXPECT_EQ(inside_ / "a.yaml", confined(inside_ / "a.yaml"));
}

TEST_F(ConfinedPathTest, NoPathLeavesTheDirectory) {
  EXPECT_EQ("refused", confined("../outside.yaml"));
  EXPECT_EQ("refused", confined("sub/../../outside.yaml"));
  EXPECT_EQ("refused", confined("../gains_of_others/c.yaml"));
  EXPECT_EQ("refused", confined(root_ / "outside.yaml"));
  EXPECT_EQ("refused", confined("/etc/passwd"));
}

TEST_F(ConfinedPathTest, NoSymbolicLinkLeavesTheDirectory) {
  fs::create_symlink(root_ / "outside.yaml", inside_ / "link.yaml");
  fs::create_directory_symlink(root_, inside_ / "up");
  fs::create_symlink("a.yaml", inside_ / "within.yaml");
  EXPECT_EQ("refused", confined("link.yaml"));
  EXPECT_EQ("refused", confined("up/outside.yaml"));
  EXPECT_EQ(inside_ / "a.yaml", confined("within.yaml"));
  EXPECT_EQ(inside_ / "a.yaml", confined("up/gains/a.yaml"));
}

TEST_F(ConfinedPathTest, TakesRegularFilesOnly) {
  ASSERT_EQ(0, mkfifo((inside_ / "pipe").c_str(), 0600));
  EXPECT_EQ("refused", confined("pipe"));
  EXPECT_EQ("refused", confined("sub"));
  EXPECT_EQ("refused", confined(""));
  EXPECT_EQ("refused", confined("missing.yaml"));
}

}  // namespace
}  // namespace sampled_data_observers

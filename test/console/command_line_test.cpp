#include "console/command_line.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "console/usage_error.h"

namespace sampled_data_observers {
namespace {

using Texts = std::vector<std::string>;

/// What a run printed, and its exit status.
struct Outcome {
  int status = 0;
  std::string printed;
  std::string faults;

  bool is_fault(Misuse misuse, const std::string& message) const {
    return status == static_cast<int>(misuse) && printed.empty() &&
           faults.compare(0, message.size() + 1, message + "\n") == 0;
  }
};

std::ostream& operator<<(std::ostream& stream, const Outcome& outcome) {
  return stream << outcome.status << "\n" << outcome.printed << outcome.faults;
}

Outcome run(const CommandLine& tool, const Texts& given) {
  std::vector<const char*> arguments = {"/path/to/tool"};
  for (const std::string& text : given) arguments.push_back(text.c_str());
  Outcome outcome;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  outcome.status = tool.run(static_cast<int>(arguments.size()), arguments.data());
  outcome.faults = testing::internal::GetCapturedStderr();
  std::fflush(stdout);
  outcome.printed = testing::internal::GetCapturedStdout();
  return outcome;
}

/// A tool with everything that there is.
class CommandLineOf : public testing::Test {
 protected:
  static constexpr int kDone = 7;

  CommandLineOf() {
    tool_.argument("BAG", bag_, "What to read");
    tool_.argument("CONFIG...", config_, "Files");
    tool_.option("-o, --output FILE", output_, "What to write").required();
    tool_.option("--rate NUMBER", rate_, "In all [Hz]");
    tool_.option("--jobs NUMBER", jobs_, "At a time").check(whole_number_at_least(1));
    tool_.option("--offset SECONDS", offset_, "May be negative");
    const Option& thin = tool_.option("--thin T1 T2", thin_, "Range").check(number_between(-5, 5));
    tool_.flag("--random", is_random_, "Anew each time").needs(thin);
    tool_.option("--set NAME=NUMBER...", set_, "Several");
    tool_.option("--object NAME", object_, "Of several").choices({"curve", "point"});
    tool_.action([] { return kDone; });
  }

  Outcome given(Texts more) {
    Texts texts = {"a.bag", "a.yaml", "-o", "x"};
    texts.insert(texts.end(), more.begin(), more.end());
    return run(tool_, texts);
  }

  CommandLine tool_{"tool", "Does it.", "Exit status: 7 done."};
  std::string bag_;
  Texts config_;
  std::string output_;
  double rate_ = 50.0;
  unsigned jobs_ = 2;
  std::optional<double> offset_;
  std::optional<std::array<double, 2>> thin_;
  bool is_random_ = false;
  Texts set_;
  std::string object_;
};

TEST_F(CommandLineOf, StoresWhatIsGivenAndLeavesTheRest) {
  EXPECT_EQ(kDone, run(tool_, {"a.bag", "a.yaml", "b.yaml", "-o", "x"}).status);
  EXPECT_EQ("a.bag", bag_);
  EXPECT_EQ((Texts{"a.yaml", "b.yaml"}), config_);
  EXPECT_EQ("x", output_);
  EXPECT_EQ(50.0, rate_);
  EXPECT_FALSE(offset_);
  EXPECT_FALSE(thin_);
  EXPECT_FALSE(is_random_);
}

TEST_F(CommandLineOf, TakesOptionsAnywhereAndInEachSpelling) {
  EXPECT_EQ(kDone, run(tool_, {"--rate=1e2", "a.bag", "-ox", "--thin", "1", "2", "a.yaml",
                               "--random", "--jobs", "3", "--object=point", "--random"})
                       .status);
  EXPECT_EQ("x", output_);
  EXPECT_EQ(100.0, rate_);
  EXPECT_EQ(3u, jobs_);
  EXPECT_EQ((std::array<double, 2>{1.0, 2.0}), *thin_);
  EXPECT_TRUE(is_random_);
  EXPECT_EQ("point", object_);
  EXPECT_EQ(Texts{"a.yaml"}, config_);
}

TEST_F(CommandLineOf, TakesNegativeNumbersAsValues) {
  EXPECT_EQ(kDone, given({"--offset", "-1e-3", "--rate=-1", "--thin", "-2", "-.5"}).status);
  EXPECT_EQ(-1e-3, *offset_);
  EXPECT_EQ(-1.0, rate_);
  EXPECT_EQ((std::array<double, 2>{-2.0, -0.5}), *thin_);
}

TEST_F(CommandLineOf, TakesSeveralValuesButLeavesOneForEachArgument) {
  EXPECT_EQ(
      kDone,
      run(tool_, {"-o", "x", "--set", "a=1", "b=-2", "--set", "c=3", "a.bag", "a.yaml"}).status);
  EXPECT_EQ((Texts{"a=1", "b=-2", "c=3"}), set_);
  EXPECT_EQ("a.bag", bag_);
  EXPECT_EQ(Texts{"a.yaml"}, config_);
}

TEST_F(CommandLineOf, TakesWhatStandsBehindTwoDashesForNoOption) {
  EXPECT_EQ(kDone,
            run(tool_, {"-o", "x", "--set", "a=1", "--", "--rate", "a.yaml", "--help"}).status);
  EXPECT_EQ(Texts{"a=1"}, set_);
  EXPECT_EQ("--rate", bag_);
  EXPECT_EQ((Texts{"a.yaml", "--help"}), config_);
}

TEST_F(CommandLineOf, RefusesWhatItDoesNotKnowAbbreviationsIncluded) {
  for (const std::string option : {"--obj", "--foo", "-x", "-1", "--Rate"}) {
    const Outcome outcome = given({option, "1"});
    EXPECT_TRUE(outcome.is_fault(Misuse::kUnknown, "tool: " + option + ": there is no such option"))
        << outcome;
    EXPECT_NE(std::string::npos, outcome.faults.find("See 'tool --help'.")) << outcome;
  }
}

TEST_F(CommandLineOf, RefusesValuesThatFailTheirCheckOrAreNoNumbers) {
  Outcome outcome = given({"--jobs", "0"});
  EXPECT_TRUE(
      outcome.is_fault(Misuse::kBadValue, "tool: --jobs: expected a whole number >= 1, found 0"))
      << outcome;
  outcome = given({"--jobs", "4294967296"});
  EXPECT_TRUE(outcome.is_fault(
      Misuse::kBadValue,
      "tool: --jobs: expected a whole number from 0 to 4294967295, found 4294967296"))
      << outcome;
  outcome = given({"--rate", "fast"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kBadValue, "tool: --rate: expected a number, found fast"))
      << outcome;
  outcome = given({"--thin", "1", "6"});
  EXPECT_TRUE(
      outcome.is_fault(Misuse::kBadValue, "tool: --thin: expected a number from -5 to 5, found 6"))
      << outcome;
  outcome = given({"--object", "plane"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kBadValue,
                               "tool: --object: expected one of curve, point, found plane"))
      << outcome;
}

TEST_F(CommandLineOf, RefusesAnotherNumberOfValues) {
  for (const Texts& lacking : {Texts{"--rate"}, Texts{"--rate="}}) {
    const Outcome outcome = given(lacking);
    EXPECT_TRUE(
        outcome.is_fault(Misuse::kWrongCount, "tool: --rate: expected NUMBER, found nothing"))
        << outcome;
  }
  Outcome outcome = given({"--thin", "1"});
  EXPECT_TRUE(
      outcome.is_fault(Misuse::kWrongCount, "tool: --thin: expected T1 T2, found fewer values"))
      << outcome;
  outcome = given({"--thin", "1", "--rate", "2"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kWrongCount,
                               "tool: --thin: expected T1 T2, found the option --rate"))
      << outcome;
  outcome = given({"--rate", "1", "--rate", "2"});
  EXPECT_TRUE(
      outcome.is_fault(Misuse::kWrongCount, "tool: --rate: expected NUMBER once, found 2 values"))
      << outcome;
  outcome = given({"--random=no"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kWrongCount, "tool: --random: expected no value, found one"))
      << outcome;
}

TEST_F(CommandLineOf, RefusesWhatLacksAnArgumentOrAnOption) {
  Outcome outcome = run(tool_, {"-o", "x"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kMissing, "tool: BAG: expected, but not given")) << outcome;
  outcome = run(tool_, {"a.bag", "-o", "x"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kMissing, "tool: CONFIG...: expected, but not given"))
      << outcome;
  outcome = run(tool_, {"a.bag", "a.yaml"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kMissing, "tool: --output FILE: expected, but not given"))
      << outcome;
  outcome = given({"--random"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kNeedsAnother, "tool: --random: needs --thin T1 T2"))
      << outcome;
}

TEST(CommandLine, RefusesFurtherArguments) {
  std::string first;
  CommandLine tool("tool", "Does it.", "");
  tool.argument("FIRST", first, "The only one");
  tool.action([] { return 0; });
  EXPECT_EQ(0, run(tool, {"a"}).status);
  const Outcome outcome = run(tool, {"a", "b"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kUnknown, "tool: b: expected no further argument"))
      << outcome;
}

TEST(CommandLine, TakesAnActionsUsageErrorForOne) {
  CommandLine tool("tool", "Does it.", "");
  tool.action([]() -> int { throw UsageError("--a and --b", "contradict each other"); });
  const Outcome outcome = run(tool, {});
  EXPECT_TRUE(outcome.is_fault(Misuse::kBadValue, "tool: --a and --b: contradict each other"))
      << outcome;
}

TEST_F(CommandLineOf, ExplainsItselfWhateverElseIsGiven) {
  const std::string page =
      "Usage: tool BAG CONFIG... --output FILE [OPTIONS]\n"
      "\n"
      "Does it.\n"
      "\n"
      "Arguments:\n"
      "  BAG                       What to read\n"
      "  CONFIG...                 Files\n"
      "\n"
      "Options:\n"
      "  -o, --output FILE         What to write (required)\n"
      "      --rate NUMBER         In all [Hz] (default: 50)\n"
      "      --jobs NUMBER         At a time (default: 2)\n"
      "      --offset SECONDS      May be negative\n"
      "      --thin T1 T2          Range\n"
      "      --random              Anew each time (needs --thin)\n"
      "      --set NAME=NUMBER...  Several\n"
      "      --object NAME         Of several\n"
      "                            One of curve, point\n"
      "  -h, --help                Print this page\n"
      "\n"
      "Exit status: 7 done.\n";
  for (const Texts& asking : {Texts{"--help"}, Texts{"-h"}, Texts{"--foo", "a", "--help"}}) {
    const Outcome outcome = run(tool_, asking);
    EXPECT_EQ(0, outcome.status);
    EXPECT_EQ(page, outcome.printed);
    EXPECT_EQ("", outcome.faults);
  }
}

class Commands : public testing::Test {
 protected:
  Commands() {
    CommandLine& verify = tool_.command("verify", "Check it.");
    verify.argument("GAINS", gains_, "File");
    verify.action([] { return 4; });
    tool_.command("explain", "Say why.").action([] { return 5; });
  }

  CommandLine tool_{"design", "Designs.", "Exit status: 0 done."};
  std::string gains_;
};

TEST_F(Commands, AreChosenByTheFirstArgument) {
  EXPECT_EQ(4, run(tool_, {"verify", "explain"}).status);
  EXPECT_EQ("explain", gains_);
  EXPECT_EQ(5, run(tool_, {"explain"}).status);
  const Outcome outcome = run(tool_, {"verify", "--foo"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kUnknown, "design verify: --foo: there is no such option"))
      << outcome;
}

TEST_F(Commands, AreNeeded) {
  Outcome outcome = run(tool_, {});
  EXPECT_TRUE(outcome.is_fault(Misuse::kMissing,
                               "design: COMMAND: expected one of verify, explain, found nothing"))
      << outcome;
  outcome = run(tool_, {"verif", "a"});
  EXPECT_TRUE(outcome.is_fault(Misuse::kMissing,
                               "design: COMMAND: expected one of verify, explain, found verif"))
      << outcome;
}

TEST_F(Commands, HavePagesOfTheirOwn) {
  EXPECT_EQ(
      "Usage: design COMMAND ...\n"
      "\n"
      "Designs.\n"
      "\n"
      "Commands:\n"
      "  verify                    Check it.\n"
      "  explain                   Say why.\n"
      "\n"
      "Options:\n"
      "  -h, --help                Print this page\n"
      "\n"
      "'design COMMAND --help' tells more of a command.\n"
      "Exit status: 0 done.\n",
      run(tool_, {"--help"}).printed);
  EXPECT_EQ(
      "Usage: design verify GAINS [OPTIONS]\n"
      "\n"
      "Check it.\n"
      "\n"
      "Arguments:\n"
      "  GAINS                     File\n"
      "\n"
      "Options:\n"
      "  -h, --help                Print this page\n"
      "\n"
      "Exit status: 0 done.\n",
      run(tool_, {"verify", "-h"}).printed);
}

}  // namespace
}  // namespace sampled_data_observers

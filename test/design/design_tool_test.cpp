// The tool `design` on good and bad input: what it says, and its exit status.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

namespace sampled_data_observers {
namespace {

namespace fs = std::filesystem;

struct ToolRun {
  int status = -1;
  std::string output;

  bool says(const std::string& text) const { return output.find(text) != std::string::npos; }
};

class DesignTool : public testing::Test {
 protected:
  void SetUp() override {
    std::string path = (fs::temp_directory_path() / "design-tool-XXXXXX").string();
    ASSERT_NE(::mkdtemp(path.data()), nullptr);
    folder_ = path;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  std::string read(const std::string& name) const {
    std::ifstream file(path(name));
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  static ToolRun run(const std::string& arguments, const std::string& environment = "") {
    const std::string command = environment + " " SDO_DESIGN_TOOL " " + arguments + " 2>&1";
    ToolRun result;
    FILE* pipe = ::popen(command.c_str(), "r");
    char buffer[4096];
    for (std::size_t got = 0; (got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) {
      result.output.append(buffer, got);
    }
    const int status = ::pclose(pipe);
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
  }

  ToolRun synthesize(const std::string& plant, const std::string& options = "",
                     const std::string& environment = "") const {
    const bool has_objective = options.find("--objective") != std::string::npos;
    return run("synthesize " + plant + " --method ferrante2019_proposition2 -o " +
                   path("gains.yaml") + (has_objective ? " " : " --objective feasible ") + options,
               environment);
  }

  /// An oscillator of which the position is measured, with `replacement` in place of a part.
  static std::string oscillator(const std::string& part = "", const std::string& replacement = "") {
    std::string text =
        "plant:\n"
        "  states: [z1, z2]\n"
        "  A: [[0, 1], [-4, 0]]\n"
        "sensors:\n"
        "  position:\n"
        "    C: [[1, 0]]\n"
        "    source: {topic: position}\n"
        "design:\n"
        "  sampling: {T1: 0.1, T2: 0.3}\n"
        "  parameters: {lambda_t: 0.05, delta: 3}\n";
    if (!part.empty()) text.replace(text.find(part), part.size(), replacement);
    return text;
  }

  /// A plant and its gains, of which many tests ask something: designed once.
  void write_designed_oscillator() const {
    write("plant.yaml", oscillator());
    static const std::string kGains = [this] {
      const ToolRun made = synthesize(path("plant.yaml"));
      EXPECT_EQ(made.status, 0) << made.output;
      return read("gains.yaml");
    }();
    write("gains.yaml", kGains);
  }

  /// A gain file for x' = −x/8 and y = x, of which M(0) is singular where δ = 2.25.
  std::string write_scalar_claim(const std::string& delta) const {
    const std::string plant = write("scalar.yaml",
                                    "plant: {states: [x], A: [[-0.125]]}\n"
                                    "sensors: {s: {C: [[1]], source: {topic: s}}}\n");
    const std::string claim =
        "observer: IntersampleInjectionObserver\n"
        "gains: {L: [[1]], H: [[-0.125]]}\n"
        "certificate:\n"
        "  theorem: ferrante2019_theorem2\n"
        "  plant: {file: scalar.yaml, hash: HASH}\n"
        "  T1: 0.125\n"
        "  T2: 0.125\n"
        "  delta: " +
        delta +
        "\n"
        "  lambda_t: 0.125\n"
        "  P1: [[1]]\n"
        "  P2: [[0.5]]\n";
    // The tool tells the hash that it expects.
    const ToolRun wrong = run("verify " + write("claim.yaml", claim));
    const std::string before = "scalar.yaml, ";
    const std::size_t at = wrong.output.find(before);
    EXPECT_EQ(wrong.status, 1);
    EXPECT_NE(at, std::string::npos) << wrong.output;
    const std::string hash = wrong.output.substr(at + before.size(), 36);
    std::string right = claim;
    right.replace(right.find("HASH"), 4, hash);
    return write("claim.yaml", right);
  }

  fs::path folder_;
};

TEST_F(DesignTool, RefusesAssumptionsThatItDoesNotKnowOrThatLimitNothing) {
  const ToolRun misspelt =
      run("synthesize " + write("plant.yaml", oscillator() + "error_assumptions: {nois: 0.1}\n") +
          " -o " + path("gains.yaml"));
  EXPECT_EQ(misspelt.status, 1) << misspelt.output;
  EXPECT_TRUE(misspelt.says("nois")) << misspelt.output;
  const ToolRun exact =
      run("synthesize " + write("plant.yaml", oscillator() + "error_assumptions: {noise: 0}\n") +
          " -o " + path("gains.yaml"));
  EXPECT_EQ(exact.status, 1) << exact.output;
  EXPECT_TRUE(exact.says("found noise: 0 and no disturbance")) << exact.output;
}

/// By the table that is printed, and by the gains that are written.
TEST_F(DesignTool, TakesTheMethodThatServesTheObjectiveBest) {
  const std::string plant =
      write("plant.yaml", oscillator("  parameters: {lambda_t: 0.05, delta: 3}\n") +
                              "error_assumptions: {noise: 0.1, disturbance: 0}\n");
  const ToolRun fastest =
      run("synthesize " + plant + " --objective max-decay -o " + path("gains.yaml"));
  EXPECT_EQ(fastest.status, 0) << fastest.output;
  EXPECT_TRUE(fastest.says("1/100 after [s]")) << fastest.output;
  double least = 1e9;
  double taken = -1.0;
  std::istringstream lines(fastest.output);
  const std::string name = fastest.output.substr(fastest.output.find("taken: ") + 7);
  for (std::string line; std::getline(lines, line) && line.rfind("taken", 0) != 0;) {
    std::istringstream words(line);
    std::string method;
    double time = 0.0;
    double bound = 0.0;
    if (!(words >> method >> time >> bound)) continue;
    least = std::min(least, time);
    if (name.rfind(method + "\n", 0) == 0) taken = time;
  }
  EXPECT_EQ(taken, least) << fastest.output;
}

TEST_F(DesignTool, MakesAGainFileThatVerifiesAndProves) {
  write_designed_oscillator();
  const ToolRun verified = run("verify " + path("gains.yaml"));
  EXPECT_EQ(verified.status, 0) << verified.output;
  EXPECT_TRUE(verified.says("holds"));
  const ToolRun proved = run("verify --rigorous " + path("gains.yaml"));
  EXPECT_EQ(proved.status, 0) << proved.output;
  EXPECT_TRUE(proved.says("proved    M(T2) <= 0"));
}

TEST_F(DesignTool, TellsOfManyConditionsOfAKindByOne) {
  const std::string folder = SDO_SOURCE_DIR "/config/examples/ferrante2019_oscillator/";
  const ToolRun proved = run("verify --rigorous " + folder + "gains_timer_dependent.yaml");
  EXPECT_EQ(proved.status, 0) << proved.output;
  EXPECT_TRUE(proved.says("flow of cell 0 at node 0")) << proved.output;
  EXPECT_FALSE(proved.says("flow of cell 1 at node 1")) << proved.output;
  EXPECT_TRUE(proved.says(" more of its kind")) << proved.output;
  EXPECT_LT(std::count(proved.output.begin(), proved.output.end(), '\n'), 40) << proved.output;
}

TEST_F(DesignTool, RecordsAProofInTheGainFile) {
  write_designed_oscillator();
  const std::string made = read("gains.yaml");
  const std::string key = "proof_hash: ";
  const auto hash = [&](const std::string& text) {
    const std::size_t at = text.find(key);
    return at == std::string::npos ? "" : text.substr(at, key.size() + 36);
  };
  ASSERT_NE(hash(made), "");
  std::string without = made;
  without.erase(without.find(key), key.size() + 36);
  write("gains.yaml", without);
  EXPECT_EQ(run("verify --rigorous " + path("gains.yaml")).status, 0);
  EXPECT_EQ(read("gains.yaml"), without);
  const ToolRun recorded = run("verify --rigorous --record " + path("gains.yaml"));
  EXPECT_EQ(recorded.status, 0) << recorded.output;
  EXPECT_EQ(hash(read("gains.yaml")), hash(made));
  // What is not proved is not recorded.
  std::string wrong = without;
  wrong.insert(wrong.find("L: [[") + 5, "-1");
  write("gains.yaml", wrong);
  EXPECT_EQ(run("verify --rigorous --record " + path("gains.yaml")).status, 2);
  EXPECT_EQ(read("gains.yaml"), wrong);
  EXPECT_NE(run("verify --record " + path("gains.yaml")).status, 0);
}

TEST_F(DesignTool, WritesAProofOfItsOwnForTheBoundAtRunTime) {
  const std::string plant =
      write("plant.yaml", oscillator("design:\n", "design:\n  N: [[1], [0]]\n  C_p: [[1, 0]]\n"));
  const ToolRun made = synthesize(plant, "--objective min-gamma");
  ASSERT_EQ(made.status, 0) << made.output;
  const std::string file = read("gains.yaml");
  EXPECT_NE(file.find("\nrun_time_certificate:\n"), std::string::npos) << file;
  EXPECT_TRUE(made.says("by the proof for min-final-error"));
  const ToolRun proved = run("verify --rigorous --record " + path("gains.yaml"));
  EXPECT_EQ(proved.status, 0) << proved.output;
  EXPECT_TRUE(proved.says("for the error bound at run time (run_time_certificate):"));
  // Recording what is recorded changes nothing but the place of the lines.
  const auto lines = [](const std::string& text) {
    std::istringstream in(text);
    std::multiset<std::string> all;
    for (std::string line; std::getline(in, line);) all.insert(line);
    return all;
  };
  EXPECT_EQ(lines(read("gains.yaml")), lines(file));
  // A run-time certificate that does not hold is found.
  std::string wrong = file;
  wrong.insert(wrong.find("lambda_t: ", wrong.find("run_time_certificate")) + 10, "1");
  write("gains.yaml", wrong);
  EXPECT_EQ(run("verify " + path("gains.yaml")).status, 2);
}

TEST_F(DesignTool, DisprovesAGainFileWithAnotherGain) {
  write_designed_oscillator();
  std::string gains = read("gains.yaml");
  const std::size_t at = gains.find("L: [[") + 5;
  gains.replace(at, gains.find(']', at) - at, "-100");
  write("gains.yaml", gains);
  const ToolRun checked = run("verify " + path("gains.yaml"));
  EXPECT_EQ(checked.status, 2) << checked.output;
  EXPECT_TRUE(checked.says("VIOLATED"));
  const ToolRun disproved = run("verify --rigorous " + path("gains.yaml"));
  EXPECT_EQ(disproved.status, 2) << disproved.output;
  EXPECT_TRUE(disproved.says("disproved M(0) <= 0"));
}

TEST_F(DesignTool, TellsWhatItCannotDecide) {
  const ToolRun undecided = run("verify --rigorous " + write_scalar_claim("2.25"));
  EXPECT_EQ(undecided.status, 4) << undecided.output;
  EXPECT_TRUE(undecided.says("undecided M(0) <= 0"));
  EXPECT_TRUE(undecided.says("too close to zero"));
  const ToolRun proved = run("verify --rigorous " + write_scalar_claim("2.5"));
  EXPECT_EQ(proved.status, 0) << proved.output;
}

TEST_F(DesignTool, RefusesAMatrixThatIsNotSquare) {
  const ToolRun refused =
      synthesize(write("plant.yaml", oscillator("[[0, 1], [-4, 0]]", "[[0, 1, 0], [-4, 0, 0]]")));
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(refused.says("plant/A: expected a 2 x 2 matrix")) << refused.output;
}

TEST_F(DesignTool, RefusesNumbersThatAreNone) {
  const ToolRun in_file = synthesize(write("plant.yaml", oscillator("-4", ".nan")));
  EXPECT_EQ(in_file.status, 1);
  EXPECT_TRUE(in_file.says("plant/A")) << in_file.output;
  EXPECT_TRUE(in_file.says("finite number")) << in_file.output;
  const ToolRun given = synthesize(write("plant.yaml", oscillator()), "--set delta=nan");
  EXPECT_EQ(given.status, 1);
  EXPECT_TRUE(given.says("parameter delta: expected a finite number")) << given.output;
}

TEST_F(DesignTool, RefusesOptionsThatAreNoNumbers) {
  const std::string plant = write("plant.yaml", oscillator());
  const std::string commands[] = {
      "synthesize " + plant + " --method ferrante2019_proposition2 -o " + path("gains.yaml"),
      "analyze " + path("gains.yaml"), "explain " + plant,
      "sweep " + plant + " -o " + path("folder")};
  for (const std::string& command : commands) {
    for (const std::string option : {"--T1", "--T2"}) {
      for (const std::string value : {"nan", "-1"}) {
        const bool is_range = option == "--T2" && command.find("sweep") == 0;
        const ToolRun refused = run(command + " " + option + " " + value + (is_range ? " 1" : ""));
        EXPECT_GT(refused.status, 99) << command;
        const bool may_be_zero = option == "--T1" && command.find("sweep") != 0;
        EXPECT_TRUE(refused.says(option + ": expected a number " + (may_be_zero ? ">= 0" : "> 0") +
                                 ", found " + value))
            << refused.output;
      }
    }
    if (command.find("explain") == 0) continue;
    EXPECT_TRUE(run(command + " --time-limit nan").says("expected a number >= 0, found nan"));
    EXPECT_TRUE(run(command + " --jobs 0").says("expected a whole number >= 1, found 0"));
  }
  EXPECT_FALSE(fs::exists(path("gains.yaml")));
}

TEST_F(DesignTool, TakesTimesWithoutEndAndDwellTimesWhereTheTheoremDoes) {
  const std::string plant = write(
      "plant.yaml",
      "plant: {states: [a, b], A: [[0, 1], [0, -0.1]], jump_map: {A_d: [[-1, 0], [0, -0.8]]}}\n"
      "sensors: {contact: {C: [[1, 0]], measured: at_jumps}, eye: {C: [[1, 0]], measured: "
      "continuous}}\n");
  const std::string to = "synthesize " + plant + " --objective feasible -o " + path("gains.yaml");
  const ToolRun without_end = run(to + " --T1 0.5 --T2 inf --method bernard2022_equation22");
  EXPECT_EQ(without_end.status, 0) << without_end.output;
  EXPECT_TRUE(without_end.says("  T2: .inf\n")) << without_end.output;
  EXPECT_TRUE(without_end.says("sampling: {T1: 0.5, T2: .inf}")) << without_end.output;
  EXPECT_EQ(run("verify " + path("gains.yaml")).status, 0);
  const ToolRun declared =
      run(to + " --T1 0.5 --T2 inf --method bernard2022_equation22 " +
          write("declared.yaml",
                "error_assumptions: {initial_error: 1, noise: 0.1, output_rate: 2}\n"));
  EXPECT_EQ(declared.status, 0) << declared.output;
  const ToolRun refused = run(to + " --T1 0 --T2 inf --method bernard2022_equation26");
  EXPECT_NE(refused.status, 0);
  EXPECT_TRUE(refused.says("up to a longest one: T2 = inf")) << refused.output;

  const ToolRun averaged = run(to + " --reverse-average-dwell-time 0.5 3");
  EXPECT_EQ(averaged.status, 0) << averaged.output;
  EXPECT_TRUE(averaged.says("  reverse_average_dwell_time: {tau: 0.5, N0: 3}\n"));
  EXPECT_FALSE(averaged.says("sampling:"));
  EXPECT_EQ(run("verify " + path("gains.yaml")).status, 0);
  EXPECT_NE(run(to + " --reverse-average-dwell-time 0.5 3 --T2 1").status, 0);
  EXPECT_NE(run(to + " --reverse-average-dwell-time 0.5 2.5").status, 0);
  EXPECT_NE(run(to + " --average-dwell-time 0 2").status, 0);
}

TEST_F(DesignTool, RefusesAbbreviatedOptions) {
  const ToolRun refused = synthesize(write("plant.yaml", oscillator()), "--obj feasible");
  EXPECT_GT(refused.status, 99);
  EXPECT_TRUE(
      refused.says("design synthesize: --obj: there is no such option\n"
                   "See 'design synthesize --help'."))
      << refused.output;
}

TEST_F(DesignTool, SaysWhichObjectivesAMethodCanServe) {
  const std::string plant = write("plant.yaml", oscillator());  // no disturbance
  const std::string expected =
      "can't serve the objective min-gamma for this plant; it can serve feasible, max-T2, "
      "max-decay";
  const ToolRun made = synthesize(plant, "--objective min-gamma");
  EXPECT_EQ(made.status, 1);
  EXPECT_TRUE(made.says(expected)) << made.output;
  const ToolRun swept = run("sweep " + plant + " -o " + path("folder") +
                            " --method ferrante2019_proposition2 --objective min-gamma");
  EXPECT_EQ(swept.status, 1);
  EXPECT_TRUE(swept.says(expected)) << swept.output;
}

TEST_F(DesignTool, SaysWhatADesignForTheLeastGainCosts) {
  const std::string plant = write(
      "plant.yaml", oscillator("  parameters", "  N: [[1], [0]]\n  C_p: [[1, 0]]\n  parameters"));
  const ToolRun bounded = synthesize(plant, "--objective min-gamma --set gain_bound=3");
  ASSERT_EQ(bounded.status, 0) << bounded.output;
  EXPECT_TRUE(bounded.says("in the end, for |noise| <= 1")) << bounded.output;
  EXPECT_TRUE(bounded.says("is near gain_bound = 3")) << bounded.output;
  EXPECT_FALSE(bounded.says("of events T2 apart")) << bounded.output;
  const ToolRun free = synthesize(plant, "--set gain_bound=1e6 --T1 0");
  ASSERT_EQ(free.status, 0) << free.output;
  EXPECT_FALSE(free.says("is near gain_bound")) << free.output;
  // The noise of samples as dense as one likes adds up to more than the figure.
  EXPECT_TRUE(free.says("of events T2 apart")) << free.output;
}

TEST_F(DesignTool, SaysThatAnAnalysisFoundNoLargestValue) {
  const std::string decaying = write("decaying.yaml",
                                     "plant: {states: [z1, z2], A: [[-1, 0], [0, -2]]}\n"
                                     "sensors: {s: {C: [[1, 0]], source: {topic: s}}}\n");
  const std::string gains = write("gains.yaml",
                                  "observer: IntersampleInjectionObserver\n"
                                  "sampling: {T1: 0.1, T2: 0.3}\n"
                                  "gains: {L: [[0], [0]], H: [[-1]]}\n");
  const std::string command = "analyze " + gains + " --plant " + decaying +
                              " --theorem ferrante2019_corollary1 --objective max-T2 --set "
                              "lambda_t=0.05";
  const ToolRun unlimited = run(command);
  EXPECT_EQ(unlimited.status, 0) << unlimited.output;
  EXPECT_TRUE(unlimited.says("no largest or least value was found")) << unlimited.output;
  const ToolRun unknown = run(command + " --set foo=3");
  EXPECT_EQ(unknown.status, 1) << unknown.output;
}

TEST_F(DesignTool, ExplainsFirstThatNothingCanConverge) {
  const std::string plant =
      write("plant.yaml", oscillator("[[0, 1], [-4, 0]]", "[[-0.1, 0], [0.2, 0.5]]"));
  const ToolRun explained = run("explain " + plant);
  EXPECT_EQ(explained.output.find("NO OBSERVER CAN CONVERGE"), 0u) << explained.output;
  EXPECT_TRUE(explained.says("- not detectable")) << explained.output;
  EXPECT_FALSE(explained.says("applies: ")) << explained.output;
  EXPECT_TRUE(explained.says("states that y shows")) << explained.output;
  EXPECT_FALSE(run("explain " + write("plant.yaml", oscillator())).says("states that y shows"));
  EXPECT_GT(run("explain " + plant + " --plot x.gif").status, 99);
  const ToolRun without_longest = run("explain " + plant + " --T1 0.5 --T2 inf");
  EXPECT_EQ(0, without_longest.status) << without_longest.output;
  EXPECT_TRUE(without_longest.says("[0.5, inf] s")) << without_longest.output;
}

TEST_F(DesignTool, NamesTheModeThatCannotBeDetected) {
  const ToolRun refused =
      synthesize(write("plant.yaml", oscillator("[[0, 1], [-4, 0]]", "[[0, 0], [1, 2]]")));
  EXPECT_EQ(refused.status, 3);
  EXPECT_TRUE(refused.says("not detectable")) << refused.output;
  EXPECT_TRUE(refused.says("eigenvalue 2 1/s, which moves z2")) << refused.output;
  EXPECT_TRUE(refused.says("Measure another output")) << refused.output;
}

TEST_F(DesignTool, RefusesTimesInTheWrongOrder) {
  const ToolRun in_file = synthesize(write("plant.yaml", oscillator("T1: 0.1", "T1: 0.4")));
  EXPECT_EQ(in_file.status, 1);
  EXPECT_TRUE(in_file.says("design/sampling/T2: expected a number not less than T1"))
      << in_file.output;
  const ToolRun given = synthesize(write("plant.yaml", oscillator()), "--T1 0.4");
  EXPECT_EQ(given.status, 1);
  EXPECT_TRUE(given.says("T1 = 0.4 s is larger than T2 = 0.3 s")) << given.output;
  EXPECT_TRUE(synthesize(write("plant.yaml", oscillator()), "--T2 -1").says("--T2"));
}

TEST_F(DesignTool, SaysWhatToChangeWhereThereIsNoDesign) {
  const ToolRun none = synthesize(write("plant.yaml", oscillator()), "--set gain_bound=0.1");
  EXPECT_EQ(none.status, 3);
  EXPECT_TRUE(none.says("found no design")) << none.output;
  EXPECT_TRUE(none.says("larger bound on the gain")) << none.output;
  EXPECT_FALSE(fs::exists(path("gains.yaml")));
}

TEST_F(DesignTool, SurvivesASolverThatTakesTooLong) {
  const ToolRun none = synthesize(write("plant.yaml", oscillator()), "--time-limit 0");
  EXPECT_EQ(none.status, 3);
  EXPECT_TRUE(none.says("took longer than the time limit")) << none.output;
}

TEST_F(DesignTool, TakesTheTimesOfAnObserversConfigurationWhereThePlantHasNoneForIt) {
  const std::string plant =
      "sampling: {T1: 0.1, T2: 0.25}\n" + oscillator("  sampling: {T1: 0.1, T2: 0.3}\n", "");
  const ToolRun made = synthesize(write("plant.yaml", plant));
  EXPECT_EQ(made.status, 0) << made.output;
  EXPECT_NE(read("gains.yaml").find("sampling: {T1: 0.1, T2: 0.25}"), std::string::npos)
      << read("gains.yaml");
}

TEST_F(DesignTool, NamesWhatIsMissing) {
  const ToolRun no_times =
      synthesize(write("plant.yaml", oscillator("  sampling: {T1: 0.1, T2: 0.3}\n", "")));
  EXPECT_EQ(no_times.status, 1);
  EXPECT_TRUE(no_times.says("design/sampling")) << no_times.output;
  const ToolRun no_A = synthesize(write("plant.yaml", oscillator("  A: [[0, 1], [-4, 0]]\n", "")));
  EXPECT_EQ(no_A.status, 1);
  EXPECT_TRUE(no_A.says("plant")) << no_A.output;
  const ToolRun no_C = synthesize(write("plant.yaml", oscillator("    C: [[1, 0]]\n", "")));
  EXPECT_EQ(no_C.status, 1);
  EXPECT_TRUE(no_C.says("sensors/position")) << no_C.output;
  const ToolRun no_file = synthesize(path("nowhere.yaml"));
  EXPECT_EQ(no_file.status, 1);
  EXPECT_TRUE(no_file.says("nowhere.yaml")) << no_file.output;
  const ToolRun no_claim = run("verify --plant " + write("plant.yaml", oscillator()) + " -- " +
                               write("bare.yaml", "gains: {L: [[1], [1]], H: [[0]]}\n"));
  EXPECT_EQ(no_claim.status, 1);
  EXPECT_TRUE(no_claim.says("certificate")) << no_claim.output;
}

TEST_F(DesignTool, RefusesParametersThatAMethodDoesNotHave) {
  const ToolRun refused = synthesize(write("plant.yaml", oscillator()), "--set alpha=1");
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(refused.says("has no parameter 'alpha'; it has lambda_t, delta, gain_bound"))
      << refused.output;
}

TEST_F(DesignTool, TakesFromAPlantFileTheParametersThatTheMethodHas) {
  const std::string parameters = "{lambda_t: 0.05, delta: 3}";
  const std::string of_several =
      write("plant.yaml", oscillator(parameters, "{lambda_t: 0.05, delta: 3, alpha: 1}"));
  const ToolRun made = synthesize(of_several);
  EXPECT_EQ(made.status, 0) << made.output;
  EXPECT_NE(read("gains.yaml").find("delta: 3\n"), std::string::npos);
  const std::string unknown =
      write("unknown.yaml", oscillator(parameters, "{lambda_t: 0.05, delt: 3}"));
  const std::string expected = "no method has a parameter 'delt'";
  EXPECT_TRUE(synthesize(unknown).says(expected));
  const ToolRun bare = run("synthesize " + unknown + " -o " + path("gains.yaml"));
  EXPECT_EQ(bare.status, 1);
  EXPECT_TRUE(bare.says(expected)) << bare.output;
}

TEST_F(DesignTool, AnalyzesNoGainWithoutPerformanceOutput) {
  const std::string plant =
      write("plant.yaml", oscillator("  parameters", "  N: [[1], [0]]\n  parameters"));
  const std::string gains = write("given.yaml",
                                  "observer: IntersampleInjectionObserver\n"
                                  "sampling: {T1: 0.1, T2: 0.3}\n"
                                  "gains: {L: [[2.067], [-3]], H: [[-1.384]]}\n");
  const std::string command = "analyze " + gains + " --plant " + plant;
  const ToolRun refused = run(command + " --objective min-gamma");
  EXPECT_EQ(refused.status, 1) << refused.output;
  EXPECT_TRUE(refused.says("a gain needs design/N")) << refused.output;
  const ToolRun all = run(command + " --set delta=3");
  EXPECT_EQ(all.status, 0) << all.output;
  EXPECT_FALSE(all.says("min-gamma")) << all.output;
  EXPECT_TRUE(all.says("max-T2")) << all.output;
}

TEST_F(DesignTool, SpeaksOfNoObserverThatComputesWithOtherGains) {
  const std::string example = SDO_SOURCE_DIR "/config/examples/bernard2022_switched/";
  std::ostringstream text;
  text << std::ifstream(example + "gains.yaml").rdbuf();
  std::string projecting = text.str();
  const std::string section = "\ngains:\n";
  projecting.insert(projecting.find(section) + section.size(),
                    "  projection: {1: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}\n");
  const std::string rest =
      " " + write("projecting.yaml", projecting) + " --plant " + example + "scenario.yaml";
  for (const char* command : {"verify", "verify --rigorous", "analyze"}) {
    const ToolRun refused = run(command + rest);
    EXPECT_EQ(refused.status, 1) << refused.output;
    EXPECT_TRUE(
        refused.says("projecting.yaml:8: gains/projection: expected only gains that "
                     "bernard2022_section7_3_2 is about"))
        << refused.output;
  }
}

TEST_F(DesignTool, WarnsOfGainsThatHardlyCorrect) {
  const ToolRun slow = synthesize(
      write("plant.yaml", oscillator("lambda_t: 0.05", "lambda_t: 1e-4, gain_bound: 0.1")));
  ASSERT_EQ(slow.status, 0) << slow.output;
  EXPECT_TRUE(slow.says("these gains hardly correct")) << slow.output;
  EXPECT_TRUE(slow.says("--set lambda_t=NUMBER")) << slow.output;
  const ToolRun fast =
      synthesize(write("plant.yaml", oscillator("lambda_t: 0.05, delta: 3", "lambda_t: 0.3")));
  ASSERT_EQ(fast.status, 0) << fast.output;
  EXPECT_FALSE(fast.says("hardly correct")) << fast.output;
  EXPECT_FALSE(fast.says("|disturbance|")) << fast.output;  // the plant has no N
}

TEST_F(DesignTool, SaysThatTheOutputCannotBeWritten) {
  const ToolRun refused =
      run("synthesize " + write("plant.yaml", oscillator()) +
          " --method ferrante2019_proposition2 -o " + path("nowhere/gains.yaml"));
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(
      refused.says(path("nowhere/gains.yaml") + ": can't be written: No such file or directory"))
      << refused.output;
}

TEST_F(DesignTool, ComparesWithASecondSolverOnRequest) {
  const std::string plant = write("plant.yaml", oscillator());
  const ToolRun missing =
      synthesize(plant, "--cross-check sdpa --sdpa " + path("design.dat-s"), "PATH=/nonexistent");
  EXPECT_NE(read("design.dat-s").find("* x1 to x3: P1, 2 x 2, symmetric"), std::string::npos)
      << read("design.dat-s").substr(0, 400);
  EXPECT_EQ(missing.status, 1);
  EXPECT_TRUE(missing.says("Debian's package sdpa")) << missing.output;
  if (std::system("command -v sdpa >/dev/null") != 0) {
    GTEST_SKIP() << "the program sdpa is not installed";
  }
  const ToolRun compared = synthesize(plant, "--cross-check sdpa");
  EXPECT_EQ(compared.status, 0) << compared.output;
  EXPECT_TRUE(compared.says("SDPA: objective")) << compared.output;
  EXPECT_TRUE(compared.says("they differ by")) << compared.output;
}

TEST_F(DesignTool, ExplainsItsExitStatus) {
  const ToolRun help = run("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_TRUE(help.says("Exit status")) << help.output;
  EXPECT_GT(run("").status, 99);
}

TEST_F(DesignTool, ChecksEllOnTheBoxOfTheSaturations) {
  const std::string folder = SDO_SOURCE_DIR "/config/examples/bernard2022_clutch/";
  const ToolRun clutch = run("check_ell --points 300 " + folder + "scenario.yaml " + folder +
                             "observer.yaml " + folder + "gains.yaml");
  EXPECT_TRUE(clutch.says("ell = 8, mode 1")) << clutch.output;
  EXPECT_TRUE(clutch.says("each T_i+1 the derivative of T_i")) << clutch.output;
  const std::string puck = SDO_SOURCE_DIR "/config/examples/bernard2022_puck/";
  const ToolRun linear =
      run("check_ell " + puck + "scenario.yaml " + puck + "observer.yaml " + puck + "gains.yaml");
  EXPECT_EQ(1, linear.status);
  EXPECT_TRUE(linear.says("The linear form converges with any ell")) << linear.output;
}

TEST_F(DesignTool, TellsWhetherJumpsShowTheState) {
  const std::string ball =
      SDO_SOURCE_DIR "/config/examples/bernard2022_bouncing_ball/scenario.yaml";
  const ToolRun seen = run("jump_observability --T1 0.5 --T2 1.5 " + ball);
  EXPECT_EQ(0, seen.status);
  EXPECT_TRUE(seen.says("before 2 intervals of flow in [0.5, 1.5] s")) << seen.output;
  EXPECT_TRUE(seen.says("  observable: least eigenvalue")) << seen.output;
  const ToolRun one = run("jump_observability --jumps 1 " + ball);
  EXPECT_EQ(2, one.status);
  EXPECT_TRUE(one.says("NOT OBSERVABLE")) << one.output;
  EXPECT_EQ(1, run("jump_observability --T1 2 --T2 1 " + ball).status);
  const ToolRun without_end = run(
      "jump_observability " +
      write(
          "plant.yaml",
          "plant: {states: [a, b], A: [[0, 1], [0, -0.1]], jump_map: {A_d: [[-1, 0], [0, -0.8]]}}\n"
          "sensors: {contact: {C: [[1, 0]], measured: at_jumps}}\n"
          "design: {sampling: {T1: 0.5, T2: .inf}}\n"));
  EXPECT_EQ(1, without_end.status);
  EXPECT_TRUE(without_end.says("T2 = inf: intervals are tried up to a longest one"))
      << without_end.output;
}

TEST_F(DesignTool, ReadsTheTimesOfEachSensor) {
  const auto plant = [&](const std::string& gps, const std::string& design) {
    return write("plant.yaml",
                 "plant: {states: [p, v], A: [[0, 1], [-4, 0]]}\n"
                 "sensors:\n"
                 "  gps: {C: [[1, 0]], " +
                     gps +
                     "source: {topic: gps}}\n"
                     "  wheel: {C: [[0, 1]], source: {topic: wheel}}\n" +
                     design);
  };
  const char kTimes[] = "gps in [T1, T2] = [0.5, 2] s, wheel in [T1, T2] = [0.1, 1] s";
  const char kGps[] = "sampling: {T1: 0.5, T2: 2}, ";
  const char kWheel[] = "sampling: {wheel: {T1: 0.1, T2: 1}}\n";
  const ToolRun of_sensors = run("explain " + plant(kGps, kWheel));
  EXPECT_TRUE(of_sensors.says(kTimes)) << of_sensors.output;
  // What a design is asked for overrules what is.
  const std::string asked =
      "design: {sampling: {gps: {T1: 0.5, T2: 2}, wheel: {T1: 0.1, T2: 1}}}\n";
  const ToolRun of_design = run("explain " + plant("sampling: {T1: 1, T2: 3}, ", asked));
  EXPECT_TRUE(of_design.says(kTimes)) << of_design.output;
  const ToolRun missing = run("explain " + plant("", kWheel));
  EXPECT_EQ(1, missing.status);
  EXPECT_TRUE(missing.says("here or at sensors/gps/sampling, found none of gps")) << missing.output;
  const ToolRun of_all = run("explain --T1 0.1 --T2 1.8 " + plant("", ""));
  EXPECT_TRUE(of_all.says("gps in [T1, T2] = [0.1, 1.8] s, wheel in [T1, T2] = [0.1, 1.8] s"))
      << of_all.output;
  const ToolRun swept = run("sweep " + plant(kGps, kWheel) + " -o " + path("folder"));
  EXPECT_NE(0, swept.status);
  EXPECT_TRUE(swept.says("several sensors are sampled")) << swept.output;
  const ToolRun others = run("explain --T2 1.8 " + plant(kGps, kWheel));
  EXPECT_NE(0, others.status);
  EXPECT_TRUE(others.says("--T1 and --T2 are the times of all sensors")) << others.output;
  const std::string output = " -o " + path("gains.yaml");
  for (const char* cells : {"40", "4000000000"}) {
    const ToolRun fine = run("synthesize " + plant(kGps, kWheel) + output + " --cells " + cells);
    EXPECT_NE(0, fine.status);
    EXPECT_TRUE(fine.says("--cells: expected at most 1000 nodes of the grid")) << fine.output;
  }
  const ToolRun coinciding = run("synthesize --method timer_dependent_alternating_gain " +
                                 plant(kGps, "sampling: {wheel: {T1: 0, T2: 1}}\n") + output);
  EXPECT_NE(0, coinciding.status);
  EXPECT_TRUE(coinciding.says("it needs T1 > 0 of each")) << coinciding.output;
}

TEST_F(DesignTool, ExplainsPlantsOfFormulasAlongATrajectory) {
  const std::string neuron = SDO_SOURCE_DIR "/config/examples/bernard2022_neuron_high_gain/";
  const ToolRun along = run("explain --along " + neuron + "scenario.yaml --gains " + neuron +
                            "observer.yaml " + neuron + "gains.yaml");
  EXPECT_EQ(0, along.status) << along.output;
  EXPECT_TRUE(along.says("of 60 s, with 2 jumps")) << along.output;
  EXPECT_TRUE(along.says("- all of the state. Least, from 0 to 3.153 s")) << along.output;
  EXPECT_TRUE(along.says("JACOBIAN OF THE COORDINATES T")) << along.output;
  const ToolRun linear = run("explain --along " + neuron + "scenario.yaml --gains " + neuron +
                             "observer.yaml " + neuron + "scenario.yaml");
  EXPECT_EQ(1, linear.status);
}

}  // namespace
}  // namespace sampled_data_observers

// rosrun sampled_data_observers replay BAG CONFIG... -o OUT.bag
#include "replay/replay.h"

#include <ros/init.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "console/command_line.h"
#include "console/html_page.h"
#include "console/json_text.h"
#include "console/option_checks.h"
#include "console/output_checks.h"
#include "console/plot_program.h"
#include "console/tool_main.h"
#include "console/usage_error.h"
#include "files/output_file.h"
#include "ranks/ranks.h"
#include "replay/replay_config.h"
#include "replay/report/beside_run.h"
#include "replay/report/report_data.h"
#include "replay/report/report_page.h"
#include "replay/report/report_tables.h"
#include "replay/run_table.h"

namespace sdo = sampled_data_observers;

namespace {

// Exit statuses, beside 1 for faults.
constexpr int kGuaranteeBroken = 2;
constexpr int kDiverged = 3;

struct Arguments {
  sdo::ReplayOptions options;
  std::string bag;
  std::vector<std::string> config;  // and further bags
  std::vector<std::string> assignments;
  std::optional<std::array<double, 2>> thin;  // [s]
  bool thin_to_sampling = false;
  std::optional<std::uint64_t> seed;
  std::optional<double> from;  // [s]
  std::optional<double> to;    // [s]
  std::string json;
  std::string plot;
  std::string report;
  std::string tables;  // a folder
  std::vector<std::string> beside;
  std::vector<std::string> gains;
  std::optional<std::uint64_t> seeds;

  /// Whether what is written shows other gains and seeds, too.
  bool shows_runs() const { return !report.empty() || !tables.empty(); }
  bool needs_record() const { return shows_runs() || !plot.empty(); }
  /// Whether a table of runs is asked for; a report shows seeds itself.
  bool has_runs() const { return !gains.empty() || (seeds && !shows_runs()); }
};

std::map<std::string, std::string> parse_fields(const std::vector<std::string>& assignments) {
  std::map<std::string, std::string> fields;
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size()) {
      throw sdo::UsageError("--compare", "expected STATE=FIELD, found '" + assignment + "'");
    }
    fields[assignment.substr(0, equals)] = assignment.substr(equals + 1);
  }
  return fields;
}

std::optional<sdo::ReplayOptions::Thinning> thinning_of(const Arguments& arguments) {
  const std::uint64_t seed = arguments.seed.value_or(0);
  if (arguments.thin && arguments.thin_to_sampling) {
    throw sdo::UsageError("--thin", "not beside --thin-to-sampling");
  }
  if (arguments.thin_to_sampling) return sdo::ReplayOptions::Thinning{std::nullopt, seed};
  if (!arguments.thin) {
    if (arguments.seed) throw sdo::UsageError("--seed", "needs --thin or --thin-to-sampling");
    if (arguments.seeds) throw sdo::UsageError("--seeds", "needs --thin or --thin-to-sampling");
    return std::nullopt;
  }
  const auto [T1, T2] = *arguments.thin;
  if (T1 > T2) throw sdo::UsageError("--thin", "T1 <= T2 must hold");
  return sdo::ReplayOptions::Thinning{
      sdo::SamplingBounds{sdo::from_seconds(T1), sdo::from_seconds(T2)}, seed};
}

/// Takes further bags, which are called .bag, out of the configuration files.
void separate_bags(Arguments& arguments) {
  const auto is_config = [](const std::string& file) {
    const std::string suffix = ".bag";
    return file.size() < suffix.size() ||
           file.compare(file.size() - suffix.size(), suffix.size(), suffix) != 0;
  };
  std::vector<std::string>& files = arguments.config;
  const auto bags = std::stable_partition(files.begin(), files.end(), is_config);
  arguments.options.bags = {arguments.bag};
  arguments.options.bags.insert(arguments.options.bags.end(), bags, files.end());
  files.erase(bags, files.end());
}

/// What all arguments together ask for.
/// @throws UsageError where they contradict each other
sdo::ReplayOptions options_of(const Arguments& arguments) {
  sdo::ReplayOptions options = arguments.options;
  options.truth_fields = parse_fields(arguments.assignments);
  options.thinning = thinning_of(arguments);
  if (options.around_jumps && options.truth_topic.empty() && !options.thinning) {
    throw sdo::UsageError("--around-jumps", "needs a truth, by --truth or --thin");
  }
  if (!arguments.assignments.empty() && options.truth_topic.empty()) {
    throw sdo::UsageError("--compare", "needs --truth");
  }
  if ((arguments.from || arguments.to) && options.truth_topic.empty() && !options.thinning) {
    throw sdo::UsageError("--from and --to", "need a truth, by --truth or --thin");
  }
  options.from = arguments.from.value_or(options.from);
  options.to = arguments.to.value_or(options.to);
  if (options.from > options.to) throw sdo::UsageError("--from", "must not be later than --to");
  if (!arguments.beside.empty() &&
      (!arguments.shows_runs() || (options.truth_topic.empty() && !options.thinning))) {
    throw sdo::UsageError("--beside", "needs --report or --csv, and a truth, by --truth or --thin");
  }
  if (arguments.has_runs() &&
      (!options.output.empty() || !arguments.plot.empty() || arguments.needs_record())) {
    throw sdo::UsageError(arguments.gains.empty() ? "--seeds" : "--gains",
                          "a table of runs, not beside what is of one run: --output, --plot, "
                          "--report and --csv");
  }
  std::vector<sdo::GivenFile> inputs = sdo::given_files("CONFIG", arguments.config);
  for (const std::string& path : arguments.beside) inputs.push_back({"--beside", path});
  for (const std::string& path : arguments.gains) inputs.push_back({"--gains", path});
  for (const std::string& bag : options.bags) inputs.push_back({"BAG", bag});
  std::vector<sdo::GivenFile> outputs = {{"--output", options.output},
                                         {"--json", arguments.json},
                                         {"--plot", arguments.plot},
                                         {"--report", arguments.report}};
  if (!arguments.tables.empty()) {
    for (const std::string& name : sdo::table_names()) {
      outputs.push_back({"--csv", arguments.tables + "/" + name});
    }
  }
  sdo::refuse_overwriting(inputs, outputs);
  return options;
}

struct Beside {
  std::string gains;
  sdo::ObserverConfig config;
};

/// All configurations, so that a fault in one is told of before any run.
std::vector<Beside> configurations_beside(const Arguments& arguments) {
  std::vector<Beside> all;
  for (const std::string& gains : arguments.beside) {
    all.push_back({gains, sdo::read_replay_config(sdo::with_gains(arguments.config, gains),
                                                  arguments.options.bags)});
  }
  return all;
}

/// With the seeds of this rank's share; the run with the first seed may have been made.
std::vector<sdo::SeedRun> runs_of_seeds(const Arguments& arguments, sdo::ReplayOptions options,
                                        const sdo::ObserverConfig& config, const sdo::Ranks* ranks,
                                        const std::optional<sdo::SeedRun>& first = std::nullopt) {
  options.output.clear();
  const std::uint64_t first_seed = options.thinning->seed;
  std::vector<sdo::SeedRun> runs;
  const auto [begin, end] = sdo::share_of(ranks, *arguments.seeds);
  for (std::size_t i = begin; i < end; ++i) {
    if (i == 0 && first) {
      runs.push_back(*first);
      continue;
    }
    options.thinning->seed = first_seed + i;
    sdo::RunRecord record;
    const sdo::ReplaySummary summary = sdo::replay(config, options, &record);
    runs.push_back(sdo::seed_run(options.thinning->seed, summary, record));
  }
  return runs;
}

void write_record(const Arguments& arguments, sdo::ReplayOptions options,
                  const sdo::ObserverConfig& config, const sdo::ReplaySummary& summary,
                  const sdo::RunRecord& record, const std::vector<Beside>& beside,
                  const std::vector<sdo::SeedRun>& seeds) {
  options.output.clear();
  std::vector<sdo::BesideRun> runs;
  for (const Beside& other : beside) {
    sdo::BesideRun& run = runs.emplace_back();
    run.name = other.gains.substr(other.gains.rfind('/') + 1);
    run.summary = sdo::replay(other.config, options, &run.record);
  }
  if (!arguments.tables.empty()) sdo::write_tables(arguments.tables, config, record, runs, seeds);
  if (arguments.report.empty() && arguments.plot.empty()) return;
  const nlohmann::json data =
      sdo::report_data(config, arguments.config, summary, record, runs, seeds);
  if (!arguments.plot.empty()) {
    sdo::run_plot_program("plot_replay", sdo::json_text(data), arguments.plot);
  }
  if (arguments.report.empty()) return;
  sdo::write_output(arguments.report, sdo::html_page(data, sdo::page_parts::report()));
}

void print_warnings(const sdo::ObserverConfig& config) {
  if (!config.warning.empty()) std::cerr << "replay: " << config.warning << "\n";
  for (const std::string& warning : config.warnings) std::cerr << "replay: " << warning << "\n";
}

/// Several runs at once.
int replay_runs(const Arguments& arguments, const sdo::ReplayOptions& options, sdo::Ranks* ranks) {
  std::vector<std::string> gains = arguments.gains;
  if (gains.empty()) gains.emplace_back();
  std::vector<std::string> gains_of_case;
  std::vector<sdo::ReplayCase> cases;
  const std::uint64_t first = arguments.seed.value_or(0);
  for (const std::string& file : gains) {
    const std::vector<std::string> config =
        file.empty() ? arguments.config : sdo::with_gains(arguments.config, file);
    for (std::uint64_t seed = first; seed < first + arguments.seeds.value_or(1); ++seed) {
      cases.push_back({config, seed});
      gains_of_case.push_back(file);
    }
  }
  const auto [begin, end] = sdo::share_of(ranks, cases.size());
  const std::vector<sdo::ReplayCase> own(cases.begin() + static_cast<std::ptrdiff_t>(begin),
                                         cases.begin() + static_cast<std::ptrdiff_t>(end));
  std::set<std::vector<std::string>> warned;
  const auto load = [&](const std::vector<std::string>& files) {
    sdo::ObserverConfig config = sdo::read_replay_config(files, options.bags);
    if (warned.insert(files).second) print_warnings(config);
    return config;
  };
  std::vector<sdo::RunRow> rows;
  if (!own.empty()) {
    const std::vector<sdo::ReplaySummary> summaries = sdo::replay_all(own, options, load);
    for (std::size_t i = begin; i < end; ++i) {
      rows.push_back(sdo::row_of(gains_of_case[i], cases[i].seed, summaries[i - begin]));
    }
  }
  if (ranks != nullptr) {
    rows = sdo::gathered_rows(*ranks, rows);
    ranks->finish();
    if (ranks->rank() > 0) return 0;
  }
  const bool has_seeds = arguments.seeds.has_value();
  sdo::print_runs(rows, has_seeds, std::cout);
  if (!arguments.json.empty()) sdo::write_runs(rows, has_seeds, arguments.json);
  const auto any = [&](bool sdo::RunRow::*fault) {
    return std::any_of(rows.begin(), rows.end(),
                       [&](const sdo::RunRow& row) { return row.*fault; });
  };
  if (any(&sdo::RunRow::is_guarantee_broken)) return kGuaranteeBroken;
  return any(&sdo::RunRow::has_diverged) ? kDiverged : 0;
}

/// A report or tables of one run, with other seeds: on all ranks but the first.
int replay_seeds(const Arguments& arguments, const sdo::ReplayOptions& options, sdo::Ranks& ranks) {
  const sdo::ObserverConfig config = sdo::read_replay_config(arguments.config, options.bags);
  sdo::gathered_runs(ranks, runs_of_seeds(arguments, options, config, &ranks));
  ranks.finish();
  return 0;
}

int replay_one(const Arguments& arguments, const sdo::ReplayOptions& options, sdo::Ranks* ranks) {
  const sdo::ObserverConfig config = sdo::read_replay_config(arguments.config, options.bags);
  print_warnings(config);
  const std::vector<Beside> beside = configurations_beside(arguments);
  sdo::RunRecord record;
  const sdo::ReplaySummary summary =
      sdo::replay(config, options, arguments.needs_record() ? &record : nullptr);
  sdo::print_table(summary, std::cout);
  if (!arguments.json.empty()) sdo::write_json(summary, arguments.json);
  bool is_broken = summary.is_guarantee_broken();
  if (arguments.needs_record()) {
    std::vector<sdo::SeedRun> seeds;
    if (arguments.seeds.value_or(1) > 1) {
      seeds = runs_of_seeds(arguments, options, config, ranks,
                            sdo::seed_run(options.thinning->seed, summary, record));
      if (ranks != nullptr) {
        seeds = sdo::gathered_runs(*ranks, seeds);
        ranks->finish();
      }
    }
    write_record(arguments, options, config, summary, record, beside, seeds);
    if (!seeds.empty()) std::cout << sdo::finding_over(seeds).text << "\n";
    is_broken = is_broken || std::any_of(seeds.begin(), seeds.end(), [](const sdo::SeedRun& run) {
                  return run.is_guarantee_broken;
                });
  }
  if (is_broken) return kGuaranteeBroken;
  return summary.diverged.empty() ? 0 : kDiverged;
}

int replay(const Arguments& arguments) {
  const sdo::ReplayOptions options = options_of(arguments);
  sdo::Ranks* const ranks = sdo::command_ranks();
  if (ranks != nullptr && !arguments.has_runs() && arguments.seeds.value_or(1) < 2) {
    throw std::runtime_error("mpirun is for --seeds and --gains, whose runs it splits");
  }
  int status = 0;
  const auto work = [&] {
    if (arguments.has_runs()) {
      status = replay_runs(arguments, options, ranks);
    } else if (ranks != nullptr && ranks->rank() > 0) {
      status = replay_seeds(arguments, options, *ranks);
    } else {
      status = replay_one(arguments, options, ranks);
    }
  };
  sdo::name_rank_in_faults(ranks, work);
  return status;
}

void declare(Arguments& arguments, sdo::CommandLine& tool) {
  sdo::ReplayOptions& options = arguments.options;
  tool.argument("BAG", arguments.bag, "Bag to read; more bags may follow, all as one");
  tool.argument("CONFIG...", arguments.config,
                "Configuration files; a key may stand in one of them only");
  tool.option("-o, --output BAG", options.output,
              "Bag to write: estimates, event statuses and the messages received");
  tool.option("--truth TOPIC", options.truth_topic, "Topic of the truth");
  tool.option("--compare STATE=FIELD...", arguments.assignments,
              "Which field of the truth is which state; may be given several times (default for a "
              "StateEstimate: every state by its name)");
  tool.option("--thin T1 T2", arguments.thin,
              "Keep a random subset of the samples, T1 to T2 seconds apart; without --truth all "
              "samples serve as truth")
      .check(sdo::number_between(1e-9, 1e6));
  tool.flag("--thin-to-sampling", arguments.thin_to_sampling,
            "Likewise, of each sensor T1 to T2 of its sampling apart, whatever the others do");
  tool.option("--seed NUMBER", arguments.seed, "Seed of --thin and --thin-to-sampling (default 0)")
      .check(sdo::whole_number_at_least(0));
  tool.option("--seeds NUMBER", arguments.seeds,
              "Replay with so many seeds, from --seed on: a table of the runs, or with --report or "
              "--csv how the errors spread")
      .check(sdo::whole_number_between(1, 10000));
  tool.option(
      "--gains FILE...", arguments.gains,
      "Replay with this gain file instead of that of CONFIG, and print a table of the runs; "
      "may be given several times");
  tool.option("--from SECONDS", arguments.from,
              "Compare from this time on [s after the first truth]")
      .check(sdo::number_at_least(0));
  tool.option("--to SECONDS", arguments.to, "Compare up to this time [s after the first truth]")
      .check(sdo::number_at_least(0));
  tool.option("--around-jumps SECONDS", options.around_jumps,
              "Tell errors up to so long before and after jumps apart from others (default "
              "jumps/stamp_error)")
      .check(sdo::number_between(0.0, 1e6));
  tool.flag("--no-input", options.may_lack_input,
            "The bag need not have the topics of inputs, which are zero then");
  tool.option("--plot FILE", arguments.plot,
              "Draw truth, samples and estimate into this file (.png, .pdf, .svg)")
      .check(sdo::picture_file());
  tool.option("--report FILE", arguments.report,
              "Write a page for a browser into this file: verdict, errors and bounds, events, "
              "configuration");
  tool.option("--beside FILE...", arguments.beside,
              "Show in the report what this gain file would have done instead of that of CONFIG; "
              "may be given several times");
  tool.option("--csv FOLDER", arguments.tables,
              "Write what the report shows, as tables of comma-separated values, into this folder");
  tool.option("--json FILE", arguments.json, "Write the summary for machines into this file");
}

int run(int argc, char** argv) {
  // Takes topic remappings (from:=to, __ns:=...) off the command line, as for every ROS node.
  ros::init(argc, argv, "replay", ros::init_options::AnonymousName | ros::init_options::NoRosout);

  sdo::CommandLine tool(
      "replay",
      "Runs an observer over a bag, as fast as the machine allows and without roscore, and "
      "compares its estimates with the truth. Remappings (from:=to) hold as for a node.",
      "Exit status: 0 done, 1 a fault in bag, configuration or files, 2 the truth refutes the "
      "guaranteed error bound, 3 the estimate diverged, else wrong usage.");
  Arguments arguments;
  declare(arguments, tool);
  tool.action([&arguments] {
    separate_bags(arguments);
    return replay(arguments);
  });
  return tool.run(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("replay", run, argc, argv);
}

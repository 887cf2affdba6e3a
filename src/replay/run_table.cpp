#include "replay/run_table.h"

#include <algorithm>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>

#include "console/json_text.h"
#include "files/output_file.h"

namespace sampled_data_observers {
namespace {

using Values = std::vector<std::optional<double>>;

/// A number of each run.
struct Column {
  std::string name;
  Values values;
};

std::vector<std::pair<std::string, std::optional<double>>> numbers_of(
    const ReplaySummary& summary) {
  std::vector<std::pair<std::string, std::optional<double>>> numbers = {
      {"samples", static_cast<double>(summary.samples_used)}};
  if (summary.compared.empty()) {
    for (const auto& [state, value] : summary.final_state) {
      numbers.emplace_back("last " + state, value);
    }
    return numbers;
  }
  for (std::size_t i = 0; i < summary.compared.size(); ++i) {
    numbers.emplace_back("RMSE " + summary.compared[i], summary.rmse[i]);
  }
  numbers.emplace_back("RMSE norm", summary.rmse_norm);
  if (summary.bounded) numbers.emplace_back("share of bound", summary.all_bounds().share);
  return numbers;
}

/// Smallest, median and largest, where there are any.
struct Spread {
  std::optional<double> smallest, median, largest;
};

Spread spread_of(const Values& values) {
  std::vector<double> known;
  for (const std::optional<double>& value : values) {
    if (value) known.push_back(*value);
  }
  if (known.empty()) return {};
  std::sort(known.begin(), known.end());
  const std::size_t half = known.size() / 2;
  const double median = known.size() % 2 == 1 ? known[half] : (known[half - 1] + known[half]) / 2.0;
  return {known.front(), median, known.back()};
}

/// The runs of one gain file.
struct Group {
  std::string gains;
  std::vector<const RunRow*> runs;
  std::vector<Column> columns;
};

/// In the order of the runs. A run without any estimate has no last one.
std::vector<Group> groups_of(const std::vector<RunRow>& runs) {
  std::vector<Group> groups;
  for (const RunRow& run : runs) {
    if (groups.empty() || groups.back().gains != run.gains) groups.push_back({run.gains, {}, {}});
    groups.back().runs.push_back(&run);
  }
  for (Group& group : groups) {
    for (std::size_t i = 0; i < group.runs.size(); ++i) {
      for (const auto& [name, value] : group.runs[i]->numbers) {
        const auto same = [&, &name = name](const Column& column) { return column.name == name; };
        auto column = std::find_if(group.columns.begin(), group.columns.end(), same);
        if (column == group.columns.end()) {
          column = group.columns.insert(column, {name, Values(group.runs.size())});
        }
        column->values[i] = value;
      }
    }
  }
  return groups;
}

std::string in_short(const std::optional<double>& value) {
  if (!value) return "-";
  std::ostringstream out;
  out << std::setprecision(4) << *value;
  return out.str();
}

class Rows {
 public:
  Rows(std::ostream& out, const std::vector<Column>& columns, bool has_seeds)
      : out_(out), has_seeds_(has_seeds) {
    for (const Column& column : columns) {
      widths_.push_back(static_cast<int>(std::max<std::size_t>(column.name.size(), 10)) + 2);
    }
    first("seed");
    for (std::size_t i = 0; i < columns.size(); ++i) cell(i, columns[i].name);
    out_ << "\n";
  }

  void first(const std::string& text) {
    if (has_seeds_) out_ << std::setw(8) << text;
  }
  void cell(std::size_t column, const std::string& text) {
    out_ << std::setw(widths_[column]) << text;
  }
  void end(const std::string& note) { out_ << (note.empty() ? "" : "  " + note) << "\n"; }

 private:
  std::ostream& out_;
  bool has_seeds_;
  std::vector<int> widths_;
};

std::string note_on(const RunRow& run) {
  if (run.is_guarantee_broken) return "GUARANTEE BROKEN";
  return run.has_diverged ? "DIVERGED" : "";
}

void print_group(const Group& group, bool has_seeds, std::ostream& out) {
  if (!group.gains.empty()) out << group.gains << "\n";
  Rows rows(out, group.columns, has_seeds);
  for (std::size_t i = 0; i < group.runs.size(); ++i) {
    rows.first(std::to_string(group.runs[i]->seed));
    for (std::size_t c = 0; c < group.columns.size(); ++c) {
      rows.cell(c, in_short(group.columns[c].values[i]));
    }
    rows.end(note_on(*group.runs[i]));
  }
  if (!has_seeds) return;
  std::vector<Spread> spreads;
  for (const Column& column : group.columns) spreads.push_back(spread_of(column.values));
  const auto row = [&](const char* name, std::optional<double> Spread::*which) {
    rows.first(name);
    for (std::size_t c = 0; c < spreads.size(); ++c) rows.cell(c, in_short(spreads[c].*which));
    rows.end("");
  };
  row("min", &Spread::smallest);
  row("median", &Spread::median);
  row("max", &Spread::largest);
}

nlohmann::json json_number(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

std::optional<double> number_or_none(const nlohmann::json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

/// As CBOR, which keeps all bits of a number.
std::string packed(const std::vector<RunRow>& rows) {
  nlohmann::json json = nlohmann::json::array();
  for (const RunRow& row : rows) {
    nlohmann::json numbers = nlohmann::json::array();
    for (const auto& [name, value] : row.numbers) {
      numbers.push_back(nlohmann::json::array({name, json_number(value)}));
    }
    json.push_back(
        nlohmann::json::array({row.gains, row.seed, row.bag, row.bag_seconds, row.wall_seconds,
                               numbers, row.is_guarantee_broken, row.has_diverged, row.summary}));
  }
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(json);
  return {bytes.begin(), bytes.end()};
}

std::vector<RunRow> unpacked(const std::string& bytes) {
  std::vector<RunRow> rows;
  for (const nlohmann::json& json : nlohmann::json::from_cbor(bytes)) {
    RunRow& row = rows.emplace_back();
    json.at(0).get_to(row.gains);
    json.at(1).get_to(row.seed);
    json.at(2).get_to(row.bag);
    json.at(3).get_to(row.bag_seconds);
    json.at(4).get_to(row.wall_seconds);
    for (const nlohmann::json& number : json.at(5)) {
      row.numbers.emplace_back(number.at(0).get<std::string>(), number_or_none(number.at(1)));
    }
    json.at(6).get_to(row.is_guarantee_broken);
    json.at(7).get_to(row.has_diverged);
    row.summary = json.at(8);
  }
  return rows;
}

}  // namespace

RunRow row_of(const std::string& gains, std::uint64_t seed, const ReplaySummary& summary) {
  RunRow row;
  row.gains = gains;
  row.seed = seed;
  row.bag = summary.bag;
  row.bag_seconds = summary.bag_seconds;
  row.wall_seconds = summary.wall_seconds;
  row.numbers = numbers_of(summary);
  row.is_guarantee_broken = summary.is_guarantee_broken();
  row.has_diverged = !summary.diverged.empty();
  row.summary = json_of(summary);
  return row;
}

std::vector<RunRow> gathered_rows(Ranks& ranks, const std::vector<RunRow>& own) {
  std::vector<RunRow> all;
  for (const std::string& bytes : gathered(ranks, packed(own))) {
    for (RunRow& row : unpacked(bytes)) all.push_back(std::move(row));
  }
  return all;
}

void print_runs(const std::vector<RunRow>& runs, bool has_seeds, std::ostream& out) {
  const RunRow& first = runs.front();
  out << runs.size() << " runs on " << first.bag << " (" << in_short(first.bag_seconds)
      << " s of it in " << in_short(first.wall_seconds) << " s)\n";
  for (const Group& group : groups_of(runs)) {
    out << "\n" << std::right;
    print_group(group, has_seeds, out);
  }
}

void write_runs(const std::vector<RunRow>& runs, bool has_seeds, const std::string& path) {
  nlohmann::json json = {{"runs", nlohmann::json::array()}, {"gains", nlohmann::json::array()}};
  for (const RunRow& run : runs) {
    nlohmann::json entry = run.summary;
    if (!run.gains.empty()) entry["gains"] = run.gains;
    if (has_seeds) entry["seed"] = run.seed;
    json["runs"].push_back(std::move(entry));
  }
  for (const Group& group : groups_of(runs)) {
    nlohmann::json entry = {{"runs", group.runs.size()}};
    if (!group.gains.empty()) entry["gains"] = group.gains;
    for (const Column& column : group.columns) {
      const Spread spread = spread_of(column.values);
      entry["over_runs"][column.name] = {{"min", json_number(spread.smallest)},
                                         {"median", json_number(spread.median)},
                                         {"max", json_number(spread.largest)}};
    }
    json["gains"].push_back(std::move(entry));
  }
  write_output(path, json_text(json, 2) + "\n");
}

}  // namespace sampled_data_observers

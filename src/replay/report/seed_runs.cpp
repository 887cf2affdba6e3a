#include "replay/report/seed_runs.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "replay/report/report_errors.h"

namespace sampled_data_observers {
namespace {

nlohmann::json json_of(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

std::optional<double> optional_number(const nlohmann::json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

/// As CBOR, which keeps all bits of a number.
std::string packed(const std::vector<SeedRun>& runs) {
  nlohmann::json json = nlohmann::json::array();
  for (const SeedRun& run : runs) {
    json.push_back(nlohmann::json::array({run.seed, run.stamps, run.norms, json_of(run.rmse),
                                          json_of(run.largest), json_of(run.bound_share),
                                          run.is_guarantee_broken}));
  }
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(json);
  return {bytes.begin(), bytes.end()};
}

SeedRun unpacked(const nlohmann::json& json) {
  SeedRun run;
  json.at(0).get_to(run.seed);
  json.at(1).get_to(run.stamps);
  json.at(2).get_to(run.norms);
  run.rmse = optional_number(json.at(3));
  run.largest = optional_number(json.at(4));
  run.bound_share = optional_number(json.at(5));
  json.at(6).get_to(run.is_guarantee_broken);
  return run;
}

/// Of an odd number the middle one, of an even one the lower of both.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string range_text(const std::vector<double>& values) {
  std::ostringstream out;
  out.precision(4);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  out << *low << " to " << *high << ", median " << median(values);
  return out.str();
}

}  // namespace

SeedRun seed_run(std::uint64_t seed, const ReplaySummary& summary, const RunRecord& record) {
  SeedRun run;
  run.seed = seed;
  run.stamps = record.compared.stamps;
  run.norms = record.compared.norms;
  run.rmse = summary.rmse_norm;
  run.largest = error_figures(record.compared, record.compared.norms).largest;
  run.bound_share = summary.all_bounds().share;
  run.is_guarantee_broken = summary.is_guarantee_broken();
  return run;
}

std::vector<SeedRun> gathered_runs(Ranks& ranks, const std::vector<SeedRun>& own) {
  std::vector<SeedRun> all;
  for (const std::string& bytes : gathered(ranks, packed(own))) {
    for (const nlohmann::json& run : nlohmann::json::from_cbor(bytes)) {
      all.push_back(unpacked(run));
    }
  }
  return all;
}

SeedBand seed_band(const std::vector<SeedRun>& runs) {
  std::map<Stamp, std::vector<double>> by_stamp;
  for (const SeedRun& run : runs) {
    for (std::size_t i = 0; i < run.stamps.size(); ++i) {
      by_stamp[run.stamps[i]].push_back(run.norms[i]);
    }
  }
  SeedBand band;
  for (const auto& [stamp, norms] : by_stamp) {
    if (norms.size() < runs.size()) continue;
    const auto [low, high] = std::minmax_element(norms.begin(), norms.end());
    band.stamps.push_back(stamp);
    band.low.push_back(*low);
    band.middle.push_back(median(norms));
    band.high.push_back(*high);
  }
  return band;
}

ReportFinding finding_over(const std::vector<SeedRun>& runs) {
  std::vector<double> rmse;
  std::size_t broken = 0;
  bool has_bound = false;
  for (const SeedRun& run : runs) {
    if (run.rmse) rmse.push_back(*run.rmse);
    broken += run.is_guarantee_broken ? 1 : 0;
    has_bound = has_bound || run.bound_share.has_value();
  }
  const std::string count = std::to_string(runs.size());
  std::string text = "Over " + count + " seeds: RMSE ";
  text += rmse.empty() ? "not known" : range_text(rmse);
  if (broken > 0) {
    return {FindingLevel::kBad,
            text + "; GUARANTEE BROKEN with " + std::to_string(broken) + " of them"};
  }
  if (has_bound)
    return {FindingLevel::kGood, text + "; the guaranteed bound held with all of them"};
  return {FindingLevel::kOpen, text};
}

nlohmann::json seeds_of(const std::vector<SeedRun>& runs, const PackedTime& time) {
  constexpr std::size_t kMostOfBand = 100'000;
  const SeedBand band = seed_band(runs);
  const ThinnedSeries thinned(std::max<std::size_t>(1, 3 * band.stamps.size() / kMostOfBand));
  nlohmann::json rows = nlohmann::json::array();
  for (const SeedRun& run : runs) {
    rows.push_back({{"seed", run.seed},
                    {"rmse", json_of(run.rmse)},
                    {"largest", json_of(run.largest)},
                    {"share", json_of(run.bound_share)},
                    {"is_guarantee_broken", run.is_guarantee_broken}});
  }
  const nlohmann::json low = thinned.sizes(band.low);
  const nlohmann::json high = thinned.sizes(band.high);
  return {{"rows", rows},
          {"times", thinned.times(band.stamps, time)},
          {"range",
           {{"low", low["low"]}, {"high", high.contains("high") ? high["high"] : high["low"]}}},
          {"median", thinned.sizes(band.middle)}};
}

}  // namespace sampled_data_observers

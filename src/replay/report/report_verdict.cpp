#include "replay/report/report_verdict.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "sampled_data_observers/runtime/diagnosis.h"
#include "sampled_data_observers/runtime/event_outcome.h"

namespace sampled_data_observers {
namespace {

/// Normalized squares of innovations are as many as outputs in the mean where the model is right;
/// the mean of so many is by chance neither this many times that nor such a part of it.
constexpr double kFarOff = 3.0;
constexpr std::uint64_t kEnoughInnovations = 30;

/// A text of parts, numbers with four digits.
template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream out;
  out << std::setprecision(4);
  (out << ... << parts);
  return out.str();
}

ReportFinding of_bound(const ReplaySummary& summary, const std::string& warning) {
  if (!summary.bounded) {
    if (!warning.empty()) return {FindingLevel::kWarning, "No guaranteed bound: " + warning};
    return {FindingLevel::kOpen,
            summary.guarantee.empty()
                ? "No guaranteed bound: the gains have no certificate"
                : "No guaranteed bound: the configuration has no error_assumptions"};
  }
  if (summary.compared_stamps == 0) {
    return {FindingLevel::kOpen,
            "Estimates have a guaranteed bound; there is no truth that it could be compared with"};
  }
  const std::size_t stamps = summary.bound_stamps;
  const std::string of_all = sentence(" of ", summary.compared_stamps, " compared stamps");
  if (stamps == 0) {
    return {FindingLevel::kWarning, "The guaranteed bound was infinite at all" + of_all};
  }
  const ReplaySummary::StateBound found = summary.all_bounds();
  const double share = found.share.value_or(0.0);
  if (found.exceeded == 0) {
    const bool is_all = stamps == summary.compared_stamps;
    return {is_all ? FindingLevel::kGood : FindingLevel::kWarning,
            sentence("The guaranteed bound held, on the norm of the error and on each state's, at ",
                     is_all ? sentence("every one of ", stamps, " compared stamps")
                            : sentence("each of the ", stamps, of_all, " where it was finite"),
                     "; an error took at most ", 100.0 * share, " % of its bound")};
  }
  const std::string what =
      sentence("The error was larger than its guaranteed bound at ", found.exceeded, " of ", stamps,
               " stamps, by a factor of up to ", share);
  if (!summary.truth_is_given) {
    return {FindingLevel::kWarning,
            what + ". The truth is samples with their noise, which refute nothing"};
  }
  return {FindingLevel::kBad, "GUARANTEE BROKEN. " + what +
                                  ". Something that it rests on is not so: error_assumptions, the "
                                  "plant, the stamps, or this truth"};
}

/// The root mean squares of those quantities whose last sample could be held, over all of them.
struct BesideHold {
  double estimate = 0.0;
  double hold = 0.0;
  bool is_all = true;
};

BesideHold beside_hold(const ReplaySummary& summary) {
  BesideHold result;
  for (std::size_t i = 0; i < summary.compared.size(); ++i) {
    if (!summary.hold_rmse[i]) {
      result.is_all = false;
      continue;
    }
    result.estimate = std::hypot(result.estimate, *summary.rmse[i]);
    result.hold = std::hypot(result.hold, *summary.hold_rmse[i]);
  }
  return result;
}

ReportFinding of_errors(const ReplaySummary& summary, const ErrorFigures& norm) {
  if (summary.compared_stamps == 0) {
    return {FindingLevel::kOpen, summary.compared.empty()
                                     ? "No truth: errors are not known (--truth, --thin)"
                                     : "Errors are not known: " + describe_no_comparison()};
  }
  std::string what = sentence("RMSE ", *summary.rmse_norm, ", largest error ", *norm.largest,
                              " (norm, ", summary.compared_stamps, " stamps)");
  FindingLevel level = FindingLevel::kOpen;
  const BesideHold beside = beside_hold(summary);
  if (beside.hold > 0.0) {
    const double ratio = beside.estimate / beside.hold;
    level = ratio < 1.0 ? FindingLevel::kGood : FindingLevel::kWarning;
    what += sentence("; ", beside.is_all ? "" : "of what is measured ", ratio,
                     " times that of holding the last sample, ", beside.hold);
  }
  if (norm.settling_time.value_or(0.0) > 0.0) {
    what +=
        sentence("; settled within ", *norm.settled_within, " after ", *norm.settling_time, " s");
  }
  return {level, what};
}

ReportFinding of_intervals(const ReplaySummary& summary) {
  const SampleIntervals all = summary.intervals();
  if (all.below_T1 == 0 && all.above_T2 == 0) {
    return {FindingLevel::kGood,
            sentence("Each of ", all.count, " times between samples was inside [T1, T2]")};
  }
  std::string what = sentence(all.below_T1 + all.above_T2, " of ", all.count,
                              " times between samples were outside [T1, T2]:");
  for (const SensorSummary& sensor : summary.sensors) {
    const SampleIntervals& own = sensor.intervals;
    if (own.below_T1 == 0 && own.above_T2 == 0) continue;
    what += sentence(" ", sensor.name, " ", own.below_T1, " below T1 = ", sensor.T1, " s and ",
                     own.above_T2, " above T2 = ", sensor.T2, " s;");
  }
  what.pop_back();
  const std::string outside = describe_bound_outside(summary);
  if (!outside.empty()) what += ". " + outside;
  return {FindingLevel::kWarning, what};
}

ReportFinding of_events(const ReplaySummary& summary) {
  std::string what = sentence(summary.events_used, " events used");
  if (!summary.sensors.empty()) {
    what += sentence(", among them ", summary.samples_used, " samples, ", summary.samples_late,
                     " of these late");
  }
  if (summary.jumps_used > 0) what += sentence("; ", summary.jumps_used, " jumps");
  if (summary.missing_jumps > 0) what += sentence(", ", summary.missing_jumps, " more made up");
  if (summary.skipped_jumps > 0) what += sentence(", ", summary.skipped_jumps, " lost");
  std::size_t rejected = 0;
  std::size_t lost = 0;  // of these: not known already
  for (const auto& [reason, count] : summary.rejected) {
    rejected += count;
    if (reason != describe(EventOutcome::kDuplicate)) lost += count;
  }
  what += sentence("; ", rejected, " rejected");
  for (const auto& [reason, count] : summary.rejected) {
    what +=
        sentence(&reason == &summary.rejected.begin()->first ? ": " : ", ", count, " × ", reason);
  }
  if (summary.samples_withheld > 0) {
    what += sentence("; ", summary.samples_withheld, " samples withheld by thinning");
  }
  return {lost > 0 ? FindingLevel::kWarning : FindingLevel::kGood, what};
}

/// What makes the estimate doubtful although nothing was rejected.
void add_doubts(const ReplaySummary& summary, std::vector<ReportFinding>& findings) {
  if (summary.input_stale > 0) {
    findings.push_back(
        {FindingLevel::kWarning,
         sentence(summary.input_stale, " of ", summary.estimates,
                  " estimates rest on an input older than its timeout, from ", std::fixed,
                  std::setprecision(3), summary.input_stale_since, " s on")});
  }
  for (const InnovationSummary& innovation : summary.innovations) {
    if (innovation.of.nis_count < kEnoughInnovations) continue;
    const auto expected = static_cast<double>(innovation.outputs);
    const double found = innovation.of.nis();
    if (found <= kFarOff * expected && found >= expected / kFarOff) continue;
    findings.push_back(
        {FindingLevel::kWarning,
         sentence("Innovations of ", innovation.name, " are ",
                  found > expected ? "larger" : "smaller",
                  " than the covariance says: their normalized square is ", found,
                  " in the mean, and ", innovation.outputs, " where the model is right")});
  }
  for (const std::string& name : summary.stamped_ahead) {
    findings.push_back({FindingLevel::kWarning,
                        "Stamps of " + name + " are " +
                            describe_stamps_ahead(from_seconds(summary.latencies.at(name)))});
  }
}

}  // namespace

std::vector<ReportFinding> verdict_of(const ReplaySummary& summary, const ErrorFigures& norm,
                                      const std::string& warning) {
  std::vector<ReportFinding> findings;
  if (!summary.diverged.empty()) {
    findings.push_back({FindingLevel::kBad, "DIVERGED: " + summary.diverged});
  }
  findings.push_back(of_bound(summary, warning));
  if (summary.bound_lost_at) {
    findings.push_back({FindingLevel::kWarning,
                        sentence("From ", std::fixed, std::setprecision(3), *summary.bound_lost_at,
                                 " s on the bound was infinite: ", summary.bound_loss)});
  }
  if (summary.after_bound > 0) {
    findings.push_back({FindingLevel::kWarning,
                        sentence(summary.after_bound,
                                 " inputs or jumps came after a bound that rested on their "
                                 "absence: error_assumptions/latency is too small")});
  }
  findings.push_back(of_errors(summary, norm));
  if (summary.intervals().count > 0) findings.push_back(of_intervals(summary));
  findings.push_back(of_events(summary));
  add_doubts(summary, findings);
  return findings;
}

ReportFinding finding_beside(const std::string& name, const ReplaySummary& other,
                             const ReplaySummary& own) {
  std::string what = "With " + name + " instead: ";
  if (!other.diverged.empty()) what += "DIVERGED; ";
  if (!other.rmse_norm || !own.rmse_norm) return {FindingLevel::kOpen, what + "no truth"};
  what += sentence("RMSE ", *other.rmse_norm);
  if (*own.rmse_norm > 0.0) {
    what += sentence(", ", *other.rmse_norm / *own.rmse_norm, " times that of this report's gains");
  }
  if (other.bound_stamps > 0) {
    const ReplaySummary::StateBound found = other.all_bounds();
    what += sentence("; its guaranteed bound ",
                     found.exceeded == 0 ? std::string("held at each")
                                         : sentence("was exceeded at ", found.exceeded),
                     " of ", other.bound_stamps, " stamps");
  }
  return {FindingLevel::kOpen, what};
}

}  // namespace sampled_data_observers

#include "replay/summary.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "console/json_text.h"
#include "files/output_file.h"
#include "sampled_data_observers/runtime/diagnosis.h"

namespace sampled_data_observers {
namespace {

std::string shown(const std::optional<double>& value) {
  if (!value) return "-";
  std::ostringstream out;
  out << std::setprecision(4) << *value;
  return out.str();
}

void print_apart_from_jumps(const ReplaySummary& summary, const ErrorsApart& apart,
                            std::ostream& out) {
  out << "  but for " << shown(apart.around) << " s around each of " << apart.jumps << " jumps, at "
      << apart.stamps << " stamps\n";
  const auto row = [&](const std::string& name, const std::optional<double>& value) {
    out << "  " << std::left << std::setw(16) << name << std::right << std::setw(14) << shown(value)
        << "\n";
  };
  for (std::size_t i = 0; i < summary.compared.size(); ++i) row(summary.compared[i], apart.rmse[i]);
  row("norm", apart.rmse_norm);
  out << "  largest norm of the error: " << shown(apart.largest) << " away from them, "
      << shown(apart.peak) << " around jumps";
  if (apart.peak_free) out << ", " << shown(apart.peak_free) << " around them without the peak";
  out << "\n";
}

void print_bounds(const ReplaySummary& summary, std::ostream& out) {
  const ReplaySummary::StateBound all = summary.all_bounds();
  if (summary.is_guarantee_broken()) {
    out << "  GUARANTEE BROKEN: the error was larger than its guaranteed bound at " << all.exceeded
        << " of " << all.stamps << " stamps, by a factor of up to " << shown(all.share)
        << ". Something that it rests on is not so: error_assumptions, the plant, the stamps, or "
           "this truth\n";
  }
  const auto row = [&out](const std::string& of, const ReplaySummary::StateBound& bound) {
    out << "  " << of << ": finite at " << bound.stamps << " stamps, exceeded at " << bound.exceeded
        << "; the error took at most " << shown(bound.share) << " of it\n";
  };
  row("error bound", all);  // on all that follow
  row("that on the norm", {summary.bound_stamps, summary.bound_exceeded, summary.bound_share});
  for (std::size_t i = 0; i < summary.state_bounds.size(); ++i) {
    row("that on " + summary.compared[i], summary.state_bounds[i]);
  }
  const std::string outside = describe_bound_outside(summary);
  if (!outside.empty()) out << "  " << outside << "\n";
}

void print_comparison(const ReplaySummary& summary, std::ostream& out) {
  if (summary.compared.empty()) return;
  out << "\nagainst the truth at " << summary.compared_stamps << " stamps\n";
  if (summary.compared_stamps == 0) {
    out << "  " << describe_no_comparison() << "\n";
    return;
  }
  // What no sensor measures as it is, cannot be held.
  const bool is_held = std::any_of(summary.hold_rmse.begin(), summary.hold_rmse.end(),
                                   [](const auto& value) { return value.has_value(); });
  const auto row = [&](const std::string& name, const std::string& estimate,
                       const std::string& hold, const std::string& ratio) {
    out << "  " << std::left << std::setw(16) << name << std::right << std::setw(14) << estimate;
    if (is_held) out << std::setw(18) << hold << std::setw(10) << ratio;
    out << "\n";
  };
  const auto ratio = [](const std::optional<double>& estimate, const std::optional<double>& hold) {
    if (!estimate || !hold || *hold == 0.0) return std::string("-");
    return shown(*estimate / *hold);
  };
  row("", "RMSE", "holding the last", "ratio");
  for (std::size_t i = 0; i < summary.compared.size(); ++i) {
    row(summary.compared[i], shown(summary.rmse[i]), shown(summary.hold_rmse[i]),
        ratio(summary.rmse[i], summary.hold_rmse[i]));
  }
  row("norm", shown(summary.rmse_norm), shown(summary.hold_rmse_norm),
      ratio(summary.rmse_norm, summary.hold_rmse_norm));
  if (summary.apart_from_jumps) print_apart_from_jumps(summary, *summary.apart_from_jumps, out);
  if (!summary.bounded) return;
  print_bounds(summary, out);
}

/// Also where there is no truth.
void print_bound_loss(const ReplaySummary& summary, std::ostream& out) {
  if (summary.after_bound > 0) {
    out << summary.after_bound
        << " inputs or jumps came after error bounds of later stamps were published, which rested "
           "on their absence: set error_assumptions/latency to what is never exceeded, and "
           "publish_delay to as much\n";
  }
  if (!summary.bound_lost_at) return;
  std::ostringstream stamp;
  stamp << std::fixed << std::setprecision(3) << *summary.bound_lost_at;
  out << "error bound infinite from " << stamp.str() << " s on: " << summary.bound_loss << "\n";
}

void print_intervals(const ReplaySummary& summary, std::ostream& out) {
  const bool has_several = summary.sensors.size() > 1;
  for (const SensorSummary& sensor : summary.sensors) {
    const SampleIntervals& intervals = sensor.intervals;
    if (intervals.count == 0) continue;
    out << "intervals   ";
    if (has_several) out << "of " << sensor.name << ": ";
    out << shown(intervals.smallest) << " to " << shown(intervals.largest) << " s, mean "
        << shown(intervals.mean()) << " s; " << intervals.below_T1 << " below T1";
    if (has_several) out << " = " << shown(sensor.T1) << " s";
    out << ", " << intervals.above_T2 << " above T2";
    if (has_several) out << " = " << shown(sensor.T2) << " s";
    out << "\n";
    const std::string hint = describe_unit_of_times(intervals.mean(), sensor.T1, sensor.T2);
    if (!hint.empty()) out << "            " << hint << "\n";
  }
}

void print_innovations(const ReplaySummary& summary, std::ostream& out) {
  for (const InnovationSummary& innovation : summary.innovations) {
    if (innovation.of.count == 0) continue;
    std::string mean;
    std::string rms;
    for (std::size_t i = 0; i < innovation.outputs; ++i) {
      mean += (i > 0 ? ", " : "") + shown(innovation.of.mean(i));
      rms += (i > 0 ? ", " : "") + shown(innovation.of.rms(i));
    }
    out << "innovation  of " << innovation.name << ": mean " << mean << "; RMS " << rms;
    if (innovation.of.nis_count > 0) {
      out << "; normalized, squared: mean " << shown(innovation.of.nis()) << ", "
          << innovation.outputs << " where the model is right";
    }
    out << "\n";
  }
}

nlohmann::json to_json(const InnovationSummary& innovation) {
  nlohmann::json json = {{"count", innovation.of.count},
                         {"mean", nlohmann::json::array()},
                         {"rms", nlohmann::json::array()},
                         {"nis", nlohmann::json()}};
  for (std::size_t i = 0; innovation.of.count > 0 && i < innovation.outputs; ++i) {
    json["mean"].push_back(innovation.of.mean(i));
    json["rms"].push_back(innovation.of.rms(i));
  }
  if (innovation.of.nis_count > 0) json["nis"] = innovation.of.nis();
  return json;
}

/// In seconds, with as many digits as an instant needs.
std::string instant(double stamp) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(3) << stamp << " s";
  return out.str();
}

void print_inputs(const ReplaySummary& summary, std::ostream& out) {
  for (const InputSummary& input : summary.inputs) {
    if (input.used == 0) continue;
    out << "inputs      ";
    if (summary.inputs.size() > 1) out << "of " << input.name << ": ";
    out << input.used << " used, none for at most " << shown(input.longest_silence) << " s (from "
        << instant(input.silent_since) << " on)\n";
  }
  if (summary.input_stale == 0) return;
  out << "            " << summary.input_stale
      << " estimates rest on one older than its timeout, from "
      << instant(summary.input_stale_since) << " on\n";
}

void print_stamps_ahead(const ReplaySummary& summary, std::ostream& out) {
  for (const std::string& name : summary.stamped_ahead) {
    out << "clock       stamps of " << name << " are "
        << describe_stamps_ahead(from_seconds(summary.latencies.at(name))) << "\n";
  }
}

nlohmann::json number(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json to_json(const SampleIntervals& intervals) {
  return {{"count", intervals.count},       {"min", intervals.smallest},
          {"mean", intervals.mean()},       {"max", intervals.largest},
          {"below_T1", intervals.below_T1}, {"above_T2", intervals.above_T2}};
}

/// T2 is null where it is infinite.
nlohmann::json to_json(const SensorSummary& sensor) {
  return {{"T1", sensor.T1},
          {"T2", std::isinf(sensor.T2) ? nlohmann::json() : nlohmann::json(sensor.T2)},
          {"samples_used", sensor.samples_used},
          {"intervals", to_json(sensor.intervals)}};
}

nlohmann::json by_name(const std::vector<std::string>& names,
                       const std::vector<std::optional<double>>& values) {
  nlohmann::json result = nlohmann::json::object();
  for (std::size_t i = 0; i < names.size(); ++i) result[names[i]] = number(values[i]);
  return result;
}

}  // namespace

double SampleIntervals::mean() const { return count == 0 ? 0.0 : sum / static_cast<double>(count); }

void SampleIntervals::add(const SampleIntervals& other) {
  if (other.count == 0) return;
  smallest = count == 0 ? other.smallest : std::min(smallest, other.smallest);
  largest = count == 0 ? other.largest : std::max(largest, other.largest);
  sum += other.sum;
  count += other.count;
  below_T1 += other.below_T1;
  above_T2 += other.above_T2;
}

SampleIntervals ReplaySummary::intervals() const {
  SampleIntervals all;
  for (const SensorSummary& sensor : sensors) all.add(sensor.intervals);
  return all;
}

ReplaySummary::StateBound ReplaySummary::all_bounds() const {
  StateBound all{bound_stamps, bound_exceeded, bound_share};
  for (const StateBound& bound : state_bounds) {
    all.exceeded = std::max(all.exceeded, bound.exceeded);
    all.share = std::max(all.share, bound.share);
  }
  return all;
}

std::string describe_no_comparison() {
  return "no stamp of the truth was compared, which begins when each compared state that a sensor "
         "measures was measured once, by a sample that was used, and --from is over";
}

std::string describe_bound_outside(const ReplaySummary& summary) {
  const SampleIntervals all = summary.intervals();
  const std::size_t outside = all.below_T1 + all.above_T2;
  if (!summary.bounded || summary.bound_stamps == 0 || outside == 0) return "";
  return "The bound counts the " + std::to_string(outside) +
         " times between samples that were outside [T1, T2] by the most that each may do to the "
         "error: it is a guarantee all the same, but may be larger than what design printed";
}

void print_table(const ReplaySummary& summary, std::ostream& out) {
  out << summary.observer << " on " << summary.bag << " (" << shown(summary.bag_seconds)
      << " s of it in " << shown(summary.wall_seconds) << " s)\n\n";
  out << "samples     " << summary.samples_used << " used (" << summary.samples_late << " late), "
      << summary.samples_rejected << " rejected";
  if (summary.samples_withheld > 0) out << ", " << summary.samples_withheld << " withheld";
  out << "\n";
  if (summary.outputs_used > 0) out << "outputs     " << summary.outputs_used << " used\n";
  if (summary.jumps_used > 0) {
    out << "jumps       " << summary.jumps_used << " used";
    if (summary.jumps_without_outputs > 0) {
      out << ", " << summary.jumps_without_outputs
          << " of them without what was measured at them, or a part of it";
    }
    out << "\n";
  }
  if (summary.missing_jumps > 0) {
    out << "            " << summary.missing_jumps << " that no event told of (jumps/missing)\n";
  }
  if (summary.jumps_taken_back > 0) {
    out << "            " << summary.jumps_taken_back << " taken back\n";
  }
  if (summary.skipped_jumps > 0) {
    out << "            " << summary.skipped_jumps
        << " that were lost: their numbers are missing\n";
  }
  if (summary.dwell_violations > 0) {
    out << "            " << summary.dwell_violations
        << " times at others than jumps/dwell_time and the average ones say\n";
  }
  for (const auto& [channel, topic] : summary.not_recorded) {
    out << std::left << std::setw(12) << channel << std::right << "none: the bag has no topic "
        << topic << "\n";
  }
  for (const auto& [reason, count] : summary.rejected) {
    out << "            " << count << " x " << reason << "\n";
  }
  for (const auto& [what, count] : summary.recovered) {
    out << "gates       " << count << " x " << what << "\n";
  }
  print_stamps_ahead(summary, out);
  print_intervals(summary, out);
  print_innovations(summary, out);
  print_inputs(summary, out);
  if (!summary.datum.empty()) out << "datum       " << summary.datum << "\n";
  out << "estimates   " << summary.estimates << ", the last";
  for (const auto& [name, value] : summary.final_state) out << " " << name << "=" << shown(value);
  out << "\n";
  if (!summary.guarantee.empty()) out << "certified   by " << summary.guarantee << "\n";
  print_bound_loss(summary, out);
  print_comparison(summary, out);
  if (!summary.diverged.empty()) out << "\nDIVERGED: " << summary.diverged << "\n";
}

nlohmann::json json_of(const ReplaySummary& summary) {
  nlohmann::json json;
  json["bag"] = summary.bag;
  json["observer"] = summary.observer;
  json["samples_used"] = summary.samples_used;
  json["samples_late"] = summary.samples_late;
  json["samples_rejected"] = summary.samples_rejected;
  json["samples_withheld"] = summary.samples_withheld;
  json["missing_jumps"] = summary.missing_jumps;
  json["skipped_jumps"] = summary.skipped_jumps;
  json["dwell_violations"] = summary.dwell_violations;
  json["rejected"] = summary.rejected;
  json["recovered"] = summary.recovered;
  json["events_used"] = summary.events_used;
  json["outputs_used"] = summary.outputs_used;
  json["jumps_used"] = summary.jumps_used;
  json["jumps_without_outputs"] = summary.jumps_without_outputs;
  json["jumps_taken_back"] = summary.jumps_taken_back;
  json["not_recorded"] = summary.not_recorded;
  json["intervals"] = to_json(summary.intervals());
  json["sensors"] = nlohmann::json::object();
  for (const SensorSummary& sensor : summary.sensors)
    json["sensors"][sensor.name] = to_json(sensor);
  json["innovations"] = nlohmann::json::object();
  for (const InnovationSummary& innovation : summary.innovations)
    json["innovations"][innovation.name] = to_json(innovation);
  json["inputs"] = nlohmann::json::object();
  for (const InputSummary& input : summary.inputs) {
    json["inputs"][input.name] = {{"used", input.used},
                                  {"longest_silence", input.longest_silence},
                                  {"silent_since", input.silent_since}};
  }
  json["latency"] = summary.latencies;
  json["datum"] = summary.datum;
  json["estimates"] = summary.estimates;
  json["estimates_of_stale_inputs"] = summary.input_stale;
  json["diverged"] = !summary.diverged.empty();
  json["compared_stamps"] = summary.compared_stamps;
  json["rmse"] = by_name(summary.compared, summary.rmse);
  json["rmse_norm"] = number(summary.rmse_norm);
  json["hold_rmse"] = by_name(summary.compared, summary.hold_rmse);
  json["hold_rmse_norm"] = number(summary.hold_rmse_norm);
  if (summary.apart_from_jumps) {
    const ErrorsApart& apart = *summary.apart_from_jumps;
    json["apart_from_jumps"] = {{"around", apart.around},
                                {"jumps", apart.jumps},
                                {"compared_stamps", apart.stamps},
                                {"rmse", by_name(summary.compared, apart.rmse)},
                                {"rmse_norm", number(apart.rmse_norm)},
                                {"largest", number(apart.largest)},
                                {"peak", number(apart.peak)},
                                {"peak_free", number(apart.peak_free)}};
  }
  json["guarantee"] = summary.guarantee;
  json["inputs_or_jumps_after_bound"] = summary.after_bound;
  if (summary.bound_lost_at) {
    json["error_bound_lost"] = {{"stamp", *summary.bound_lost_at}, {"why", summary.bound_loss}};
  }
  if (summary.bounded) {
    json["error_bound"] = {{"finite", summary.bound_stamps},
                           {"exceeded", summary.bound_exceeded},
                           {"largest_share", number(summary.bound_share)}};
    json["error_bounds"] = nlohmann::json::object();
    for (std::size_t i = 0; i < summary.state_bounds.size(); ++i) {
      const ReplaySummary::StateBound& bound = summary.state_bounds[i];
      json["error_bounds"][summary.compared[i]] = {{"finite", bound.stamps},
                                                   {"exceeded", bound.exceeded},
                                                   {"largest_share", number(bound.share)}};
    }
  }
  json["final_stamp"] = summary.final_stamp;
  json["final_state"] = nlohmann::json::object();
  for (const auto& [name, value] : summary.final_state) json["final_state"][name] = value;
  json["bag_seconds"] = summary.bag_seconds;
  json["wall_seconds"] = summary.wall_seconds;

  return json;
}

void write_json(const ReplaySummary& summary, const std::string& path) {
  write_output(path, json_text(json_of(summary), 2) + "\n");
}

}  // namespace sampled_data_observers

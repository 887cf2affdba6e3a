#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "replay/report/run_record.h"
#include "replay/summary.h"

namespace sampled_data_observers {

/// What a report says of the errors of one quantity, or of their norm, beside their root mean
/// squares.
struct ErrorFigures {
  /// At the stamps that the summary counts.
  std::optional<double> largest;
  /// How long after the first stamp of the truth the error came to stay within `settled_within`
  /// [s]: 5 % of its largest, or twice its largest of the second half of the run, where that is
  /// more. From the first stamp on, counted or not. Nothing where it did not before the last one.
  std::optional<double> settling_time;
  std::optional<double> settled_within;
};

/// @param compared  what was compared
/// @param errors    one entry for each of its stamps
ErrorFigures error_figures(const RunRecord::Compared& compared, const std::vector<double>& errors);

/// What there is to say of the error of each quantity compared, in the order of the model, then of
/// their norm. Nothing where nothing was compared.
nlohmann::json error_table(const ReplaySummary& summary, const RunRecord& record);

}  // namespace sampled_data_observers

#pragma once

#include <string>
#include <vector>

#include "replay/report/report_errors.h"
#include "replay/summary.h"

namespace sampled_data_observers {

/// How good a finding is.
enum class FindingLevel { kGood, kOpen, kWarning, kBad };

/// One sentence of a verdict.
struct ReportFinding {
  FindingLevel level = FindingLevel::kOpen;
  std::string text;
};

/// What a replay shows at a glance, the most important finding first: whether the guaranteed bound
/// held, whether the estimate diverged, the error beside that of holding the last sample, the times
/// between samples, what was rejected, and what makes the estimate doubtful: inputs past their
/// timeout, innovations that the covariance does not explain, stamps ahead of the clock.
/// @param norm     of the norm of the errors
/// @param warning  why there is no guarantee although there is a certificate; else empty
std::vector<ReportFinding> verdict_of(const ReplaySummary& summary, const ErrorFigures& norm,
                                      const std::string& warning);

/// What other gains would have done, beside those that the report is about.
ReportFinding finding_beside(const std::string& name, const ReplaySummary& other,
                             const ReplaySummary& own);

}  // namespace sampled_data_observers

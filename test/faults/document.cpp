#include <array>
#include <cstdio>

#include "faults/fault.h"

namespace sampled_data_observers::test {
namespace {

/// By code, as in EventStatus.
constexpr std::array<const char*, 27> kOutcomes = {
    "USED",          "USED_LATE",    "DUPLICATE",    "TOO_OLD",          "IN_FUTURE",
    "NO_STAMP",      "WRONG_SIZE",   "NOT_FINITE",   "WOULD_OVERFLOW",   "UNKNOWN_MODE",
    "TOO_FREQUENT",  "GATED",        "DISABLED",     "NO_TRANSFORM",     "NO_FIELD",
    "OUT_OF_ORDER",  "DROPPED",      "NOT_POSSIBLE", "REPEATED",         "JUMP_ALONE",
    "TAKEN_BACK",    "WITHDRAWN",    "NO_SUCH_JUMP", "OTHER_DEFINITION", "MALFORMED",
    "OUT_OF_LIMITS", "NO_COVARIANCE"};

std::string listed(const std::map<std::uint8_t, int>& statuses) {
  std::string text;
  for (const auto& [outcome, count] : statuses) {
    if (!text.empty()) text += ", ";
    text += std::string("`") + kOutcomes.at(outcome) + "`";
    if (count != kSome) text += " × " + std::to_string(count);
  }
  return text;
}

}  // namespace

std::string document_row(const std::string& suite, const Fault& fault) {
  char recovery[16];
  std::snprintf(recovery, sizeof(recovery), "%.1f s", fault.recovery);
  return "| `" + suite + "/" + fault.name + "` | " + fault.injected + " | " +
         listed(fault.statuses) + " | " +
         (fault.meanwhile == Meanwhile::kRight ? "right" : "finite") + " | " + recovery + " |";
}

std::string document_row(const StartFault& fault) {
  return "| `Start/" + fault.name + "` | " + fault.injected + " | " + fault.named + " |";
}

}  // namespace sampled_data_observers::test

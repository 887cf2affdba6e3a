#include "replay/report/report_events.h"

#include <algorithm>
#include <array>

#include "sampled_data_observers/runtime/event_outcome.h"

namespace sampled_data_observers {
namespace {

/// Of 33 bytes each, which base64 makes a third longer: 3.5 MB.
constexpr std::size_t kMostEvents = 80'000;

bool is_as_it_should(const RunRecord::EventRow& event) {
  return event.outcome == EventStatus::USED &&
         (event.interval_check == EventStatus::INTERVAL_NONE ||
          event.interval_check == EventStatus::INTERVAL_WITHIN);
}

std::vector<RunRecord::EventRow> events_to_show(const std::vector<RunRecord::EventRow>& events) {
  if (events.size() <= kMostEvents) return events;
  // Inputs first: they are the most, and say the least.
  std::vector<RunRecord::EventRow> left = events;
  const auto leave_out = [&left](auto is_left_out) {
    if (left.size() <= kMostEvents) return;
    left.erase(std::remove_if(left.begin(), left.end(), is_left_out), left.end());
  };
  leave_out([](const RunRecord::EventRow& event) {
    return is_as_it_should(event) && event.kind == EventStatus::INPUT;
  });
  leave_out(is_as_it_should);
  left.resize(std::min(left.size(), kMostEvents));
  return left;
}

template <class Number, class Read>
nlohmann::json array_of(const std::vector<RunRecord::EventRow>& events, const Read& read) {
  std::vector<Number> values;
  values.reserve(events.size());
  for (const RunRecord::EventRow& event : events)
    values.push_back(static_cast<Number>(read(event)));
  return packed(values);
}

}  // namespace

nlohmann::json events_of(const RunRecord& record, const PackedTime& time) {
  using Row = RunRecord::EventRow;
  const std::vector<Row> events = events_to_show(record.events);
  nlohmann::json outcomes = nlohmann::json::array();
  for (std::size_t i = 0; i < kEventOutcomes; ++i) {
    outcomes.push_back(describe(static_cast<EventOutcome>(i)));
  }
  return {
      {"left_out", record.events.size() - events.size()},
      {"sources", record.sources},
      {"reasons", record.reasons},
      {"outcomes_in_words", outcomes},
      {"arrival", array_of<std::uint32_t>(events, [&](const Row& e) { return time(e.arrival); })},
      {"latency", array_of<float>(events, [](const Row& e) { return e.latency; })},
      {"source", array_of<std::uint16_t>(events, [](const Row& e) { return e.source; })},
      {"kind", array_of<std::uint8_t>(events, [](const Row& e) { return e.kind; })},
      {"outcome", array_of<std::uint8_t>(events, [](const Row& e) { return e.outcome; })},
      {"reason", array_of<std::uint32_t>(events, [](const Row& e) { return e.reason; })},
      {"interval", array_of<float>(events, [](const Row& e) { return e.interval; })},
      {"check", array_of<std::uint8_t>(events, [](const Row& e) { return e.interval_check; })},
      {"rewound", array_of<std::uint32_t>(events, [](const Row& e) { return e.rewound; })},
      {"innovation", array_of<float>(events, [](const Row& e) { return e.innovation; })},
      {"nis", array_of<float>(events, [](const Row& e) { return e.nis; })},
  };
}

}  // namespace sampled_data_observers

#pragma once

#include <sampled_data_observers/EventStatus.h>
#include <sampled_data_observers/StateEstimate.h>

#include <string>

#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/runtime/observer_runtime.h"

namespace sampled_data_observers {

// What an ObserverRuntime gives, as messages. Nothing allocates when the message held one before,
// but where it is said.

/// What became of an event that arrived at `now`.
/// @param detail  what is said beside the outcome; may be empty
void write(const EventChannel& channel, const Event& event, const EventReport& report,
           const std::string& detail, Stamp now, EventStatus& status);

/// An estimate of `runtime`, and its bound as it can be given now.
void write(ObserverRuntime& runtime, const Estimate& estimate, StateEstimate& message);

/// The estimate of a query that has come to its end, and its bound. Allocates.
void write(const EstimateQuery& query, const std::string& frame_id, StateEstimate& message);

}  // namespace sampled_data_observers

#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>

#include "messages/types/typed_source.h"

namespace sampled_data_observers {

void refuse_fields(const TopicSource& source) {
  if (source.fields.empty() && source.mode.empty()) return;
  throw ConfigError(source.origin, source.path + (source.fields.empty() ? "/mode" : "/fields"),
                    "no fields (" + source.type + " has its values in order)", "some");
}

void add_fields(MessageFields<Measurement>& fields) {
  fields.indexed("values", &Measurement::values);
}

void add_fields(MessageFields<Input>& fields) { fields.indexed("values", &Input::values); }

void add_own_types(MessageTypes& types) { add_types<Measurement, Input, JumpEvent>(types); }

}  // namespace sampled_data_observers

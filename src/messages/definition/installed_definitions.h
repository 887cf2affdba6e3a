#pragma once

#include <memory>
#include <string>
#include <vector>

#include "messages/definition/message_definition.h"

namespace sampled_data_observers {

/// The definition of a message type as it is installed: of the usual types that which this was
/// compiled with, else that of the .msg files that rospack finds.
/// @throws DefinitionError that says what is missing and what to install, or which types the
/// package has.
std::shared_ptr<const MessageDefinition> installed_definition(const std::string& type);

/// The text that this was compiled with, for the usual types; null for others.
const char* compiled_definition(const std::string& type);

/// The types of a package that have such a text, without its name.
std::vector<std::string> compiled_types(const std::string& package);

}  // namespace sampled_data_observers

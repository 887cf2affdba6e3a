#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

namespace sampled_data_observers {

XmlRpc::XmlRpcValue list_of(const std::vector<std::string>& texts);

/// Calls the master, with the name of this node and `arguments`. Returns whether it agreed;
/// `response` is not valid where it did not answer, or was not asked since the node ends: its
/// services are gone then, and whatever is registered now would stay.
bool call_master(const std::string& method, std::vector<std::string> arguments,
                 XmlRpc::XmlRpcValue& response, XmlRpc::XmlRpcValue& payload);

/// Calls this node itself, as others do. Returns whether it answered.
/// @param arguments  beside the name of the caller
bool call_self(const std::string& method, const std::string& caller,
               const std::vector<XmlRpc::XmlRpcValue>& arguments, XmlRpc::XmlRpcValue& response);

}  // namespace sampled_data_observers

#include "ros/master_call.h"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <cstdint>

namespace sampled_data_observers {

XmlRpc::XmlRpcValue list_of(const std::vector<std::string>& texts) {
  XmlRpc::XmlRpcValue list;
  list.setSize(static_cast<int>(texts.size()));
  for (int i = 0; i < list.size(); ++i) list[i] = texts[static_cast<std::size_t>(i)];
  return list;
}

bool call_master(const std::string& method, std::vector<std::string> arguments,
                 XmlRpc::XmlRpcValue& response, XmlRpc::XmlRpcValue& payload) {
  if (ros::isShuttingDown()) return false;
  arguments.insert(arguments.begin(), ros::this_node::getName());
  const bool wait = false;
  return ros::master::execute(method, list_of(arguments), response, payload, wait);
}

bool call_self(const std::string& method, const std::string& caller,
               const std::vector<XmlRpc::XmlRpcValue>& arguments, XmlRpc::XmlRpcValue& response) {
  const ros::XMLRPCManagerPtr& manager = ros::XMLRPCManager::instance();
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(manager->getServerURI(), host, port)) return false;
  XmlRpc::XmlRpcValue request = list_of({caller});
  for (const XmlRpc::XmlRpcValue& argument : arguments) request[request.size()] = argument;
  XmlRpc::XmlRpcClient* client = manager->getXMLRPCClient(host, static_cast<int>(port), "/");
  const bool is_answered = client->execute(method.c_str(), request, response);
  manager->releaseXMLRPCClient(client);
  return is_answered;
}

}  // namespace sampled_data_observers

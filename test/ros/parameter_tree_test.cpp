// Parameters of the server as a configuration tree.
#include "ros/parameter_tree.h"

#include <gtest/gtest.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <functional>
#include <string>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::fault_of;

TEST(ParameterTreeTest, IsTheSameTreeAsTheFile) {
  XmlRpc::XmlRpcValue value;
  value["rate"] = 50;
  value["flag"] = true;
  value["text"] = "1e-3";  // what YAML 1.1 readers make of it
  value["tiny"] = 0.1 + 0.2;
  value["list"][0] = 1.0 / 3.0;
  value["list"][1] = -7;
  const ConfigNode node = to_config_node(value, "/observer");
  ConfigSection section(node, "");
  EXPECT_EQ(50.0, section.number("rate"));
  EXPECT_EQ(1e-3, section.number("text"));
  EXPECT_EQ(0.1 + 0.2, section.number("tiny"));
  EXPECT_EQ("true", node.find("flag")->scalar);
  EXPECT_EQ(1.0 / 3.0, section.vector("list", 2)(0));
  EXPECT_EQ("parameters of /observer", node.find("list")->items[1].origin);
  const std::string message = fault_of([&] { section.number("list"); });
  EXPECT_NE(std::string::npos, message.find("parameters of /observer: list: expected")) << message;
}

TEST(ParameterTreeTest, BinaryDataIsRefused) {
  char data[4] = {};
  XmlRpc::XmlRpcValue value;
  value["blob"] = XmlRpc::XmlRpcValue(data, 4);
  EXPECT_NE(std::string::npos,
            fault_of([&] { to_config_node(value, "/o"); }).find("parameters of /o: blob"));
}

}  // namespace
}  // namespace sampled_data_observers

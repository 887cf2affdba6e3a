// Parameters of the server as a configuration tree.
#include "ros/parameter_tree.h"

#include <gtest/gtest.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <ctime>
#include <functional>
#include <limits>
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

std::string fault_in(const XmlRpc::XmlRpcValue& value) {
  return fault_of([&] { to_config_node(value, "/o"); });
}

TEST(ParameterTreeTest, WhatNoConfigurationHoldsIsRefused) {
  char data[4] = {};
  XmlRpc::XmlRpcValue blob;
  blob["a"]["blob"] = XmlRpc::XmlRpcValue(data, 4);
  EXPECT_EQ("parameters of /o: a/blob: expected a number, text, list or map, found binary data",
            fault_in(blob));
  std::tm day = {};
  XmlRpc::XmlRpcValue date;
  date["list"][1] = XmlRpc::XmlRpcValue(&day);
  date["list"][0] = 1;
  EXPECT_EQ("parameters of /o: list[1]: expected a number, text, list or map, found a time",
            fault_in(date));
  XmlRpc::XmlRpcValue gap;
  gap["list"][1] = 1;
  EXPECT_EQ("parameters of /o: list[0]: expected a number, text, list or map, found nothing",
            fault_in(gap));
}

TEST(ParameterTreeTest, StructuresAndNumbersThatAreNoneReachWhoReadsThem) {
  XmlRpc::XmlRpcValue value;
  value["nan"] = std::numeric_limits<double>::quiet_NaN();
  value["text"] = "nan";
  value["inf"] = -std::numeric_limits<double>::infinity();
  value["maps"][0]["a"] = 1;
  value["maps"][1]["a"] = 2;
  value["mixed"][0] = 1;
  value["mixed"][1]["a"] = 2;
  value["empty"].begin();  // makes it a map
  value["none"].setSize(0);
  value["two words/\n"] = 1;
  const ConfigNode node = to_config_node(value, "/o");
  ConfigSection section(node, "");
  for (const char* key : {"nan", "text", "inf", "maps", "empty", "none"}) {
    const std::string message = fault_of([&] { section.number(key); });
    EXPECT_EQ(0u, message.find(std::string("parameters of /o: ") + key + ": expected a ")) << key;
  }
  for (const char* key : {"maps", "mixed", "empty", "none"}) {
    const std::string message = fault_of([&] { section.vector(key, 2); });
    EXPECT_EQ(0u, message.find(std::string("parameters of /o: ") + key)) << message;
  }
  EXPECT_NE(std::string::npos, fault_of([&] { section.finish(); }).find("two words"));
}

/// Maps in maps, below a key.
XmlRpc::XmlRpcValue nested(const std::string& key, int levels) {
  XmlRpc::XmlRpcValue root;
  XmlRpc::XmlRpcValue* inner = &root[key];
  for (int level = 2; level <= levels; ++level) inner = &(*inner)["k"];
  *inner = 1;
  return root;
}

TEST(ParameterTreeTest, HasTheLevelsOfAFile) {
  EXPECT_NO_THROW(to_config_node(nested("k", 16), "/o"));
  EXPECT_EQ(
      "parameters of /o: k/k/k/k/k/k/k/k/k/k/k/k/k/k/k/k/k: expected at most 16 levels, "
      "found more",
      fault_in(nested("k", 17)));
  EXPECT_EQ(0u, fault_in(nested("k", 1000)).find("parameters of /o: k/k/k/"));
  XmlRpc::XmlRpcValue lists;
  XmlRpc::XmlRpcValue* inner = &lists["k"];
  for (int level = 0; level < 1000; ++level) inner = &(*inner)[0];
  *inner = 1;
  EXPECT_EQ(
      "parameters of /o: k[0][0][0][0][0][0][0][0][0][0][0][0][0][0][0][0]: expected at most "
      "16 levels, found more",
      fault_in(lists));
  // Those of a file below `config` count from its top.
  EXPECT_NO_THROW(to_config_node(nested("config", 18), "/o"));
  EXPECT_EQ(0u, fault_in(nested("config", 19)).find("parameters of /o: config/k/k/k/"));
}

TEST(ParameterTreeTest, HasTheSizeOfAFile) {
  XmlRpc::XmlRpcValue keys;
  for (int i = 0; i < 1000; ++i) keys["map"]["k" + std::to_string(i)] = i;
  EXPECT_NO_THROW(to_config_node(keys, "/o"));
  keys["map"]["one_more"] = 1;
  EXPECT_EQ("parameters of /o: map: expected at most 1000 keys in a map, found more",
            fault_in(keys));
  XmlRpc::XmlRpcValue values;
  values["list"].setSize(200000);
  for (int i = 0; i < values["list"].size(); ++i) values["list"][i] = 0;
  EXPECT_EQ(
      "parameters of /o: list[199998]: expected at most 200000 values in all parameters, "
      "found more",
      fault_in(values));
  XmlRpc::XmlRpcValue texts;
  texts["a"] = std::string(3999998, 'a');
  EXPECT_NO_THROW(to_config_node(texts, "/o"));
  texts["b"] = std::string(1, 'b');
  EXPECT_EQ("parameters of /o: b: expected at most 4000000 bytes in all parameters, found more",
            fault_in(texts));
}

}  // namespace
}  // namespace sampled_data_observers

// Parameters and configuration files with which no observer may start.
#include <XmlRpcValue.h>

#include "faults/fault.h"

namespace sampled_data_observers::test {
namespace {

using Change = StartFault::Change;

/// A private parameter of this value.
template <class Value>
Change parameter(const std::string& name, const Value& value) {
  return
      [name, value](ObserverUnderTest& observer) { observer.parameters().setParam(name, value); };
}

/// The text of the first configuration file.
Change file(const std::string& text) { return parameter("config/file_1/text", text); }

Change without(const std::string& name) {
  return [name](ObserverUnderTest& observer) { observer.parameters().deleteParam(name); };
}

void remove_all(ObserverUnderTest& observer) {
  ros::param::del(observer.parameters().getNamespace());
}

/// Cuts off the second half of a configuration file.
void truncate(ObserverUnderTest& observer) {
  std::string text;
  observer.parameters().getParam("config/file_1/text", text);
  file(text.substr(0, text.size() / 2 + 3))(observer);
}

XmlRpc::XmlRpcValue list_in_list() {
  XmlRpc::XmlRpcValue list;
  list[0][0] = 1;
  return list;
}

XmlRpc::XmlRpcValue binary_data() {
  char bytes[] = {'\0', '\xff', '\n'};
  return {bytes, sizeof(bytes)};
}

/// As parameters that were not loaded as the text of a file.
XmlRpc::XmlRpcValue deep_list() {
  XmlRpc::XmlRpcValue list;
  XmlRpc::XmlRpcValue* inner = &list;
  for (int level = 0; level < 100; ++level) inner = &(*inner)[0];
  *inner = 1;
  return list;
}

XmlRpc::XmlRpcValue wide_map() {
  XmlRpc::XmlRpcValue map;
  for (int i = 0; i < 2000; ++i) map["k" + std::to_string(i)] = i;
  return map;
}

std::string deep_name() {
  std::string name;
  for (int level = 0; level < 5000; ++level) name += "k/";
  return name + "k";
}

StartFault key_of_wrong_type(const std::string& key) {
  return {"TypeOf_" + key,
          "`" + key + "` is a list in a list, or binary data",
          {parameter(key, list_in_list()), parameter(key, binary_data())},
          key};
}

/// Of a key that may not be a text.
StartFault wrong_type_or_text(const std::string& key) {
  StartFault fault = key_of_wrong_type(key);
  fault.injected = "`" + key + "` is a list in a list, binary data, or a text";
  fault.changes.push_back(parameter(key, std::string("fast")));
  return fault;
}

}  // namespace

std::vector<StartFault> start_faults() {
  std::vector<StartFault> faults = {
      {"NoParameters", "no private parameters at all", {remove_all}, "configuration"},
      {"NoConfiguration", "no configuration file below `config`", {without("config")}, "missing"},
      {"FileMissing",
       "one of the configuration files is missing",
       {without("config/file_1")},
       "missing"},
      {"FileEmpty", "a configuration file is empty", {file("")}, "oscillator.yaml"},
      {"FileTruncated", "a configuration file ends in the middle", {truncate}, "oscillator.yaml"},
      {"FileOfGarbage",
       "a configuration file holds garbage",
       {file("{[*&!%: ]")},
       "oscillator.yaml"},
      {"FileTooDeep",
       "a configuration file nests 1000 lists",
       {file("plant: " + std::string(1000, '['))},
       "oscillator.yaml"},
      {"FileIsANumber",
       "a number in place of a configuration file",
       {parameter("config/file_1", 3)},
       "config/file_1"},
      {"TreeTooDeep",
       "parameters that nest 100 lists",
       {parameter("plant", deep_list())},
       "plant[0]"},
      {"TreeTooWide", "2000 parameters in a map", {parameter("plant", wide_map())}, "plant"},
      {"TreeUnreadable",
       "parameters of 5000 levels, which the master takes and can not send",
       {parameter(deep_name(), 1)},
       "levels"},
      {"UnknownKey", "a key that does not exist", {parameter("rte", 10)}, "rte"},
      {"BadRate",
       "a rate of -1 Hz, 0 Hz, 1e9 Hz, NaN",
       {parameter("rate", -1), parameter("rate", 0), parameter("rate", 1e9),
        parameter("rate", std::string(".nan"))},
       "rate"},
      {"NoGainsDirectory",
       "a directory of gains that is not there",
       {parameter("gains_directory", std::string("/nowhere"))},
       "gains_directory"},
      {"OtherObserver",
       "a configuration of another observer type",
       {parameter("observer", std::string("HybridKalmanFilter"))},
       "gains"},
  };
  for (const char* key : {"observer", "frame_id", "gains_directory"}) {
    faults.push_back(key_of_wrong_type(key));
  }
  for (const char* key : {"plant",
                          "sensors",
                          "input",
                          "jumps",
                          "sampling",
                          "gains",
                          "initial_estimate",
                          "rate",
                          "publish_delay",
                          "publish_on_event",
                          "history",
                          "future_tolerance",
                          "reset_on_time_jump_back",
                          "jump_back_tolerance",
                          "real_time",
                          "outputs",
                          "static_transforms",
                          "certificate",
                          "allow_uncertified",
                          "error_assumptions"}) {
    faults.push_back(wrong_type_or_text(key));
  }
  return faults;
}

}  // namespace sampled_data_observers::test

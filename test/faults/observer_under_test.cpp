#include "faults/observer_under_test.h"

#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <sampled_data_observers/EnableSensor.h>
#include <sampled_data_observers/Reset.h>
#include <std_srvs/SetBool.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "ros/spin_until.h"

namespace sampled_data_observers::test {
namespace {

const char kName[] = "/observer";

std::string read_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

ObserverUnderTest::ObserverUnderTest() : parameters_(kName) {
  std::string pattern = std::filesystem::temp_directory_path() / "faults_XXXXXX";
  gains_directory_ = mkdtemp(pattern.data());
  const auto take = [this](const rosgraph_msgs::LogConstPtr& line) {
    const std::size_t found = line->msg.find("not started: ");
    if (found != std::string::npos) refusal_ = line->msg.substr(found);
  };
  log_subscriber_ = parameters_.subscribe<rosgraph_msgs::Log>("/rosout", 1000, take);
}

ObserverUnderTest::~ObserverUnderTest() { std::filesystem::remove_all(gains_directory_); }

bool ObserverUnderTest::load(const std::string& type) {
  refusal_.clear();
  const bool is_there =
      spin_until([] { return ros::service::exists("/manager/load_nodelet", false); });
  if (!is_there) throw std::runtime_error("no nodelet manager");
  nodelet::NodeletLoad load;
  load.request.name = kName;
  load.request.type = "sampled_data_observers/" + type;
  const bool persistent = true;
  ros::NodeHandle handle;
  return handle.serviceClient<nodelet::NodeletLoad>("/manager/load_nodelet", persistent)
             .call(load) &&
         load.response.success != 0;
}

void ObserverUnderTest::unload() {
  nodelet::NodeletUnload::Request request;
  request.name = kName;
  call<nodelet::NodeletUnload>("/manager/unload_nodelet", request);
}

void ObserverUnderTest::set_parameters(const std::vector<std::string>& files) {
  ros::param::del(kName);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const ros::NodeHandle file(parameters_, "config/file_" + std::to_string(i + 1));
    file.setParam("path", files[i]);
    file.setParam("text", read_file(std::string(SDO_SOURCE_DIR) + "/" + files[i]));
  }
  parameters_.setParam("gains_directory", gains_directory_);
}

bool ObserverUnderTest::reset(const std::vector<double>& state) const {
  Reset::Request request;
  request.state = state;
  return call<Reset>("reset", request).success != 0;
}

ReloadGains::Response ObserverUnderTest::reload(const std::string& file) const {
  ReloadGains::Request request;
  request.file = file;
  return call<ReloadGains>("reload_gains", request);
}

bool ObserverUnderTest::set_enabled(bool enabled) const {
  std_srvs::SetBool::Request request;
  request.data = enabled ? 1 : 0;
  return call<std_srvs::SetBool>("set_enabled", request).success != 0;
}

bool ObserverUnderTest::enable_sensor(const std::string& name, bool enabled) const {
  EnableSensor::Request request;
  request.name = name;
  request.enabled = enabled ? 1 : 0;
  return call<EnableSensor>("enable_sensor", request).success != 0;
}

void ObserverUnderTest::write_gains(const std::string& file, const std::string& text) const {
  std::ofstream(gains_directory_ + "/" + file) << text;
}

}  // namespace sampled_data_observers::test
